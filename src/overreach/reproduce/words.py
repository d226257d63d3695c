"""How numbers are written for readers."""

from __future__ import annotations


def number(value: float) -> str:
    """Return a number as a reader wants it: three figures, and 0 for what is rounding (below 1e-9)."""
    if abs(value) < 1e-9:
        return "0"
    if abs(value) >= 1000.0:
        return f"{value:,.0f}"
    return f"{value:.3g}"
