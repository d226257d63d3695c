"""The laws as plugs: the Protocol, and the makers `exact`, `paper` and `switch`."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Protocol, final, runtime_checkable

from overreach.errors import LONGEST_NAME, WorkspaceError
from overreach.law import authority
from overreach.law.blend import Blend, smoothstep, step, tanh
from overreach.law.workspace import Mount, Workspace
from overreach.types import FLOATS, Frame, Split, Verdict


class Law(Protocol):
    """Shares one EE velocity between base and arm. A pure function of its arguments."""

    name: str
    """The name under which it is chosen."""
    frame: Frame
    """The command frame that suits it, used unless another is asked for."""
    closes_residual: bool
    """Whether the arm is to make up for what the base does otherwise than asked (lag, slip, limits)."""
    workspace: Workspace
    blend: Blend
    mount: Mount

    def split(self, l: float, psi: float, u_r: float, u_t: float) -> Split:
        """Return the shares for the EE at (l [m], psi [rad]) commanded to (u_r, u_t) [m/s].

        Every number is finite for finite input with l > 0; nothing is raised.
        """
        ...


@runtime_checkable
class JointLaw(Law, Protocol):
    """A law that decides joint rates itself, and so wants to know the joints: a controller asks it so."""

    def split_joints(self, theta: tuple[float, ...], u_r: float, u_t: float) -> Split:
        """Return the shares, joint rates among them, for the arm at joint angles theta [rad]; as `split` otherwise."""
        ...


class UnusableError(ValueError):
    """A law's answer that cannot be used; says which part is what."""


ANSWERS = (Verdict.MOVING, Verdict.NO_SOLUTION)
"""What a law may say of its answer; the other verdicts are not a law's to give."""


def checked(split: Split) -> Split:
    """Return a law's answer as plain floats.

    Raises UnusableError unless every number is finite, the scale in [0, 1] and the verdict one that a law may give.
    """
    own = split.dtheta or ()
    numbers = (split.mu, split.sigma, split.v_b, split.w_b, split.v_m, split.w_m, split.scale, *own)
    if not (math.isfinite(sum(map(abs, numbers))) and 0.0 <= split.scale <= 1.0):
        for name in ("mu", "sigma", "scale", "v_b", "w_b", "v_m", "w_m"):
            value = getattr(split, name)
            if not math.isfinite(value) or (name == "scale" and not 0.0 <= value <= 1.0):
                raise UnusableError(f"{name} = {value}")
        raise UnusableError("rates too great to use")
    if split.verdict not in ANSWERS:
        raise UnusableError(f"the verdict {str(split.verdict)[:LONGEST_NAME]!r}")
    if set(map(type, numbers)) == FLOATS:
        return split
    mu, sigma, v_b, w_b, v_m, w_m, scale, *own_rates = map(float, numbers)
    dtheta = None if split.dtheta is None else tuple(own_rates)
    return Split(mu, sigma, v_b, w_b, v_m, w_m, scale, split.verdict, dtheta)


def constants(workspace: Workspace, blend: Blend, mount: Mount) -> tuple[authority.Limits6, authority.Mount3]:
    """Return the numbers that the functions in `authority` take."""
    limits = (workspace.l_min, workspace.l_max, workspace.psi_min, workspace.psi_max, blend.k_l, blend.k_psi)
    return limits, (mount.s_x, mount.s_y, mount.yaw)


def _check(workspace: Workspace, mount: Mount) -> None:
    """Raise WorkspaceError where the EE could come over the base's turning centre."""
    worst = workspace.l_min - math.hypot(mount.s_x, mount.s_y)
    if worst <= 0.0:
        # Only a shoulder behind the hand brings it over the turning centre: look at the whole sector.
        steps = 64
        span = workspace.psi_max - workspace.psi_min
        for k in range(steps + 1):
            psi_d = workspace.psi_min + span * k / steps + mount.yaw
            if workspace.l_min + mount.s_x * math.cos(psi_d) + mount.s_y * math.sin(psi_d) <= 0.0:
                raise WorkspaceError(
                    f"with the shoulder at ({mount.s_x:g}, {mount.s_y:g}) m the hand comes over the base's "
                    f"turning centre inside the workspace: choose l_min > {-worst + workspace.l_min:g} m"
                )


@final
class SharingLaw:
    """A law made of one of the functions in `authority`; see `exact`, `paper` and `switch`."""

    def __init__(
        self,
        name: str,
        frame: Frame,
        closes_residual: bool,
        shares: Callable[..., authority.Shares],
        workspace: Workspace,
        blend: Blend,
        mount: Mount,
    ) -> None:
        self.name = name
        self.frame = frame
        self.closes_residual = closes_residual
        self.workspace = workspace
        self.blend = blend
        self.mount = mount
        self._shares = shares
        self._rise = blend.rise
        _check(workspace, mount)
        self._limits, self._mount = constants(workspace, blend, mount)

    def split(self, l: float, psi: float, u_r: float, u_t: float) -> Split:
        """Return the shares; see `Law.split`."""
        return Split(*self._shares(l, psi, u_r, u_t, self._rise, self._limits, self._mount))


def exact(workspace: Workspace | None = None, blend: Blend | None = None, mount: Mount | None = None) -> Law:
    """Ours: exact in true kinematics, the arm closes what the base leaves, the base lines up."""
    return SharingLaw(
        "exact",
        Frame.HAND,
        True,
        authority.exact,
        workspace or Workspace(),
        blend or smoothstep(),
        mount or Mount(),
    )


def paper(workspace: Workspace | None = None, blend: Blend | None = None, mount: Mount | None = None) -> Law:
    """Kwon et al. 2026, (14) to (16), to the letter: distorts the hand's motion by mu |v_c tan psi|."""
    return SharingLaw(
        "paper",
        Frame.POLAR,
        False,
        authority.paper,
        workspace or Workspace(),
        blend or tanh(),
        mount or Mount(),
    )


def switch(workspace: Workspace | None = None, mount: Mount | None = None) -> Law:
    """Kwon et al. 2026 without blending, (12) and (13): the hard switch."""
    return SharingLaw("switch", Frame.POLAR, False, authority.paper, workspace or Workspace(), step(), mount or Mount())
