"""Streams of messages and acts at their worst, through the whole pilot with a simulated robot: the robot side's way of
one tick, without a wire, by the hundred thousand.
"""

from __future__ import annotations

import itertools
import math
import random
import time
from collections import Counter

import pytest

from overreach.arm.chain import Chain
from overreach.control.pilot import Pilot
from overreach.gate.gate import STALE_S
from overreach.law.body import NO_SOLUTION
from overreach.law.laws import Exact
from overreach.model.model import channels
from overreach.model.planar import planar
from overreach.plugs import load_law
from overreach.requests import ArmRequest, DisarmRequest, ResetRequest, StopRequest
from overreach.robots.kinematic import KinematicRobot
from overreach.types import Command, Frame, HandTwist, Plan, Split, Twist
from overreach.verdicts import Verdict
from tests.guarded import test_worst
from tests.reached import Reached
from tests.said import said
from tests.side import CHANGE, ME, MOST, STOP_S, Side

DT = 0.005
ODD = (math.nan, math.inf, -math.inf, 1e308, -1e308, 1e9, -3.0, 0.0, 5e-324)


class Bare:
    """Pilot and robot with every input in the test's hands. `now` starts anywhere but at 0."""

    def __init__(self, start: float, pilot: Pilot | None = None) -> None:
        self.now = start
        self.robot = KinematicRobot(now=start)
        self.pilot = pilot or Pilot(planar(), Exact())
        self.rates: tuple[float, ...] = (0.0,) * 4
        self.pilot.ask(ArmRequest(ME), start)

    def tick(self, command: Command | None = None) -> tuple[float, ...]:
        """Run one period; return what was written, after checking that it is finite and bounded."""
        tick = self.pilot.tick(self.robot.read(self.now), command, self.now, DT)
        self.verdict = tick.verdict
        self.robot.write(tick.base, tick.joints, None, self.now, self.now + 2 * DT)
        before, self.rates = self.rates, tick.decided.rates
        for was, is_, most, change in zip(before, self.rates, MOST, CHANGE, strict=True):
            assert abs(is_) <= most * (1 + 1e-9)  # False for NaN
            assert abs(is_ - was) <= change * DT * (1 + 1e-9)
        self.now += DT
        return self.rates


def test_a_link_lost_at_any_phase(reached: Reached) -> None:
    """Whenever the link falls silent: zero within 200 ms + tick + v/a; then no motion on its return; then a press."""
    rng, times, latest = random.Random(reached.seed), reached.times(1000), 0.0
    for _ in range(times):
        side = Side(start=rng.uniform(1.0, 1e5))
        side.arm()
        side.drive(0.3 + rng.uniform(0.0, 0.2), rng.uniform(-0.4, 0.4), rng.uniform(-0.4, 0.4))
        bare = Bare.__new__(Bare)
        bare.now, bare.robot, bare.pilot = side.now, side.robot, side.pilot
        bare.rates = side.written[-1]
        since, heard = bare.now, bare.now - DT + rng.uniform(0.0, DT)
        while any(bare.tick()):
            assert bare.now - heard < 1.0
        latest = max(latest, bare.now - DT - heard)
        assert bare.now - DT - heard <= STALE_S + DT + STOP_S + DT
        while bare.now - since < 1.1:
            assert not any(bare.tick())
        for _ in range(40):
            side.seq += 1
            assert not any(bare.tick(said(ME, side.seq, side.grip, True, 0.4, 0.0, seen=bare.now)))
        for _ in range(40):
            side.seq += 1
            bare.tick(said(ME, side.seq, side.grip + 1, True, 0.4, 0.0, seen=bare.now))
        assert any(bare.rates)
    reached.say(
        "link lost at any phase",
        f"{times} of {times} phases at zero, after {latest * 1e3:.0f} ms at most ({(STALE_S + DT + STOP_S) * 1e3:.0f} "
        "allowed); none moved on return",
    )


def test_jitter(reached: Reached) -> None:
    """Commands every 30 ms, each 100 +- 50 ms on its way: limits kept, and no stop while none is 150 ms late."""
    rng, ticks = random.Random(reached.seed), reached.times(1_000_000)
    bare = Bare(rng.uniform(1.0, 1e5))
    coming: list[tuple[float, Command]] = []
    seq, stops, silent, longest, moved = 0, 0, bare.now, 0.0, 0
    next_at = bare.now
    for k in range(ticks):
        if bare.now >= next_at:
            seq += 1
            wave = 0.3 * math.sin(0.7 * k * DT), 0.3 * math.cos(0.4 * k * DT)
            coming.append((bare.now + rng.uniform(0.05, 0.15), said(ME, seq, 1, True, *wave, seen=bare.now)))
            coming.sort(key=lambda one: one[0])
            next_at += 0.03
        arrived = None
        while coming and coming[0][0] <= bare.now:
            one = coming.pop(0)[1]
            arrived = one if arrived is None or one.seq > arrived.seq else arrived
        if arrived is not None:
            silent = bare.now
        longest = max(longest, bare.now - silent)
        bare.tick(arrived)
        moved += any(bare.rates)
        stops += bare.verdict in (Verdict.STALE, Verdict.LOST, Verdict.DELAYED)
    assert moved > 0.9 * ticks
    assert longest < 0.15
    assert stops == 0
    reached.say("late, jitter 100 +- 50 ms", f"{ticks:,} ticks: 0 breaches of a limit, {stops} false stops")


def test_duplicates_and_disorder(reached: Reached) -> None:
    """A stream with repeats and old messages between gives, to the bit, what its sorted unique self gives."""
    rng, messages = random.Random(reached.seed), reached.times(100_000)
    start = rng.uniform(1.0, 1e5)
    clean, dirty = Bare(start), Bare(start)
    sent: list[Command] = []
    for k in range(messages):
        command = said(ME, k + 1, 1, rng.random() < 0.99, rng.uniform(-0.4, 0.4), rng.uniform(-1, 1), seen=clean.now)
        sent.append(command)
        rates = clean.tick(command)
        for _ in range(rng.randrange(3)):
            old = rng.choice(sent[-50:-1] or [command])
            dirty.pilot.gate.accept(old, dirty.now) if old is not command else None
        dirty.pilot.gate.accept(command, dirty.now)
        assert dirty.tick(command if rng.random() < 0.5 else None) == rates
    reached.say("duplicate, reordered", f"{messages:,} messages among repeats and old ones: the same output to the bit")


def test_a_replayed_session(reached: Reached) -> None:
    """All that an operator said once is sent again, when it drives, rests, and while another drives: none is taken."""
    rng, many = random.Random(reached.seed), reached.times(10_000)
    bare = Bare(rng.uniform(1.0, 1e5))
    old = []
    for k in range(many):
        old.append(said(ME, k + 1, 1, True, 0.3, 0.1, seen=bare.now))
        bare.tick(old[-1])
    gate = bare.pilot.gate
    accepted = 0
    for phase in ("drives", "another drives", "arms again"):
        if phase == "another drives":
            bare.pilot.ask(DisarmRequest(ME), bare.now)
            for _ in range(300):
                bare.tick()
            assert bare.pilot.ask(ArmRequest(ME + 1), bare.now) == ""
        elif phase == "arms again":
            bare.pilot.ask(DisarmRequest(ME + 1), bare.now)
            for _ in range(300):
                bare.tick()
            assert bare.pilot.ask(ArmRequest(ME), bare.now) == ""
        for operator in range(100, 200):
            gate.accept(said(operator, 10**9, 1, True, 0.3, 0.0, seen=bare.now), bare.now)
        accepted += sum(gate.accept(one, bare.now) is None for one in old)
    assert accepted == 0
    reached.say("replay of an old session", f"{accepted} of {3 * many:,} accepted, beside 100 foreign operators")


def test_what_is_not_finite_and_what_is_huge(reached: Reached) -> None:
    """Any numbers in a command, at any time: what is written is finite and within the accelerations."""
    rng, ticks = random.Random(reached.seed), reached.times(1_000_000)
    bare = Bare(rng.uniform(1.0, 1e5))
    grip, seen_odd, moved = 1, 0, 0
    for k in range(ticks):
        odd = rng.random() < 0.3
        parts = [rng.choice(ODD) if odd and rng.random() < 0.5 else rng.uniform(-0.5, 0.5) for _ in range(3)]
        twist = Twist(parts[0], parts[1] if rng.random() < 0.3 else 0.0, 0.0, 0.0, 0.0, parts[2])
        frame = Frame.WORLD if k % 20_000 < 10_000 else Frame.HAND
        grip += k % 10_000 == 0
        held = k % 10_000 < 9_900
        seen = rng.choice(ODD) if rng.random() < 0.02 else bare.now - rng.uniform(0.0, 0.3)
        bare.tick(Command(ME, k + 1, grip, held, twist, frame, None, seen))
        seen_odd += odd
        moved += any(bare.rates)
    assert moved > 0.5 * ticks
    assert bare.pilot.gate.latch.fault == ""
    reached.say("NaN, inf, wrong type, extra field", f"0 outputs that are not finite in {ticks:,} ticks")
    reached.say("huge jump", f"abs(dv) <= a dt in {ticks:,} of {ticks:,} ticks, {seen_odd:,} of them with NaN to 1e308")


def test_clocks_that_jump(reached: Reached, monkeypatch: pytest.MonkeyPatch) -> None:
    """The date jumps by up to an hour at any time: what is written is the same to the bit."""
    ticks, outputs = reached.times(20_000), []
    real = time.time
    for jumps in (False, True):
        rng = random.Random(reached.seed)
        bare, out = Bare(1234.5), []
        for k in range(ticks):
            if jumps:
                off = rng.uniform(-3600.0, 3600.0)
                monkeypatch.setattr(time, "time", lambda off=off: real() + off)
            out.append(bare.tick(said(ME, k + 1, 1, True, 0.3 * math.sin(k * 0.003), 0.2, seen=bare.now)))
        outputs.append(out)
    assert outputs[0] == outputs[1]
    assert any(any(rates) for rates in outputs[0])
    reached.say("wall-clock jump, sender clock +-1 h", f"identical over {ticks:,} ticks with as many jumps")


def test_a_backlog(reached: Reached) -> None:
    """A sender is suspended while it drives and then sends all that it had kept: nothing moves until a new press."""
    rng, times = random.Random(reached.seed), reached.times(200)
    for _ in range(times):
        bare, seq = Bare(rng.uniform(1.0, 1e5)), 0
        for _ in range(100):
            seq += 1
            bare.tick(said(ME, seq, 1, True, 0.4, 0.0, seen=bare.now))
        begun, kept = bare.now, []
        for k in range(100):
            kept.append(said(ME, seq + k + 1, 1, True, 0.4, 0.0, seen=begun + 0.016 * k))
        for _ in range(round(rng.uniform(0.6, 3.0) / DT)):
            bare.tick()
        for command in kept:
            bare.pilot.gate.accept(command, bare.now)
            assert not any(bare.tick())
        seq += 100
        for _ in range(60):
            seq += 1
            assert not any(bare.tick(said(ME, seq, 1, True, 0.4, 0.0, seen=bare.now)))
        for _ in range(60):
            seq += 1
            bare.tick(said(ME, seq, 2, True, 0.4, 0.0, seen=bare.now))
        assert any(bare.rates)
    reached.say("sender suspended, then backlog", f"{times} of {times}: no motion until a new press")


def test_eight_operators_at_once(reached: Reached) -> None:
    """Eight push, arm, disarm and let go at random: what moves is what the one who armed says, and takeover is rest."""
    rng, ticks = random.Random(reached.seed), reached.times(200_000)
    bare = Bare(rng.uniform(1.0, 1e5))
    latch = bare.pilot.gate.latch
    people = {operator: {"seq": 0, "grip": 0, "held": 0} for operator in range(1, 9)}
    ways = {operator: (0.3 * math.cos(operator), 0.3 * math.sin(operator)) for operator in people}
    source, drivers = 0, Counter[int]()
    for _ in range(ticks):
        operator = rng.choice(list(people))
        one = people[operator]
        if rng.random() < 0.01:
            ask = ArmRequest(operator, one["grip"]) if rng.random() < 0.5 else DisarmRequest(operator)
            bare.pilot.ask(ask, bare.now)
        if rng.random() < 0.02:
            one["held"] = 1 - one["held"]
            one["grip"] += one["held"]
        one["seq"] += 1
        x, y = ways[operator]
        command = Command(
            operator, one["seq"], one["grip"], bool(one["held"]), Twist(x, y), Frame.WORLD, None, bare.now
        )
        bare.tick(command)
        twist = bare.pilot.gate._twist
        source = 0 if twist == Twist() else source or latch.operator
        if source:  # from rest to rest there is one
            x, y = ways[source]
            assert abs(twist.v_x * y - twist.v_y * x) < 1e-12
            assert twist.v_x * x + twist.v_y * y > 0.0
            drivers[source] += 1
        if rng.random() < 0.0005:
            for _ in range(220):
                bare.tick()
    assert len(drivers) >= 3
    reached.say(
        "two operators", f"8 clients, {ticks:,} messages: 0 ticks with two sources; {len(drivers)} drove, one by one"
    )


def test_the_way_out_of_a_stop(reached: Reached) -> None:
    """No sequence of acts leads from STOPPED to motion without reset, arm, release and press, in that order."""
    acts = ("reset", "arm", "release", "press", "stop", "silence")
    length = 8 if reached.full else 6
    sequences = 0
    for acted in itertools.product(acts, repeat=length):
        if acted[-1] != "press" or "stop" in acted[1:]:
            continue  # nothing else ends in motion, and a later stop begins a shorter sequence
        sequences += 1
        bare, grip, held, seq = Bare(50.0), 1, True, 0
        gate = bare.pilot.gate
        bare.pilot.ask(StopRequest(), bare.now)
        done: list[str] = []
        for act in acted:
            if act == "reset":
                bare.pilot.ask(ResetRequest(), bare.now)
            elif act == "arm":
                bare.pilot.ask(ArmRequest(ME, grip), bare.now)
            elif act == "stop":
                bare.pilot.ask(StopRequest(), bare.now)
            elif act == "release":
                held = False
            elif act == "press":
                grip, held = grip + (not held), True
            elif act == "silence":
                bare.now += 1.2
            if act != "silence":
                seq += 1
                gate.accept(said(ME, seq, grip, held, 0.4, 0.0, seen=bare.now), bare.now)
            gate.tick(bare.now, DT)
            bare.now += DT
            done.append(act)
            if not gate.resting:
                order = iter(done)
                assert all(step in order for step in ("reset", "arm", "press")), done
                order = iter(done)
                assert all(step in order for step in ("release", "press")), done
                break
    told = f"{sequences:,} sequences of {length} acts: none moves without reset, arm, release, press"
    reached.say("Stop pressed", told)


def test_joints_stay_within_their_limits(reached: Reached) -> None:
    """Pushed at random, for long, against every end: joints pass no limit, and no rate its own."""
    rng, ticks = random.Random(reached.seed), reached.times(400_000)
    bare = Bare(rng.uniform(1.0, 1e5))
    joints = channels(planar())[2:]
    past, fastest, push = 0.0, 0.0, Twist()
    for k in range(ticks):
        if k % 150 == 0:
            push = Twist(rng.uniform(-0.6, 0.6), rng.uniform(-0.6, 0.6))
        bare.tick(Command(ME, k + 1, 1, True, push, Frame.WORLD, None, bare.now))
        state = bare.robot.true
        for joint, q, dq in zip(joints, state.q, state.dq, strict=True):
            past = max(past, q - joint.upper, joint.lower - q)
            fastest = max(fastest, abs(dq) / joint.rate_max)
    turns = 0.0
    for _ in range(reached.times(100)):
        angle = rng.uniform(-math.pi, math.pi)
        push = Twist(0.4 * math.cos(angle), 0.4 * math.sin(angle))
        still = Bare(rng.uniform(1.0, 1e5))
        signs: list[list[float]] = [[], []]
        for k in range(1600):
            still.tick(Command(ME, k + 1, 1, True, push, Frame.WORLD, None, still.now))
            for sign, dq in zip(signs, still.rates[2:], strict=True):
                if k > 200 and abs(dq) > 1e-6 and (not sign or dq * sign[-1] < 0.0):
                    sign.append(dq)
        turns = max(turns, *[(len(sign) - 1) / 7.0 for sign in signs])
    assert turns < 2.0
    assert past <= 1e-3
    assert fastest <= 1.0 + 1e-9
    reached.say(
        "joint limit, singularity, out of reach",
        f"{ticks:,} ticks: overshoot {max(0.0, past):.1g} rad, joint speed {fastest:.3f} of its limit, "
        f"{max(0.0, turns):.1f} sign changes of a joint a second, pushed one way for 8 s, at most",
    )


def test_feedback_at_its_worst(reached: Reached) -> None:
    """Any law and any stream of states, in any order and with any acts: bounded, and zero within v/a of a stop."""
    rng, times = random.Random(reached.seed), reached.times(2_000)
    one = test_worst.test_any_plan_and_any_feedback.hypothesis.inner_test  # type: ignore[attr-defined]  # hypothesis's own
    for _ in range(times):
        one(rng.randrange(10**9))
    reached.say(
        "feedback NaN, out of range, biased, frozen, not following",
        f"{times:,} random streams of wild states and laws, with stops: every limit kept, zero within v/a",
    )


@pytest.mark.parametrize("name", ["qp", "holistic", "weighted"])
def test_a_baseline_that_fails(name: str, reached: Reached) -> None:
    """A rival whose plan raises, is none, or is not finite at random times: it rests, and no exception leaves."""
    rng, ticks = random.Random(reached.seed), reached.times(20_000)
    law = load_law(name, {})
    planner, faults = law.planner(planar()), 0

    def plan(chain: Chain, u: HandTwist, base: Twist) -> object:
        if rng.random() < 0.01:
            kind = rng.randrange(4)
            if kind == 0:
                raise rng.choice((ValueError, ZeroDivisionError, MemoryError, ArithmeticError))("of a solver")
            return (None, "no plan", Plan(Split(0.0, 0.0, math.nan, 0.0, 0.0, 0.0)), NO_SOLUTION)[kind]
        return planner(chain, u, base)

    pilot = Pilot(planar(), law)
    pilot.configure(law, planner=plan)  # type: ignore[arg-type]  # it is to answer nonsense
    bare, grip = Bare(rng.uniform(1.0, 1e5), pilot), 1
    for k in range(ticks):
        bare.tick(said(ME, k + 1, grip, True, 0.3 * math.sin(0.002 * k), 0.2, Frame.WORLD, seen=bare.now))
        if pilot.gate.latch.fault and not any(bare.rates):
            faults += 1
            pilot.ask(ResetRequest(), bare.now)
            pilot.ask(ArmRequest(ME, grip), bare.now)
            grip += 1
    assert faults > 0.002 * ticks
    told = f"{name}: {ticks:,} ticks, {faults} failures: a ramp each, 0 exceptions left the pilot"
    reached.say("baseline's solver fails", told)
