"""Many robots at once: steps per second against numpy, by the size of the batch and by threads, and the memory."""

from __future__ import annotations

import os
import resource
import statistics
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba
import numpy as np

from overreach.bench.measure import spread
from overreach.bench.vectorised import numpy_step
from overreach.clock import nanoseconds
from overreach.fast.batch import IN, OUT, Array, compile_batch
from overreach.law.blend import Smoothstep, Tanh
from overreach.law.laws import constants
from overreach.model.planar import planar

SIZES = (100, 1_000, 10_000, 100_000, 1_000_000)
HEADLINE = 1_000_000
"""The size of which the throughput is quoted."""
SLOW_EVERY = 5
FEW_ROBOTS = 20_000
"""Robots stepped in one measurement of a small batch, by repeating it."""


def random_states(n: int, seed: int = 0) -> Array:
    """Return (6, n) states: l 0.4 to 0.9 m, psi, heading and command spread over workspace and blends, evenly."""
    chance = np.random.default_rng(seed)
    l, psi = chance.uniform(0.4, 0.9, n), chance.uniform(-0.65, 0.65, n)
    theta_2 = np.arccos((l * l - 0.5) / 0.5)
    states = np.empty((IN, n))
    states[0] = psi - 0.5 * theta_2
    states[1] = theta_2
    states[2] = chance.uniform(-np.pi, np.pi, n)
    states[3] = states[2] + psi + chance.uniform(-0.5, 0.5, n)
    states[4:] = chance.uniform(-0.4, 0.4, (2, n))
    return states


def resident_mb() -> float:
    """Return the memory [MB] that this process has resident now; 0 where the system does not say."""
    try:
        pages = int(Path("/proc/self/statm").read_text("ascii").split()[1])
    except OSError:
        return 0.0
    return pages * resource.getpagesize() / 1e6


def per_second(step: Callable[[Array, Array], None], states: Array, rates: Array, rounds: int) -> list[float]:
    """Return the robots stepped per second in each round."""
    n = states.shape[1]
    repeats = max(1, FEW_ROBOTS // n)
    step(states, rates)
    found = []
    for _ in range(rounds):
        start = nanoseconds()
        for _ in range(repeats):
            step(states, rates)
        found.append(n * repeats / (nanoseconds() - start) * 1e9)
    return found


def measure(rounds: int = 15, tell: Callable[[str], object] = lambda what: None) -> dict[str, Any]:
    """Return throughput [steps/s] by size, by threads and of numpy, and how memory grew while it was measured."""
    robot, soft = planar(), Smoothstep()
    limits, _ = constants(robot, soft)
    tell("compiling the batch")
    batch = compile_batch(robot, soft)
    batch_tanh = compile_batch(robot, Tanh())

    def by_numpy(states: Array, rates: Array) -> None:
        numpy_step(states, rates, limits, *robot.arm.links)

    threads = numba.get_num_threads()
    states = random_states(HEADLINE)
    tell("batch of a million robots")
    # In turns, as everywhere: ours, ours with tanh, one thread, and numpy in every fifth round, since it is slow.
    ours, numpys, alone, steep = [], [], [], []
    rates = np.empty((OUT, HEADLINE))
    for step in (batch, batch_tanh):
        step(states, rates)
    before = resident_mb()
    per_second(batch, states, rates, rounds)
    grown = resident_mb() - before
    for number in range(rounds):
        ours += per_second(batch, states, rates, 1)
        steep += per_second(batch_tanh, states, rates, 1)
        numba.set_num_threads(1)
        try:
            alone += per_second(batch, states, rates, 1)
        finally:
            numba.set_num_threads(threads)
        if number % SLOW_EVERY == 0:
            numpys += per_second(by_numpy, states, rates, 1)
    tell("batches of other sizes")
    sizes = {}
    for n in SIZES:
        some, out = states[:, :n].copy(), np.empty((OUT, n))
        turns = [(per_second(batch, some, out, SLOW_EVERY), per_second(by_numpy, some, out, 1)) for _ in range(3)]
        sizes[str(n)] = {
            "compiled": statistics.median(value for fast, _ in turns for value in fast),
            "numpy": statistics.median(value for _, slow in turns for value in slow),
        }
    many = spread(ours)
    return {
        "robots": HEADLINE,
        "steps_per_s": many.median,
        "spread": [many.low, many.high],
        "numpy_steps_per_s": statistics.median(numpys),
        "times_numpy": many.median / statistics.median(numpys),
        "tanh_steps_per_s": statistics.median(steep),
        "by_size": sizes,
        "by_threads": {"1": statistics.median(alone), str(threads): many.median},
        "threads": threads,
        "cores": os.cpu_count(),
        "memory_mb": {"grown_over_all_rounds": grown, "arrays": (IN + OUT) * HEADLINE * 8 / 1e6},
    }
