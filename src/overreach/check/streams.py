"""Command streams: what a hand on a stick does, drawn at random. Written down here, and the same for the same seed.

smooth: each of v, w, v_z is tanh(x(t)), x = 0.8 a_0 + 0.6 sum a_k sin(2 pi t / T_k + p_k) over k = 1..4, with normal a,
periods T_k uniform in 3 to 20 s and phases p_k; the first second fades in; then scaled so that it reaches full
deflection exactly once or more. So a stream is at full deflection for much of its time, in all directions.

A base that moves sideways too is also driven to the side: one more part, v_y, which is as great as v.

steps: a stick thrown from stop to stop: each part holds for 0.3 to 3 s, and is -1, 0 or 1, or uniform in between.
"""

from __future__ import annotations

import math

import numpy as np

from overreach.arm.spatial.screws import Array
from overreach.errors import UnknownNameError
from overreach.gate.limits import Limits

DURATION_S, DT_S = 20.0, 0.01
"""Length of a stream, and of its period."""
WAVES = 4
PERIODS_S = (3.0, 20.0)
FADE_S = 1.0
HOLDS_S = (0.3, 3.0)
KINDS = ("smooth", "steps")


def stream(kind: str, seed: int, number: int, most: Limits, aside: bool = False) -> Array:
    """Return the commands (steps, 3) of stream `number` of a seed: v [m/s], w [rad/s], v_z [m/s], at most `most`.

    aside: with v_y [m/s] as a fourth.
    """
    if kind not in KINDS:
        raise UnknownNameError("kind of stream", kind, KINDS)
    random = np.random.default_rng((seed, number))
    t = np.arange(round(DURATION_S / DT_S)) * DT_S
    make = _smooth if kind == "smooth" else _steps
    tops = (most.v_c, most.w_c, most.v_z, *((most.v_c,) if aside else ()))
    return np.stack([make(random, t) * top for top in tops], axis=1)


def _smooth(random: np.random.Generator, t: Array) -> Array:
    x = np.full_like(t, 0.8 * random.normal())
    for _ in range(WAVES):
        size, period, phase = random.normal(), random.uniform(*PERIODS_S), random.uniform(0.0, 2.0 * math.pi)
        x += 0.6 * size * np.sin(2.0 * math.pi * t / period + phase)
    x = np.tanh(x) * np.minimum(1.0, t / FADE_S)
    return np.asarray(x / np.abs(x).max())


def _steps(random: np.random.Generator, t: Array) -> Array:
    x = np.zeros_like(t)
    at = 0.0
    while at < DURATION_S:
        holds = random.uniform(*HOLDS_S)
        value = random.uniform(-1.0, 1.0) if random.random() < 0.3 else float(random.integers(-1, 2))
        x[(t >= at) & (t < at + holds)] = value
        at += holds
    return x
