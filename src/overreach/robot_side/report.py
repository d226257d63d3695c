"""What the loop tells: a tick as the state on the wire."""

from __future__ import annotations

from math import cos, inf, sin
from typing import final

from overreach.arm.chain import Chain, Point
from overreach.arm.mount import Mount
from overreach.control.pilot import Pilot
from overreach.control.tick import Tick
from overreach.law.frame import FRAMES
from overreach.link.messages import State
from overreach.robot_side.timing import Lateness
from overreach.types import BaseTwist, Frame, Pose

LATE_EVERY_S = 1.0


@final
class Reporter:
    """Turns ticks into wire states; keeps the loop's lateness over the last second."""

    def __init__(self) -> None:
        self.late = Lateness()
        self._apart = Lateness()
        self._wrote_at = inf
        self._told = (0.0, 0.0, 0.0, 0.0, 0.0)
        self._told_at = -inf

    def wrote(self, now: float, dt: float) -> None:
        """Count a write at `now` [s]; `dt` [s] after the last one, it is in time."""
        if self._wrote_at < inf:
            self._apart.add(max(0.0, now - self._wrote_at - dt))
        self._wrote_at = now

    def state(
        self, tick: Tick, pilot: Pilot, number: int, overruns: int, malformed: int, revision: int, frame: Frame
    ) -> State:
        """Return the tick as a state. frame: the pages'."""
        if tick.now - self._told_at >= LATE_EVERY_S:
            late, apart = self.late, self._apart
            self._told = (
                late.percentile(0.5), late.percentile(0.99), late.most * 1e6, apart.percentile(0.99), apart.most * 1e6
            )  # fmt: skip
            self._told_at = tick.now
            late.reset()
            apart.reset()
        verdict, split, polar, state = tick.verdict, tick.split, tick.polar, tick.decided.state
        model = pilot.model
        chain = pilot.controller.chain
        bearing, heading = polar.psi + model.mount.yaw, state.pose.yaw
        p50, p99, most, apart_p99, apart_max = self._told
        return State(
            t=tick.now,
            tick=number,
            operator=tick.operator,
            ack=pilot.gate.seq,
            seen=pilot.gate.seen,
            heard=pilot.gate.heard,
            age=pilot.gate.age,
            verdict=verdict.value,
            word=verdict.word,
            sentence=tick.sentence,
            look=verdict.look,
            scale=tick.scale,
            armed=tick.armed,
            stopped=tick.latched,
            twist=tick.gated.twist,
            frame=tick.gated.frame,
            forward=FRAMES[frame](bearing, heading, polar.theta_e) + bearing + heading,
            gripper=tick.gripper,
            opening=state.gripper,
            l=polar.l,
            psi=polar.psi,
            theta_e=polar.theta_e,
            mu=split.mu,
            sigma=split.sigma,
            v_m=split.v_m,
            w_m=split.w_m,
            base=tick.base,
            pose=state.pose,
            joints=state.q,
            hand=in_world(state.pose, chain.hand),
            velocity=velocity(state.pose, chain, tick.base, split.v_m, split.w_m, model.mount),
            links=tuple([in_world(state.pose, point) for point in chain.points]),
            late_p50=p50,
            late_p99=p99,
            late_max=most,
            apart_p99=apart_p99,
            apart_max=apart_max,
            overruns=overruns,
            refused=pilot.gate.refused + malformed,
            revision=revision,
        )


def in_world(pose: Pose, point: Point) -> Point:
    """Return a point of the base frame in world coordinates [m], for a base on level ground."""
    c, s = cos(pose.yaw), sin(pose.yaw)
    x, y, z = point
    return float(pose.x + c * x - s * y), float(pose.y + s * x + c * y), float(pose.z + z)


def velocity(pose: Pose, chain: Chain, base: BaseTwist, v_m: float, w_m: float, mount: Mount) -> Point:
    """Return the hand's true velocity in the world [m/s], from the rates of base and arm that are written.

    In the base frame, along the ground: v + w_z z x p_e + v_m r + l w_m t.
    """
    x, y, _ = chain.hand
    r_x, r_y = cos(chain.psi + mount.yaw), sin(chain.psi + mount.yaw)
    v_t = chain.l * w_m
    v_x = base.v_x - base.w_z * y + v_m * r_x - v_t * r_y
    v_y = base.v_y + base.w_z * x + v_m * r_y + v_t * r_x
    c, s = cos(pose.yaw), sin(pose.yaw)
    return float(c * v_x - s * v_y), float(s * v_x + c * v_y), 0.0
