"""Whether an arm touches its own robot: MuJoCo's collisions, in the posture that is asked about."""

from __future__ import annotations

from copy import copy
from typing import final

import mujoco
import numpy as np

from overreach.arm.spatial.screws import Array
from overreach.model.description import Description
from overreach.model.mujoco.chain import HINGE, body_of, joint_of, lock

ALWAYS = 0.75
"""Bodies that touch in so many random postures are neighbours that always do."""
POSTURES = 40
OF_HOME = 0.5
"""Bodies that are close to each other at home may come as close as this part of what lies between them there."""


@final
class Contacts:
    """Which bodies of a robot come closer than `distance` [m], or than half of what lies between them at home.

    part: of both. What is looked for while the robot is driven is a part of what its workspace was measured with.
    """

    def __init__(self, model: mujoco.MjModel, description: Description, distance: float, part: float = 1.0) -> None:
        model = copy(model)  # the margins are ours alone
        self._model, self._data = model, mujoco.MjData(model)
        lock(model, self._data, description)
        groups = description.arm.groups
        self._addresses = [[int(model.jnt_qposadr[joint_of(model, name)]) for name in group] for group in groups]
        self._moving = self._after_the_first_hinge(groups)
        self._lower = np.array([model.jnt_range[joint_of(model, group[0])][0] for group in groups])
        self._upper = np.array([model.jnt_range[joint_of(model, group[0])][1] for group in groups])
        home = np.array(description.home)
        model.geom_margin[:] = 0.0
        never = [[body_of(model, name, "arm.never_touch") for name in pair] for pair in description.arm.never_touch]
        self._neighbours = self._often() | {(min(pair), max(pair)) for pair in never}
        self.at_home = set(self._near(home)) - self._neighbours
        """Bodies that touch at home, and should not."""
        model.geom_margin[:] = 0.5 * distance / OF_HOME  # of both of a pair together
        self._least = {pair: part * max(OF_HOME * apart, 0.0) for pair, apart in self._near(home).items()}
        self._distance = part * distance
        model.geom_margin[:] = 0.5 * self._distance

    def _after_the_first_hinge(self, groups: tuple[tuple[str, ...], ...]) -> Array:
        """Say of each body whether it moves with the arm: what only the lift carries may be close to the rest."""
        model = self._model
        joints = [joint_of(model, group[0]) for group in groups]
        first = next(j for j in joints if int(model.jnt_type[j]) == HINGE)
        root = int(model.jnt_bodyid[first])
        moving = np.zeros(model.nbody)
        for body in range(model.nbody):
            at = body
            while at > 0 and at != root:
                at = int(model.body_parentid[at])
            moving[body] = float(at == root)
        return moving

    def put(self, q: Array) -> None:
        """Bring the model to the arm's joints `q`."""
        for addresses, value in zip(self._addresses, q.tolist(), strict=True):
            for address in addresses:
                self._data.qpos[address] = value / len(addresses)

    def _near(self, q: Array) -> dict[tuple[int, int], float]:
        """Return how far apart [m] are the pairs of bodies, of which the arm moves one, that are within the margins."""
        self.put(q)
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_collision(self._model, self._data)
        near: dict[tuple[int, int], float] = {}
        if not self._data.ncon:
            return near
        contact = self._data.contact
        bodies = self._model.geom_bodyid[contact.geom].tolist()
        for (one, other), apart in zip(bodies, contact.dist.tolist(), strict=True):
            if self._moving[one] or self._moving[other]:
                pair = min(one, other), max(one, other)
                near[pair] = min(apart, near.get(pair, np.inf))
        return near

    def _often(self) -> set[tuple[int, int]]:
        random = np.random.default_rng(0)
        counts: dict[tuple[int, int], int] = {}
        for _ in range(POSTURES):
            q = random.uniform(np.maximum(self._lower, -3.0), np.minimum(self._upper, 3.0))
            for pair in self._near(q):
                counts[pair] = counts.get(pair, 0) + 1
        return {pair for pair, count in counts.items() if count >= ALWAYS * POSTURES}

    def touching(self, q: Array) -> set[tuple[int, int]]:
        """Return the pairs of bodies that at joints `q` are closer than they may be."""
        near = self._near(q)
        return {
            pair
            for pair, apart in near.items()
            if apart < self._least.get(pair, self._distance) and pair not in self._neighbours
        }

    def names(self, pairs: set[tuple[int, int]]) -> str:
        """Return pairs of bodies in words."""
        return ", ".join(f"{self._model.body(a).name} and {self._model.body(b).name}" for a, b in sorted(pairs))
