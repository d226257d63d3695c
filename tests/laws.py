"""Laws bound to the planar robot, for tests that ask a law alone."""

from __future__ import annotations

from typing import Any, final

from overreach.arm.chain import Chain
from overreach.arm.mount import Mount
from overreach.baselines.holistic import Holistic
from overreach.baselines.qp import PaperQP
from overreach.baselines.separate import Separate
from overreach.baselines.weighted import Weighted
from overreach.law.blend import Blend, Smoothstep, Tanh
from overreach.law.body import Planner, WholeBody
from overreach.law.laws import Exact, Law, Paper, Share, Switch
from overreach.model.model import Model
from overreach.model.planar import planar
from overreach.model.workspace import Workspace
from overreach.types import HandTwist, Plan, Split, Twist
from tests.strategies import WORKSPACE


@final
class Bound:
    """A law or whole body that has met a planar robot."""

    def __init__(self, law: WholeBody, workspace: Workspace = WORKSPACE, mount: Mount | None = None) -> None:
        self.law, self.name = law, law.name
        self.model = planar(workspace=workspace, mount=mount or Mount())
        self.planner: Any = law.planner(self.model)

    def split(self, l: float, psi: float, u_r: float, u_t: float) -> Split:
        """Return the shares with the hand at (l, psi): a law's own, or those of a plan in the arm's usual posture."""
        if isinstance(self.law, Law):
            return self.law.bind(self.model)(l, psi, u_r, u_t)
        return self.plan(self.model.arm.posture(l, psi), u_r, u_t).split

    def plan(self, theta: tuple[float, ...], u_r: float, u_t: float) -> Plan:
        """Return the whole plan with the arm at joints theta [rad]."""
        plan: Plan = self.planner(self.model.arm.at(theta, self.model.mount), HandTwist(u_r, u_t), Twist())
        return plan


def exact(workspace: Workspace = WORKSPACE, blend: Blend | None = None, mount: Mount | None = None) -> Bound:
    return Bound(Exact(blend or Smoothstep()), workspace, mount)


def paper(workspace: Workspace = WORKSPACE, blend: Blend | None = None, mount: Mount | None = None) -> Bound:
    return Bound(Paper(blend or Tanh()), workspace, mount)


def switch(workspace: Workspace = WORKSPACE) -> Bound:
    return Bound(Switch(), workspace)


def separate(workspace: Workspace = WORKSPACE) -> Bound:
    return Bound(Separate(), workspace)


def weighted(workspace: Workspace = WORKSPACE, mount: Mount | None = None, base_weight: float = 1.0) -> Bound:
    return Bound(Weighted(base_weight), workspace, mount)


def holistic() -> Bound:
    return Bound(Holistic())


def qp(solver: str = "daqp", damping: float = 0.01, **settings: Any) -> Bound:
    return Bound(PaperQP(solver, damping, settings))


class Given(Law, frozen=True):
    """A law that is any function of (l, psi, u_r, u_t)."""

    share: Any
    called: str = "given"
    closes: bool = True

    @property
    def name(self) -> str:  # type: ignore[override]
        return self.called

    @property
    def closes_residual(self) -> bool:  # type: ignore[override]
        return self.closes

    def bind(self, model: Model) -> Share:
        share: Share = self.share
        return share

    def planner(self, model: Model) -> Planner:
        """Return what takes a whole plan, too, for an answer."""

        def plan(chain: Chain, u: HandTwist, base: Twist) -> Plan:
            answer = self.share(chain.l, chain.psi, u.u_r, u.u_t)
            return answer if isinstance(answer, Plan) else Plan(answer)

        return plan
