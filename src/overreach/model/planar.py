"""The planar robot: a base that cannot move sideways and an arm of two links (2R)."""

from __future__ import annotations

import importlib.resources
import math
import tomllib

import msgspec

from overreach.errors import SetupError, WorkspaceError
from overreach.law.workspace import Mount, Workspace
from overreach.types import Channel, Record

LONGEST_LAG_S = 1.0


def _check_positive(part: str, **values: float) -> None:
    for name, value in values.items():
        if not (math.isfinite(value) and value > 0.0):
            raise SetupError(f"{part} {name} must be a finite number > 0, got {value:g}")


class Arm2R(Record, frozen=True):
    """Two links in a plane.

    links: a, b [m]; elbow: sign of theta_2, +1 or -1; theta_min, theta_max [rad]; dtheta_max [rad/s];
    ddtheta_max [rad/s^2]; each of the last four per joint, from the shoulder out.
    """

    links: tuple[float, float] = (0.5, 0.5)
    elbow: int = 1
    theta_min: tuple[float, float] = (-4.8, -math.pi)
    theta_max: tuple[float, float] = (4.8, math.pi)
    dtheta_max: tuple[float, float] = (3.0, 3.0)
    ddtheta_max: tuple[float, float] = (20.0, 20.0)

    def __post_init__(self) -> None:
        for speed, change in zip(self.dtheta_max, self.ddtheta_max, strict=True):
            _check_positive("arm", dtheta_max=speed, ddtheta_max=change)
        for k, (least, most) in enumerate(zip(self.theta_min, self.theta_max, strict=True), start=1):
            if not -math.inf < least < most < math.inf:
                raise SetupError(f"arm theta_min must be below theta_max, got {least:g} and {most:g} rad for joint {k}")
        if not all(math.isfinite(link) and link > 0.0 for link in self.links):
            raise SetupError(f"arm links must be finite lengths > 0 m, got {self.links}")
        if self.elbow not in (-1, 1):
            raise SetupError(f"elbow must be 1 or -1, got {self.elbow}")

    @property
    def reach(self) -> tuple[float, float]:
        """Least and greatest distance of the hand from the shoulder [m]."""
        a, b = self.links
        return abs(a - b), a + b


class BaseLimits(Record, frozen=True):
    """v_max [m/s], w_max [rad/s], dv_max [m/s^2], dw_max [rad/s^2]; lag [s]; footprint: length, width [m].

    lag: time constant with which the base follows what it is asked for, 0 where it follows at once or it is not known.
    """

    v_max: float = 0.6
    w_max: float = 2.0
    dv_max: float = 3.5
    dw_max: float = 12.0
    lag: float = 0.0
    footprint: tuple[float, float] = (0.5, 0.4)

    def __post_init__(self) -> None:
        _check_positive("base", v_max=self.v_max, w_max=self.w_max, dv_max=self.dv_max, dw_max=self.dw_max)
        if not 0.0 <= self.lag <= LONGEST_LAG_S:
            raise SetupError(f"base lag must be 0 to {LONGEST_LAG_S:g} s, got {self.lag:g}")


class Start(Record, frozen=True):
    """Where the hand is when the robot starts: l [m], psi [rad]."""

    l: float = 0.65
    psi: float = 0.0


class PlanarRobot(Record, frozen=True):
    """Everything that is known of a planar robot before it moves; see `data/planar.toml`."""

    name: str = "planar"
    summary: str = ""
    arm: Arm2R = Arm2R()
    mount: Mount = Mount()
    base: BaseLimits = BaseLimits()
    workspace: Workspace = Workspace()
    start: Start = Start()

    @property
    def channels(self) -> tuple[Channel, ...]:
        """The rates that are written, in order: v_b, w_b, dtheta_1, dtheta_2."""
        base, arm = self.base, self.arm
        return (
            Channel("v_b", "the base's place", "m", base.v_max, base.dv_max, dead_band=0.03),
            Channel("w_b", "the base's heading", "rad", base.w_max, base.dw_max, dead_band=0.105),
            *(
                Channel(f"dtheta_{k}", f"theta_{k}", "rad", speed, change, least, most, dead_band=0.105)
                for k, (speed, change, least, most) in enumerate(
                    zip(arm.dtheta_max, arm.ddtheta_max, arm.theta_min, arm.theta_max, strict=True), start=1
                )
            ),
        )

    def __post_init__(self) -> None:
        self.check_workspace(self.workspace)
        self.check_reach(self.start.l)

    def check_workspace(self, workspace: Workspace) -> None:
        """Raise WorkspaceError unless the arm reaches the whole workspace."""
        least, most = self.arm.reach
        if workspace.l_min < least or workspace.l_max > most:
            raise WorkspaceError(
                f"the workspace's l = {workspace.l_min:g} to {workspace.l_max:g} m is not within "
                f"the arm's reach of {least:g} to {most:g} m"
            )

    def check_reach(self, l: float) -> None:
        """Raise WorkspaceError unless the hand can be l [m] from the shoulder, short of its singularities."""
        least, most = self.arm.reach
        if not least < l < most:
            raise WorkspaceError(f"the arm cannot reach l = {l:g} m: valid are {least:g} < l < {most:g} m")


def load_planar(text: str | None = None) -> PlanarRobot:
    """Return the robot described by TOML `text`, by default the built-in `planar`.

    Raises SetupError with what is wrong where.
    """
    if text is None:
        text = importlib.resources.files("overreach.model").joinpath("data/planar.toml").read_text("utf-8")
    try:
        return msgspec.convert(tomllib.loads(text), PlanarRobot)
    except (tomllib.TOMLDecodeError, msgspec.ValidationError) as error:
        raise SetupError(f"robot description: {error}") from None


def planar() -> PlanarRobot:
    """The paper's robot: a differential-drive base with a planar arm of two links, in simulation."""
    return load_planar()
