"""The records that carry a command from the operator to the motors, and the robot's state back.

Units are m, rad and s; angles are counter-clockwise. Frames: the *world* (fixed), the *base*
(origin at the drive's turning centre, x forward, y to the left) and the *hand* (the end effector,
EE). Records are frozen and slotted; symbols are those of Kwon et al., Appl. Sci. 2026, 16(2), 712.
"""

from __future__ import annotations

import enum
import math

import msgspec

from overreach.verdicts import Verdict

FLOATS = {float}


class Record(msgspec.Struct, frozen=True, gc=False, forbid_unknown_fields=True):
    """Base of the frozen, slotted records (a compiled struct: 0.1 us to make). On a wire, no other field is taken."""


class Frame(enum.StrEnum):
    """The frame in which the operator's command is given (see `overreach.law.frame`)."""

    HAND = "hand"
    POLAR = "polar"
    BASE = "base"
    WORLD = "world"
    TOOL = "tool"


class Channel(Record, frozen=True):
    """One rate of a robot, of its base or of a joint, that is written and measured.

    name: its symbol; moves: the name of the position that it moves; unit: of that position, "m" or "rad", so that rates
    are in unit/s and changes of rates in unit/s^2; rate_max, change_max: greatest |rate| and |d rate/dt|; lower, upper:
    limits of the position; resolution: smallest change of it that the robot reports; dead_band: a rate below which the
    robot may stand still.
    """

    name: str
    moves: str
    unit: str
    rate_max: float
    change_max: float
    lower: float = -math.inf
    upper: float = math.inf
    resolution: float = 0.005
    dead_band: float = 0.0


class Twist(Record, frozen=True):
    """A rigid body's velocity: v_x, v_y, v_z [m/s], w_x, w_y, w_z [rad/s]; units never depend on the frame."""

    v_x: float = 0.0
    v_y: float = 0.0
    v_z: float = 0.0
    w_x: float = 0.0
    w_y: float = 0.0
    w_z: float = 0.0


class BaseTwist(Record, frozen=True):
    """Motion of the base in its own frame: v_x, v_y [m/s], w_z [rad/s]; v_y = 0 unless it can move sideways."""

    v_x: float = 0.0
    v_y: float = 0.0
    w_z: float = 0.0


class Command(Record, frozen=True):
    """One message from the operator: the whole state of stick and dead-man. Its meaning travels with the numbers.

    operator: session nonce; seq: counts up within it; grip: number of this press of the dead-man; held: whether it is
    held; twist: the hand's velocity, in `frame` (see `overreach.law.frame`); gripper: its wanted opening, 0 to 1, None
    to leave it as it is; seen: time `t` [s] of the newest state that the operator's side had heard of
    when sending it, None if of none: it says how old the command is, on the robot's own clock.
    """

    operator: int
    seq: int
    grip: int
    held: bool
    twist: Twist = Twist()
    frame: Frame = Frame.HAND
    gripper: float | None = None
    seen: float | None = None


class Pose(Record, frozen=True):
    """Where a body is: x, y, z [m] and its attitude as a unit quaternion q_w, q_x, q_y, q_z.

    heading: the yaw [rad] if it is known as a separate angle, as odometry counts it; None: take it from the
    quaternion.
    """

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    q_w: float = 1.0
    q_x: float = 0.0
    q_y: float = 0.0
    q_z: float = 0.0
    heading: float | None = None

    @classmethod
    def flat(cls, x: float, y: float, heading: float) -> Pose:
        """Return the pose of a base on level ground."""
        return cls(x, y, 0.0, math.cos(0.5 * heading), 0.0, 0.0, math.sin(0.5 * heading), heading)

    @property
    def yaw(self) -> float:
        """The heading [rad]; that of the quaternion lies in [-pi, pi]."""
        if self.heading is not None:
            return self.heading
        return math.atan2(
            2.0 * (self.q_w * self.q_z + self.q_x * self.q_y), 1.0 - 2.0 * (self.q_y * self.q_y + self.q_z * self.q_z)
        )


class PolarState(Record, frozen=True):
    """The EE seen from the shoulder.

    l: length [m]; psi: bearing from the arm's own x axis [rad]; theta_e: heading of the hand in
    the world [rad].
    """

    l: float
    psi: float
    theta_e: float = 0.0


class HandTwist(Record, frozen=True):
    """The commanded velocity of the hand in polar axes: outward, counter-clockwise and up, at the base's heading.

    u_r, u_t, u_z [m/s]; w_r, w_t, w_z [rad/s]. Of an arm that does not hold all turnings of its hand, w_r is about the
    axis that the hand points along.
    """

    u_r: float = 0.0
    u_t: float = 0.0
    u_z: float = 0.0
    w_r: float = 0.0
    w_t: float = 0.0
    w_z: float = 0.0


class Split(Record, frozen=True):
    """A law's answer: how one EE velocity is shared by base and arm.

    mu, sigma: the base's share of linear and of angular motion, 0 (arm) to 1 (base);
    v_b [m/s], w_b [rad/s]: base twist; v_m = dl/dt [m/s], w_m = dpsi/dt [rad/s]: the arm's rates;
    scale: the part of the command that is feasible, 0 to 1 (all rates are scaled alike);
    verdict: MOVING, or why the law gives no motion (then all rates and the scale are 0);
    v_y [m/s]: the base's rate to its left, None for a base that cannot move so.
    """

    mu: float
    sigma: float
    v_b: float
    w_b: float
    v_m: float
    w_m: float
    scale: float = 1.0
    verdict: Verdict = Verdict.MOVING
    v_y: float | None = None


class Plan(Record, frozen=True):
    """A whole body's answer: who moves the hand, before the robot's limits are applied.

    split: shares and rates; joints: joint rates [rad/s, m/s] if the plan decides them itself; None if the arm is to
    solve for them from v_m and w_m.
    """

    split: Split
    joints: tuple[float, ...] | None = None


class Takeover(Record, frozen=True):
    """What a robot's host has made of writes that came too late: it ramps to zero by itself.

    rates: those that it wrote last, channel by channel; latched: whether nothing counts until the loop arms anew.
    """

    rates: tuple[float, ...]
    latched: bool


class RobotState(Record, frozen=True):
    """What a robot with any number of joints reports.

    t: the robot's own time stamp [s]; pose: of the base in the world; motion: measured twist of the base in its own
    frame, all six components (a base that rocks rocks the hand); q, dq: joints [rad, m] and their rates, from the
    shoulder out; gripper: its opening, 0 to 1; ages: age [s] at t of the base's and of the joints' measurements;
    delay: dead time [s] of what is written, if it is known; takeover: None while what was written last is what stands.
    """

    t: float
    pose: Pose
    motion: Twist
    q: tuple[float, ...]
    dq: tuple[float, ...]
    gripper: float = 0.0
    ages: tuple[float, float] = (0.0, 0.0)
    delay: float = 0.0
    takeover: Takeover | None = None

    @classmethod
    def flat(
        cls,
        t: float,
        x_b: float,
        y_b: float,
        theta_b: float,
        v_b: float,
        w_b: float,
        q: tuple[float, ...],
        dq: tuple[float, ...],
        gripper: float = 0.0,
    ) -> RobotState:
        """Return the state of a robot whose base drives on level ground and does not move sideways."""
        return cls(t, Pose.flat(x_b, y_b, theta_b), Twist(v_b, 0.0, 0.0, 0.0, 0.0, w_b), q, dq, gripper)

    @property
    def x_b(self) -> float:
        """The base's x in the world [m]."""
        return self.pose.x

    @property
    def y_b(self) -> float:
        """The base's y in the world [m]."""
        return self.pose.y

    @property
    def theta_b(self) -> float:
        """The base's heading [rad]."""
        return self.pose.yaw

    @property
    def v_b(self) -> float:
        """The base's speed along its x axis [m/s]."""
        return self.motion.v_x

    @property
    def w_b(self) -> float:
        """The base's turning rate [rad/s]."""
        return self.motion.w_z

    @property
    def numbers(self) -> tuple[float, ...]:
        """All numbers except the joints': stamp, pose, motion, gripper, ages, delay."""
        pose = msgspec.structs.astuple(self.pose)
        heading = pose[:7] if pose[7] is None else pose
        motion = msgspec.structs.astuple(self.motion)
        return (self.t, *heading, *motion, self.gripper, *self.ages, self.delay)

    @property
    def plain(self) -> RobotState:
        """The same state in Python's own floats, with the heading filled in. Raises if a value is not a number."""
        own = set(map(type, (*self.numbers, *self.q, *self.dq))) == FLOATS and type(self.q) is type(self.dq) is tuple
        if own and self.pose.heading is not None:
            return self
        t, *numbers = [float(number + 0.0) for number in self.numbers]  # raises for a text
        *numbers, gripper, base, joints, delay = numbers
        q, dq = [tuple([float(number + 0.0) for number in one]) for one in (self.q, self.dq)]
        pose = Pose(*numbers[:-6])
        pose = pose if pose.heading is not None else msgspec.structs.replace(pose, heading=pose.yaw)
        return RobotState(t, pose, Twist(*numbers[-6:]), q, dq, gripper, (base, joints), delay, self.takeover)
