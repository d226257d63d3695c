"""What every law must satisfy. In a test of your own: `check_law(MyLaw(), my_model())`."""

from __future__ import annotations

import math
import random

from overreach.law.authority import ee_velocity
from overreach.law.laws import Law, Share
from overreach.model.model import Model
from overreach.types import Split
from overreach.verdicts import Verdict

RATES = ("v_b", "v_y", "w_b", "v_m", "w_m")
EXACT_TO = 1e-9
"""How exact [m/s] a law that says it closes the residual must be, for commands up to 0.4 m/s."""


def check_law(law: Law, model: Model, seed: int = 0, cases: int = 500) -> None:
    """Raise AssertionError, with the case, where `law`, bound to `model`, breaks a promise; `cases` random states.

    Checked: it has all that `Law` names; every split is finite, with shares and scale in [0, 1], anywhere and
    for any finite command; a zero command gives no motion; the same arguments give the same answer, whatever was asked
    in between; no solution means zero; and if it says that it closes the residual, the hand moves as commanded, times
    the scale.
    """
    missing = [name for name in ("name", "frame", "closes_residual", "bind") if not hasattr(law, name)]
    assert not missing, f"law lacks {', '.join(missing)}"
    share: Share = law.bind(model)
    chance = random.Random(seed)
    first: list[tuple[tuple[float, float, float, float], Split]] = []
    for k in range(cases):
        if k % 2:  # where it works
            space = model.workspace
            l = chance.uniform(0.9 * space.l_min, 1.1 * space.l_max)
            psi = chance.uniform(space.psi_min - 0.1, space.psi_max + 0.1)
        else:  # and anywhere else
            l, psi = 10.0 ** chance.uniform(-4.0, 1.0), chance.uniform(-4.0, 4.0)
        size = 0.4 if k % 4 < 2 else 10.0 ** chance.uniform(-6.0, 4.0)
        case = (l, psi, chance.uniform(-size, size), chance.uniform(-size, size))
        split = share(*case)
        _check_split(split, case)
        assert split.v_y is None or model.base.omni, f"moves a base sideways that cannot, at {case}: {split}"
        if law.closes_residual and size == 0.4:
            _check_exact(model, split, case)
        rest = share(l, psi, 0.0, 0.0)
        assert not any(getattr(rest, rate) for rate in RATES), f"moves without a command at {case}: {rest}"
        if len(first) < 20:
            first.append((case, split))
    for case, split in first:
        again = share(*case)
        assert again == split, f"not a pure function: at {case} first {split}, later {again}"


def _check_split(split: Split, case: tuple[float, ...]) -> None:
    assert all(math.isfinite(getattr(split, rate) or 0.0) for rate in RATES), f"not finite at {case}: {split}"
    for share in ("mu", "sigma", "scale"):
        assert 0.0 <= getattr(split, share) <= 1.0, f"{share} is not in [0, 1] at {case}: {split}"
    if split.verdict is not Verdict.MOVING:
        assert not any(getattr(split, rate) for rate in RATES), f"{split.verdict} but not still at {case}: {split}"
        assert split.scale == 0.0, f"{split.verdict} but scale is not 0 at {case}: {split}"


def _check_exact(model: Model, split: Split, case: tuple[float, float, float, float]) -> None:
    l, psi, u_r, u_t = case
    rates = split.v_b, split.w_b, split.v_m, split.w_m
    got_r, got_t = ee_velocity(l, psi, *rates, model.mount.three, split.v_y or 0.0)
    off = math.hypot(got_r - split.scale * u_r, got_t - split.scale * u_t)
    assert off <= EXACT_TO, f"the hand is {off:.2g} m/s off its command at {case}: {split}"
