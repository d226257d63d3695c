"""What a robot can do in one period, from where it is and what was written last: one scale for the whole command."""

from __future__ import annotations

from overreach.arm.limits import Room, room
from overreach.gate.guard import Guard
from overreach.gate.limits import clamp_change, feasible_scale, within
from overreach.model.model import Model, channels
from overreach.types import Channel
from overreach.verdicts import Verdict


class Bounds:
    """Speed, acceleration and joint limits of a robot, applied from the rates that its guard wrote last."""

    def __init__(self, model: Model, guard: Guard) -> None:
        each = channels(model)
        self._guard = guard
        self._joints: tuple[Channel, ...] = model.arm.channels
        self._axes = model.base.axes
        self.tops = tuple(channel.rate_max for channel in each)
        """Greatest rate of each channel."""
        self._changes = tuple(channel.change_max for channel in each)
        self._dt = 0.0
        self.steps: tuple[float, ...] = ()
        """Greatest change of each in the period that was prepared for."""
        self._free: list[tuple[float, float]] = []

    def keep(self, rates: tuple[float, ...], q: tuple[float, ...], dt: float) -> bool:
        """Say whether no limit binds: all `rates` can be written unchanged at joints `q`."""
        if dt != self._dt:
            self.prepare(dt)
        for angle, (low, high) in zip(q, self._free, strict=True):
            if not low <= angle <= high:
                return False
        return within(rates, self._guard.written, self.tops, self.steps)

    def prepare(self, dt: float) -> None:
        """Precompute, for a period of `dt` [s], the allowed changes of rates and where no limit slows a joint."""
        self._dt, self.steps = dt, tuple([change * dt for change in self._changes])
        self._free = []
        for joint in self._joints:
            # As in `fastest_towards`, braking at half of what the joint can.
            margin = max(joint.rate_max * joint.rate_max / joint.change_max, joint.rate_max * dt)
            self._free.append((joint.lower + margin, joint.upper - margin))

    def room(self, q: tuple[float, ...], dt: float) -> Room:
        """Return how fast each joint may move at `q`, in either direction."""
        return room(self._joints, q, dt)

    def scale(self, rates: tuple[float, ...], owed: tuple[float, ...], free: Room) -> tuple[float, Verdict]:
        """Return the greatest scale of the command at which no limit is passed, and why.

        rates: of base and joints at scale 1; owed: the part of them that the joints owe the base at any scale;
        free: the joints' `room`.
        """
        axes = self._axes
        joints = rates[axes:]
        fastest = [high if rate >= 0.0 else -low for rate, (low, high) in zip(joints, free, strict=True)]
        commanded = (*rates[:axes], *[rate - own for rate, own in zip(joints, owed, strict=True)])
        most = (*self.tops[:axes], *fastest)
        scale, verdict = feasible_scale(commanded, self._guard.written, most, self.steps, (*(0.0,) * axes, *owed))
        if verdict is Verdict.SPEED and any(
            abs(rate) * scale >= top * 0.999 and top < usual * 0.999
            for rate, top, usual in zip(joints, fastest, self.tops[axes:], strict=True)
        ):
            verdict = Verdict.JOINT_LIMIT
        return scale, verdict

    def base(self, rates: tuple[float, ...]) -> tuple[float, ...]:
        """Return the base's rates, clamped to its acceleration limits."""
        return tuple(map(clamp_change, rates, self._guard.written, self.steps))

    def joints(self, rates: tuple[float, ...], free: Room) -> tuple[float, ...]:
        """Return joint rates clamped first to what can still stop in time, then to the acceleration limits."""
        return tuple(
            [
                clamp_change(max(low, min(high, rate)), was, change)
                for rate, (low, high), was, change in zip(
                    rates, free, self._guard.written[self._axes :], self.steps[self._axes :], strict=True
                )
            ]
        )
