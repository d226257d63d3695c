"""The cost of the law and of the full planar step, in plain CPython."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from itertools import cycle

from benchmarks.measure import Promise, in_turns, promise
from overreach.bench.replay import Replay
from overreach.fast.step import planar_step
from overreach.law.authority import exact, paper
from overreach.law.blend import Blend, Smoothstep, Tanh
from overreach.law.laws import Exact
from overreach.model.planar import planar

MOUNT = (0.0, 0.0, 0.0)
OFFSET = (0.1, 0.05, 0.1)


def limits(blend: Blend) -> tuple[float, float, float, float, float, float]:
    return (0.45, 0.85, -0.6, 0.6, blend.k_l, blend.k_psi)


TARGETS = {"law exact": 1.5, "full": 2.0, "Pilot.tick": 25.0}
"""What each is to take at most [us], by how its name begins."""


def run() -> Iterator[Promise]:
    """Measure the law in its three regions: the arm alone, blending, the base alone."""
    soft, paper_blend = Smoothstep(), Tanh()
    share = Exact().bind(planar())
    drive = Replay(Exact(), 250)
    ticks = cycle(drive.ticks)

    def law_call(l: float, blend: Blend, mount: tuple[float, float, float]) -> Callable[[], object]:
        return partial(exact, l, 0.3, 0.3, 0.1, blend.rise, limits(blend), mount)

    def step_call(theta_2: float, blend: Blend, mount: tuple[float, float, float]) -> Callable[[], object]:
        return partial(planar_step, -0.2, theta_2, 0.1, 0.2, 0.3, 0.2, blend.rise, limits(blend), mount, 0.5, 0.5)

    took = in_turns(
        {
            "law exact, arm alone": law_call(0.6, soft, MOUNT),
            "law exact, blending (smoothstep)": law_call(0.86, soft, MOUNT),
            "law exact, blending (tanh)": law_call(0.86, paper_blend, MOUNT),
            "law exact, blending (tanh), shoulder off centre": law_call(0.86, paper_blend, OFFSET),
            "law paper (tanh)": partial(paper, 0.86, 0.3, 0.3, 0.1, paper_blend.rise, limits(paper_blend), MOUNT),
            "full planar step, arm alone": step_call(1.7, soft, MOUNT),
            "full planar step, blending (smoothstep)": step_call(1.07, soft, MOUNT),
            "full planar step, blending (tanh)": step_call(1.07, paper_blend, MOUNT),
            "full planar step, blending (tanh), shoulder off centre": step_call(1.07, paper_blend, OFFSET),
            "Exact().bind(model), record and all": partial(share, 0.86, 0.3, 0.3, 0.1),
            "Pilot.tick, gate, limits, guard, record and all": lambda: drive.tick(*next(ticks)),
        }
    )
    for name, values in took.items():
        most = next((most for start, most in TARGETS.items() if name.startswith(start)), None)
        yield promise(name, values, "us", most, note=f"best {min(values):.2f}")
