"""Ten thousand robots at once: the same law, compiled from the same source (needs the extra `fast`)."""

import numpy as np

from overreach.fast.batch import compile_batch
from overreach.fast.robot import compile_step

chance = np.random.default_rng(1)
n = 10_000
states = np.empty((6, n))
states[0] = chance.uniform(-1.2, -0.2, n)  # theta_1 [rad]
states[1] = chance.uniform(1.0, 2.2, n)  # theta_2 [rad]
states[2] = chance.uniform(-np.pi, np.pi, n)  # theta_b, heading of the base [rad]
states[3] = states[2] + chance.uniform(-0.5, 0.5, n)  # theta_e, heading of the hand [rad]
states[4] = 0.4  # v_c [m/s]
states[5] = 0.0  # w_c [rad/s]
rates = np.empty((4, n))  # v_b, w_b, dtheta_1, dtheta_2

step_all = compile_batch()  # takes two seconds, once
step_all(states, rates)  # takes a fifth of a millisecond
print(f"{n} robots: {np.mean(rates[0] != 0.0):.0%} of the bases drive, at most at {rates[0].max():.2f} m/s")

step_one = compile_step()
same = max(abs(a - b) for k in range(100) for a, b in zip(step_one(*states[:, k]), rates[:, k], strict=True))
print(f"one robot at a time gives the same to {same:.0e}")
