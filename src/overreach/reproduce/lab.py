"""Where the sections of the report do their work: runs, results, and the files they leave."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from matplotlib import pyplot as plt
from matplotlib.figure import Figure

from overreach.files import write_text
from overreach.law.body import WholeBody
from overreach.look import as_svg, check, inline
from overreach.run.files import write_csv, write_table
from overreach.run.scenario import Scenario, load_scenario
from overreach.run.simulate import Run, simulate

CSV_PERIOD_S, CSV_ROWS = 0.01, 6_000
"""Runs go to CSV at this period, long ones in about so many rows: a figure shows no more."""


@dataclass
class Picture:
    """A figure of a section: its file's name, and what to see in it."""

    name: str
    caption: str
    svg: str


@dataclass
class Table:
    """A table of a section; cells are text or numbers."""

    caption: str
    header: Sequence[str]
    rows: Sequence[Sequence[str | float | int]]


@dataclass
class Section:
    """A part of the report: what to see, pictures, tables. Text may hold simple HTML."""

    key: str
    title: str
    says: list[str]
    pictures: list[Picture] = field(default_factory=list)
    tables: list[Table] = field(default_factory=list)


class Lab:
    """Runs scenarios, keeps results, writes figures and data under `out`."""

    def __init__(self, out: Path) -> None:
        self.out = out
        self.physics: dict[str, Any] = {}
        self.timing: dict[str, Any] = {}
        for folder in ("figures", "data"):
            (out / folder).mkdir(parents=True, exist_ok=True)

    def run(self, scenario: Scenario | str, law: WholeBody | str, name: str | None = None) -> Run:
        """Return the run of a scenario, and leave it as data/NAME.csv (scenario_law by default)."""
        if isinstance(scenario, str):
            scenario = load_scenario(scenario)
        run = simulate(scenario, law)
        stride = max(1, round(CSV_PERIOD_S / scenario.dt), len(run.rows) // CSV_ROWS)
        write_csv(self.out / "data" / f"{name or f'{scenario.name}_{run.law}'}.csv", run.rows[::stride])
        return run

    def data(self, name: str, header: Sequence[str], rows: Sequence[Sequence[Any]]) -> None:
        """Leave a table as data/NAME.csv."""
        write_table(self.out / "data" / f"{name}.csv", header, rows)

    def picture(self, name: str, figure: Figure, caption: str) -> Picture:
        """Leave a figure as figures/NAME.svg and .png, and return it for the page."""
        check(name, figure)
        svg = as_svg(figure, name)
        write_text(self.out / "figures" / f"{name}.svg", svg)
        figure.savefig(self.out / "figures" / f"{name}.png", dpi=140, metadata={"Software": "overreach"})
        plt.close(figure)
        return Picture(name, caption, inline(svg, name, caption.replace('"', "&quot;")))
