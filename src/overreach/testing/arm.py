"""What every arm must satisfy. In a test of your own: `check_arm(my_arm(), samples)`."""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import pairwise

from overreach.arm.chain import NO_REST, Arm, Chain
from overreach.arm.mount import Mount
from overreach.arm.polar import wrap
from overreach.verdicts import Verdict

H = 1e-6
"""Step [rad, m] of the finite differences that check a Jacobian ..."""
SLOPE = 1e-5
"""... and how close [m/rad and so on] it must be to them."""
SAME = 1e-9
"""How closely [m, rad, and per s] two ways to compute one number must agree."""
SPEED = 0.2
"""Hands are commanded at this speed [m/s, rad/s] ..."""
PERIOD = 0.005
"""... over periods of this length [s]."""
STILL = 1e-9
"""How slowly [rad/s, m/s] joints move that are not to move: rounding."""
ENDS = 1e-6
"""How close [m, rad] a period must end to where it should."""


def check_arm(arm: Arm, samples: Iterable[tuple[float, ...]], mount: Mount | None = None) -> None:
    """Raise AssertionError, with the joints, where `arm` breaks a promise; `samples`: joints well inside its workspace.

    Checked at each: hand, l and psi agree, and turn and shift with the mount; the Jacobian is the slope of the hand by
    differences; `moved` is the Jacobian's product; rates undo it in the rows that the arm has; a period ends where it
    should; the line of the links ends at the hand; the manipulability's gradient is its slope; all of it is a function
    of the joints alone; and `posture` puts the hand where it is asked for.
    """
    mount = mount or Mount()
    for joints in samples:
        chain = arm.at(joints, mount)
        where = f"at {joints}"
        assert chain.joints == joints, f"forgets its joints {where}"
        assert len(joints) == len(arm.channels), f"has {len(arm.channels)} channels, not {len(joints)} {where}"
        _check_place(arm, chain, mount, where)
        _check_slopes(arm, chain, mount, where)
        _check_rates(arm, chain, mount, where)
        posture = arm.at(arm.posture(chain.l, chain.psi), mount)
        off = max(abs(posture.l - chain.l), abs(wrap(posture.psi - chain.psi)))
        assert off <= ENDS, f"posture is {off:.2g} off (l, psi) {where}"
        again = arm.at(joints, mount)
        same = (again.l, again.psi, again.hand, again.jacobian()) == (chain.l, chain.psi, chain.hand, chain.jacobian())
        assert same, f"not a pure function {where}"


def _check_place(arm: Arm, chain: Chain, mount: Mount, where: str) -> None:
    x, y, z = chain.hand
    psi_d = chain.psi + mount.yaw
    off = math.hypot(mount.s_x + chain.l * math.cos(psi_d) - x, mount.s_y + chain.l * math.sin(psi_d) - y)
    assert off <= SAME, f"hand and (l, psi) are {off:.2g} m apart {where}"
    assert -math.pi < chain.psi <= math.pi, f"psi is not wrapped {where}"
    least, most = arm.reach
    assert least - SAME <= chain.l <= most + SAME, f"l = {chain.l:g} m is out of reach {where}"
    centred = arm.at(chain.joints, Mount())
    assert (centred.l, centred.psi) == (chain.l, chain.psi), f"(l, psi) depend on the mount {where}"
    assert centred.hand[2] == z, f"the hand's height depends on the mount {where}"
    assert math.dist(chain.points[-1], chain.hand) <= SAME, f"the links do not end at the hand {where}"
    assert math.dist(chain.points[0][:2], (mount.s_x, mount.s_y)) <= SAME, f"they begin elsewhere {where}"
    assert all(map(math.isfinite, (value for point in chain.points for value in point))), f"a link is nowhere {where}"
    assert any(one != other for one, other in pairwise(chain.points)), f"the links have no length {where}"


def _check_slopes(arm: Arm, chain: Chain, mount: Mount, where: str) -> None:
    jacobian, gradient = chain.jacobian(), chain.towards_manipulability()
    assert len(jacobian) == 6, f"the Jacobian has {len(jacobian)} rows, not 6 {where}"
    for k in range(len(chain.joints)):
        ends = []
        for sign in (1.0, -1.0):
            joints = list(chain.joints)
            joints[k] += sign * H
            ends.append(arm.at(tuple(joints), mount))
        one, other = ends
        slopes = (
            (one.l - other.l) / (2 * H),
            wrap(one.psi - other.psi) / (2 * H),
            (one.hand[2] - other.hand[2]) / (2 * H),
        )
        for row, slope in enumerate(slopes):
            off = abs(jacobian[row][k] - slope)
            assert off <= SLOPE, f"row {row} of the Jacobian is {off:.2g} off the slope of joint {k} {where}"
        rise = (one.manipulability - other.manipulability) / (2 * H)
        assert abs(gradient[k] - rise) <= SLOPE, f"the manipulability's gradient is off at joint {k} {where}"


def _check_rates(arm: Arm, chain: Chain, mount: Mount, where: str) -> None:
    for k in range(6):
        if k not in arm.rows:
            continue
        asked = [SPEED if j == k else 0.0 for j in range(6)]
        rest = (asked[2], asked[3], asked[4], asked[5])
        rates, verdict = chain.rates(asked[0], asked[1], rest, 0.0)
        assert verdict is Verdict.MOVING, f"gives way ({verdict}) {where}"
        moved = chain.moved(rates)
        product = [sum(a * b for a, b in zip(row, rates, strict=True)) for row in chain.jacobian()]
        assert max(abs(a - b) for a, b in zip(moved, product, strict=True)) <= SAME, f"moved is not J dq {where}"
        off = max(abs(moved[j] - asked[j]) for j in arm.rows)
        assert off <= 100 * SAME, f"asked to move in row {k}, the rates are {off:.2g} off {where}"
        _check_period(arm, chain, mount, asked, f"row {k} {where}")
    for dt in (0.0, PERIOD):
        still, _ = chain.rates(0.0, 0.0, NO_REST, dt)
        assert max(map(abs, still)) <= STILL, f"moves without being asked to {where}: {still}"


def _check_period(arm: Arm, chain: Chain, mount: Mount, asked: list[float], where: str) -> None:
    rates, _ = chain.rates(asked[0], asked[1], (asked[2], asked[3], asked[4], asked[5]), PERIOD)
    joints = tuple(angle + rate * PERIOD for angle, rate in zip(chain.joints, rates, strict=True))
    after = arm.at(joints, mount)
    off = max(
        abs(after.l - chain.l - asked[0] * PERIOD),
        abs(wrap(after.psi - chain.psi - asked[1] * PERIOD)),
        abs(after.hand[2] - chain.hand[2] - asked[2] * PERIOD),
    )
    assert off <= ENDS, f"a period ends {off:.2g} off where it should: {where}"
