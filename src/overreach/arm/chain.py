"""What any arm must provide: where its hand is, and which joint rates give it a wanted motion.

(l, psi): the hand about the shoulder, l [m] along the ground, psi [rad] from the arm's own x axis
polar axes: r outward from the shoulder to the hand, t counter-clockwise, z up; in the base frame
moved: (v_m = dl/dt, w_m = dpsi/dt, v_z, w_r, w_t, w_z): what the arm does to its hand, seen from the base
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from overreach.arm.mount import Mount
from overreach.types import Channel, Record
from overreach.verdicts import Verdict

if TYPE_CHECKING:  # an arm in the plane needs no numpy
    from overreach.arm.spatial.screws import Array

Rest = tuple[float, float, float, float]
"""The hand rates that the arm owes beyond the plane: v_z [m/s], then w_r, w_t, w_z [rad/s] in polar axes."""
NO_REST: Rest = (0.0, 0.0, 0.0, 0.0)
Moved = tuple[float, float, float, float, float, float]
"""v_m [m/s], w_m [rad/s], v_z [m/s], w_r, w_t, w_z [rad/s]."""
Point = tuple[float, float, float]


class Asked(Record, frozen=True):
    """What one step is asked for. Twists of the base: (v_x, v_y, w_z) [m/s, rad/s] along its own axes.

    u: velocity of the hand [m/s]: outward, counter-clockwise, up; w_c [rad/s] and delta [rad]: of the heading that a
    yaw fixed in the world has, its turning and how far it is past the bearing; plan: what the law wants of the base;
    slip: how the base deviates from what it is told; was, change: the base twist written last, and how much it can
    change in this period; joints: their rates written last [rad/s, m/s]; dt: the period [s]; turn [rad/s]: how the
    attitude that is held is to turn, about r, t and z, of an arm that does not hold all turnings about the axis that
    the hand points along, and t; attitude: the one that is held at bearing 0, by rows, None: home's.
    """

    u: tuple[float, float, float]
    w_c: float
    delta: float
    plan: tuple[float, float, float]
    slip: tuple[float, float, float]
    was: tuple[float, float, float]
    change: tuple[float, float, float]
    joints: tuple[float, ...]
    dt: float
    turn: tuple[float, float, float] = (0.0, 0.0, 0.0)
    attitude: tuple[float, ...] | None = None


class Step(Record, frozen=True):
    """What one step comes to: rates to write, the part of the command that they carry out, and why it is less.

    attitude: the one that is held from then on, as in `Asked`.
    """

    joints: tuple[float, ...]
    base: tuple[float, float, float]
    scale: float
    verdict: Verdict
    reason: str
    attitude: tuple[float, ...] | None = None


class Chain(Protocol):
    """An arm at its joints: forward kinematics done, once a tick."""

    @property
    def l(self) -> float:  # noqa: E743  the paper's symbol
        """Length [m]: the hand's distance from the shoulder, along the ground."""
        ...

    @property
    def psi(self) -> float:
        """Bearing [rad] of the hand from the arm's x axis, in (-pi, pi]."""
        ...

    @property
    def joints(self) -> tuple[float, ...]:
        """The joints [rad, m], from the shoulder out."""
        ...

    @property
    def hand(self) -> Point:
        """The hand (x, y, z) [m] in the base frame."""
        ...

    @property
    def points(self) -> tuple[Point, ...]:
        """The links as a line through (x, y, z) [m] in the base frame, from the shoulder to the hand."""
        ...

    @property
    def manipulability(self) -> float:
        """sqrt(det(J J^T)) of the hand's motion [m^n]: 0 where the arm is singular."""
        ...

    def towards_manipulability(self) -> tuple[float, ...]:
        """Return the gradient of the manipulability with respect to the joints."""
        ...

    def jacobian(self) -> tuple[tuple[float, ...], ...]:
        """Return d(moved)/d(joint rates): rows of l, psi, z and the rotations about r, t, z; one column per joint."""
        ...

    def rates(self, v_m: float, w_m: float, rest: Rest, dt: float) -> tuple[tuple[float, ...], Verdict]:
        """Return the joint rates that, held for `dt` [s], give this motion, and MOVING or what prevents it.

        The period ends exactly at (l + v_m dt, psi + w_m dt); with dt = 0 these are the instantaneous rates. An arm
        leaves out the rows that it lacks (`Arm.rows`). Always finite; near a singularity it gives way.
        """
        ...

    def moved(self, rates: tuple[float, ...]) -> Moved:
        """Return what the hand does at joint rates `rates`."""
        ...


class Governing(Chain, Protocol):
    """A chain that has joint motions to choose from, and keeps the joints' limits by itself. Its arm `governs`."""

    @property
    def attitude(self) -> Array:
        """The hand's attitude in the base frame, (3, 3)."""
        ...

    @property
    def tool(self) -> Array:
        """The hand's own axes, forward, left and up, in polar axes: the columns of (3, 3)."""
        ...

    @property
    def facing(self) -> float:
        """How far past its bearing [rad] lies what the hand calls ahead, when its heading is not known yet."""
        ...

    def heading(self, attitude: tuple[float, ...] | None = None) -> float:
        """Return how far [rad] the heading that the hand holds is past its bearing. attitude: as in `Asked`."""
        ...

    def turning(
        self,
        w_c: float,
        w_b: float,
        joints: tuple[float, ...],
        turn: Point = (0.0, 0.0, 0.0),
        attitude: tuple[float, ...] | None = None,
    ) -> Point:
        """Return how fast [rad/s] the hand is to turn in the world, along the base's axes.

        For a command w_c and rates of base and joints; turn, attitude: as in `Asked`.
        """
        ...

    def step(self, asked: Asked) -> Step:
        """Return rates that keep every limit of the joints; where they cannot follow, with the base scaled along."""
        ...


def governs(arm: Arm) -> bool:
    """Say whether an arm's chains are `Governing`."""
    return bool(getattr(arm, "governs", False))


def is_aside(arm: Arm) -> bool:
    """Say whether an arm cannot move its hand about the shoulder, and leaves what lies along its base's way to it."""
    return bool(getattr(arm, "aside", False))


def turns_by_itself(arm: Arm) -> bool:
    """Say whether an arm keeps its hand's yaw in the world, however its base turns."""
    return bool(getattr(arm, "turns", False))


class Arm(Protocol):
    """A manipulator: its joints and its kinematics. It does not know where it stands (`Mount`).

    One that has joint motions to choose from says `governs = True`: its chains are then `Governing`. It also says in
    `follows` which of v_z, w_x, w_y its step carries out, in `whole` whether it turns its hand about any axis, in
    `aside` whether it cannot move its hand about the shoulder, and in `turns` whether it keeps its hand's yaw itself.
    """

    @property
    def channels(self) -> tuple[Channel, ...]:
        """Each joint, from the shoulder out: limits of its position, speed and acceleration."""
        ...

    @property
    def rows(self) -> tuple[int, ...]:
        """Which of the six rows of `moved` it can choose freely: (0, 1) for an arm in the plane."""
        ...

    @property
    def branch(self) -> tuple[tuple[float, float], ...]:
        """Per joint, the least and greatest position [rad] between which the posture stays on its own branch."""
        ...

    @property
    def reach(self) -> tuple[float, float]:
        """Least and greatest l [m]."""
        ...

    def at(self, joints: tuple[float, ...], mount: Mount) -> Chain:
        """Return the arm at `joints`, mounted at `mount`."""
        ...

    def posture(self, l: float, psi: float) -> tuple[float, ...]:
        """Return joints that put the hand at (l, psi), in its usual posture."""
        ...
