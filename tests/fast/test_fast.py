from __future__ import annotations

import math
import random
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from overreach.arm.mount import Mount
from overreach.bench.batch import random_states
from overreach.bench.vectorised import numpy_step
from overreach.errors import SetupError
from overreach.fast import mathematics
from overreach.fast.batch import FEW, Batch, compile_batch
from overreach.fast.robot import compile_law, compile_step
from overreach.fast.step import planar_step
from overreach.law import authority
from overreach.law.blend import Blend, Smoothstep, Tanh
from overreach.law.laws import constants
from overreach.model.planar import planar

SAME = 1e-12
CASES = 100_000
OFF = Mount(0.15, -0.05, 0.2)


def states(n: int, seed: int, yaw: float = 0.0) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Half where a robot works, half anywhere: straight arms, behind the base, folded to l = 0.07 m, fast commands.

    Left out are 10 mrad about exactly beside the base, and hands nearer to the shoulder: 1/cos^2 psi and 1/l^2 magnify
    the last bit of every sine there, in Python as in compiled code.
    """
    chance = np.random.default_rng(seed)
    wild = chance.uniform(-math.pi, math.pi, (6, n))
    wild[1] = chance.uniform(-3.0, 3.0, n)
    wild[4:] = chance.uniform(-3.0, 3.0, (2, n))
    bearing = wild[0] + 0.5 * wild[1] + yaw
    return np.hstack([random_states(n // 2, seed), wild[:, np.abs(np.cos(bearing)) > 0.01][:, : n // 2]])


@pytest.fixture(scope="module")
def batch() -> Batch:
    """The batch step of the default robot: compiled once, which takes two seconds."""
    return compile_batch()


@pytest.mark.parametrize("mount", [Mount(), OFF], ids=["centred", "off"])
@pytest.mark.parametrize("blend", [Smoothstep(), Tanh()], ids=lambda blend: str(blend.name))
def test_compiled_is_interpreted(blend: Blend, mount: Mount) -> None:
    """One source: on 1e5 random states the compiled step and the batch give what Python gives, to 1e-12."""
    robot = planar(mount=mount)
    limits, three = constants(robot, blend)
    one = compile_step(robot, blend)
    step: Callable[..., Any] = planar_step
    given = states(CASES // 4, 7, mount.yaw)
    rates = np.empty((4, given.shape[1]))
    compile_batch(robot, blend)(given, rates)
    for column, together in zip(given.T.tolist(), rates.T.tolist(), strict=True):
        want = step(*column, blend.rise, limits, three, *robot.arm.links)
        size = 1.0 + max(map(abs, want))
        for got in (one(*column), together):
            assert all(abs(a - b) <= SAME * size for a, b in zip(got, want, strict=True)), (column, want, got)


@pytest.mark.parametrize("mount", [Mount(), OFF], ids=["centred", "off"])
def test_compiled_law_is_the_law(mount: Mount) -> None:
    """The compiled law gives what `authority.exact` gives, to 1e-12 of the rates' size, on 1e5 random states."""
    blend = Smoothstep()
    limits, three = constants(planar(mount=mount), blend)
    law = compile_law(planar(mount=mount), blend)
    plain: Callable[..., Any] = authority.exact
    chance = random.Random(3)
    for _ in range(CASES // 2):
        case = (chance.uniform(0.2, 1.0), *(chance.uniform(-0.8, 0.8) for _ in range(3)))
        want = plain(*case, blend.rise, limits, three)
        size = 1.0 + max(map(abs, want))
        assert all(abs(a - b) <= SAME * size for a, b in zip(law(*case), want, strict=True)), case


def test_batch_of_any_size_is_the_same(batch: Batch) -> None:
    """One thread or many, a few robots or many: the same numbers, bit for bit."""
    given = random_states(5_000)
    together = np.empty((4, 5_000))
    batch(given, together)
    for n in (0, 1, 7, FEW - 1, FEW):
        some = np.empty((4, n))
        batch(given[:, :n].copy(), some)
        assert np.array_equal(some, together[:, :n])


def test_numpy_rival_computes_the_same(batch: Batch) -> None:
    """What the batch is compared with does the same work: equal to 1e-12, singular arms included."""
    robot, blend = planar(), Smoothstep()
    limits, _ = constants(robot, blend)
    given = states(20_000, 11)
    want, got = np.empty((4, 20_000)), np.empty((4, 20_000))
    batch(given, want)
    numpy_step(given, got, limits, *robot.arm.links)
    assert np.max(np.abs(got - want) / (1.0 + np.abs(want).max(axis=0))) <= SAME


@pytest.mark.parametrize(
    ("given", "rates"),
    [
        (np.zeros((6, 3), np.float32), np.zeros((4, 3))),
        (np.zeros((5, 3)), np.zeros((4, 3))),
        (np.zeros((6, 3)), np.zeros((4, 2))),
        (np.zeros((3, 6)).T, np.zeros((4, 3))),
        ([[0.0]], np.zeros((4, 1))),
    ],
)
def test_batch_refuses_what_it_cannot_use(batch: Batch, given: Any, rates: Any) -> None:
    """Arrays of another shape, type or order are refused in one line that says what is wanted."""
    with pytest.raises(SetupError) as caught:
        batch(given, rates)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "span", "within"),
    [("sin", 1e5, 3e-16), ("cos", 1e5, 3e-16), ("atan", 1e3, 5e-16), ("atan", 1.5, 5e-16), ("tanh", 25.0, 4e-16)],
)
def test_mathematics_is_that_of_the_library(name: str, span: float, within: float) -> None:
    """Each function without branches agrees with `math`'s within what its module says."""
    ours, theirs = getattr(mathematics, name), getattr(math, name)
    chance = random.Random(name)
    for _ in range(20_000):
        x = chance.uniform(-span, span)
        assert abs(ours(x) - theirs(x)) <= within, x


def test_mathematics_of_two_numbers_and_of_edges() -> None:
    """atan2, hypot, copysign agree with `math` in every quadrant and on the axes; nan stays nan."""
    chance = random.Random(5)
    points = [(chance.uniform(-2, 2), chance.uniform(-2, 2)) for _ in range(20_000)]
    points += [(0.0, 0.0), (0.0, 1.0), (0.0, -1.0), (1.0, 0.0), (-1.0, 0.0), (1.0, -1.0)]
    for y, x in points:
        assert abs(mathematics.atan2(y, x) - math.atan2(y, x)) <= 5e-16
        assert mathematics.hypot(y, x) == pytest.approx(math.hypot(y, x), rel=1e-15)
        assert mathematics.copysign(y, x) == math.copysign(y, x)
    for name in ("sin", "cos", "atan", "tanh"):
        assert math.isnan(getattr(mathematics, name)(math.nan))
    assert mathematics.tanh(1e6) == 1.0
    assert mathematics.tanh(-math.inf) == -1.0
    assert mathematics.atan(math.inf) == pytest.approx(math.pi / 2)
