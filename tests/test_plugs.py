"""Plug-ins of somebody else that cannot be used say so at set-up, in one line."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from overreach.errors import UnknownNameError
from overreach.link.messages import Accepted, Refused
from overreach.parameters import schema
from overreach.plugs import BLENDS, blend_plug, law_names, law_plug, load_law, names
from overreach.requests import ResetRequest, RestartRequest, StopRequest
from tests.plugin import install
from tests.processes import Driver, until
from tests.processes import robot as robot_side


def ask(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run a short scenario with a plug-in's law, as a user would."""
    command = [sys.executable, "-m", "overreach", "simulate", "outward", *arguments]
    return subprocess.run(command, env=install(folder), capture_output=True, text=True, check=False, timeout=60)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("--law", "misnamed"), "the law 'misnamed' calls itself 'another': use one name"),
        (("--law", "partial"), "the law 'partial' is no subclass of overreach.law.laws.Law"),
        (("--law", "own", "--set", "gian=2"), "unknown parameter of the law own 'gian'. Did you mean 'gain'?"),
        (("--law", "own", "--set", "gain=fast"), "gain must be a number, got 'fast'"),
        (("--law", "own", "--set", "gain=-1"), "gain must be a finite number > 0, got -1"),
        (("--law", "own", "--set", "gain"), "--set takes NAME=VALUE, got 'gain'"),
        (("--law", "weighted", "--set", "base_weight=0"), "base_weight must be a finite number > 0, got 0"),
        (("--law", "qp", "--set", "solver=daqpp"), "unknown QP solver 'daqpp'. Did you mean 'daqp'?"),
    ],
)
def test_a_plug_that_cannot_be_used(arguments: tuple[str, ...], says: str, tmp_path: Path) -> None:
    """A law that is none, or a parameter that there is not, is one line and exit code 2."""
    done = ask(tmp_path, *arguments)
    assert done.returncode == 2
    assert says in done.stderr
    assert done.stderr.count("\n") == 1
    assert done.stdout == ""


def test_a_law_with_parameters_of_its_own(tmp_path: Path) -> None:
    """A law is one file and one entry point: its two parameters are set, listed and used, and no other line is."""
    plain = ask(tmp_path, "--law", "own", "--json")
    shifted = ask(tmp_path, "--law", "own", "--set", "shift=0.05", "gain=3", "--json")
    assert plain.returncode == shifted.returncode == 0, plain.stderr + shifted.stderr
    outside = [json.loads(done.stdout)["outside_l"] for done in (plain, shifted)]
    assert outside[1] == pytest.approx(outside[0] + 0.05, abs=1e-3)  # on the way in
    command = [sys.executable, "-m", "overreach", "laws"]
    listed = subprocess.run(command, env=install(tmp_path), capture_output=True, text=True, check=True)
    assert re.search(r"own .*\n +gain = 2 1/s +gain\n +shift = 0 m +shift", listed.stdout), listed.stdout


def test_every_parameter_is_described() -> None:
    """Each parameter of each law and blend that is offered has a title, and a default that is valid."""
    for plug in [*map(law_plug, law_names()), *map(blend_plug, names(BLENDS))]:
        for one in schema(plug):
            assert one.title
            one.check(one.default)
            assert one.choices or one.low < one.high
            assert getattr(plug(), one.name) == one.default  # it can be made as it is


BLEND = '''
from typing import Annotated
from overreach.law.blend import Blend
from overreach.parameters import number

def _rise(e, k):
    return min(1.0, max(0.0, 0.5 + e / k))

class Ramp(Blend, frozen=True):
    """A straight rise: continuous, with corners."""
    name = "ramp"
    run: Annotated[float, number("run of the ramp", "m, rad", 0.01, 0.5, above=0.0)] = 0.2

    @property
    def rise(self): return _rise
    @property
    def k_l(self): return self.run
    @property
    def k_psi(self): return self.run
'''
BODY = '''
from typing import Annotated
from overreach.law.body import WholeBody
from overreach.parameters import number
from overreach.types import Plan, Split

class Driver(WholeBody, frozen=True):
    """The base does it all."""
    name = "driver"
    closes_residual = False
    part: Annotated[float, number("part of the speed", "", 0.0, 1.0)] = 1.0

    def planner(self, model):
        still = (0.0,) * len(model.arm.channels)
        return lambda chain, u, base: Plan(Split(1.0, 1.0, self.part * u.u_r, 0.0, 0.0, 0.0), still)
'''
ROBOT = '''
from overreach.robots.kinematic import KinematicRobot

class _Mine:
    """A driver: here of a simulation, as a stand-in for wires."""
    simulated = False

    def __init__(self, now):
        self._robot = KinematicRobot(now=now)
        self.model = self._robot.model

    def read(self, now): return self._robot.read(now)
    def write(self, base, joints, gripper, now, deadline): self._robot.write(base, joints, gripper, now, deadline)
    def stop(self, now): self._robot.stop(now)
    def arm(self, now): self._robot.arm(now)
    def restart(self, now): raise RuntimeError("a real robot is not put back")

def mine(now):
    """The robot next door."""
    return _Mine(now)
'''


def run(env: dict[str, str], *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "overreach", *arguments]
    return subprocess.run(command, env=env, capture_output=True, text=True, check=False, timeout=60)


def test_a_blend_is_one_file_and_one_entry_point(tmp_path: Path) -> None:
    """A blend of somebody else's is listed, chosen by a scenario with its own parameter, and used."""
    env = install(tmp_path, "blends_of_mine", BLEND, "overreach.blends")
    listed = run(env, "laws").stdout
    assert re.search(r"ramp +A straight rise.*\n +run = 0.2 m, rad +run of the ramp", listed), listed
    scenario = tmp_path / "held.toml"
    body = "[command]\nduration = 6.0\nsegments = [{t = 0.0, v_c = 0.4, w_c = 0.0}]\n"
    outside = []
    for run_ in (0.2, 0.1):
        scenario.write_text(f'[law]\nblend = "ramp"\nrun = {run_}\n{body}')
        done = run(env, "simulate", str(scenario), "--json")
        assert done.returncode == 0, done.stderr
        summary = json.loads(done.stdout)
        assert summary["blend"] == "ramp"
        outside.append(summary["outside_l"])
    assert outside == pytest.approx([0.1, 0.05], abs=1e-3)


def test_a_whole_body_is_one_file_and_one_entry_point(tmp_path: Path) -> None:
    """Something that plans all rates itself is listed and chosen as a law is, with its parameter."""
    env = install(tmp_path, "bodies_of_mine", BODY, "overreach.bodies")
    assert re.search(r"driver +The base does it all.\n +part = 1 +part of the speed", run(env, "laws").stdout)
    travel = []
    for part in ("1", "0.5"):
        done = run(env, "simulate", "outward", "--law", "driver", "--set", f"part={part}", "--json")
        assert done.returncode == 0, done.stderr
        travel.append(json.loads(done.stdout)["base_travel"])
    assert travel[1] == pytest.approx(0.5 * travel[0], rel=1e-6)
    assert travel[0] > 1.0


def test_a_robot_is_one_file_and_one_entry_point(tmp_path: Path) -> None:
    """A driver of somebody else's is listed, driven over the wire, told as real, and never put back to its start."""
    env = install(tmp_path, "robots_of_mine", ROBOT, "overreach.robots")
    assert re.search(r"mine +The robot next door.", run(env, "robots").stdout)
    with robot_side("mine", env=env) as (_, _, observer):
        assert not observer.welcome.simulated
        driver = Driver(observer.link)
        driver.arm()
        driver.drive(1.0)
        assert observer.speed() > 0.2
        assert observer.link.request(StopRequest()) == Accepted()
        until(lambda: observer.speed() == 0.0, what="rest")
        assert observer.link.request(ResetRequest()) == Accepted()
        assert observer.link.request(RestartRequest()) == Refused("A real robot is not put back.")


BROKEN = {
    "leaving": "import sys\nsys.exit(7)\n",
    "raising": "raise OSError('no such device')\n",
    "needing": """
from typing import Annotated
import overreach as ov
from overreach.parameters import number
class Needing(ov.Law, frozen=True):
    name = "needing"
    gain: Annotated[float, number("gain", "", 0.0, 1.0)]
""",
    "unknown": """
from __future__ import annotations
import overreach as ov
class Unknown(ov.Law, frozen=True):
    name = "unknown"
    gain: NoSuchType = 1.0
""",
}


def test_a_plug_that_is_broken_breaks_nothing_else(tmp_path: Path) -> None:
    """Plugs that leave, raise or cannot be described: they are listed with the reason; robot side and others go on."""
    folders = []
    for name, text in BROKEN.items():
        (tmp_path / name).mkdir()
        env = install(tmp_path / name, f"broken_{name}", text)
        info = tmp_path / name / f"broken_{name}-1.0.dist-info"
        (info / "entry_points.txt").write_text(
            f"[overreach.laws]\n{name} = broken_{name}:{name.capitalize()}\n"
            f"[overreach.robots]\n{name} = broken_{name}:{name.capitalize()}\n"
        )
        folders.append(env["PYTHONPATH"])
    env |= {"PYTHONPATH": os.pathsep.join(folders)}
    listed = run(env, "laws")
    assert listed.returncode == 0, listed.stderr
    for name in BROKEN:
        assert re.search(rf"{name} +cannot be used: ", listed.stdout), listed.stdout
    robots = run(env, "robots")
    assert robots.returncode == 0, robots.stderr
    assert "cannot be used: OSError: no such device" in robots.stdout
    with robot_side(env=env) as (_, _, observer):
        assert "exact" in observer.welcome.laws
        assert not set(BROKEN) & set(observer.welcome.laws)


def test_a_parameter_that_is_no_number_or_text_is_not_set_from_outside() -> None:
    """A blend is chosen as a blend, not as a text that would break later."""
    with pytest.raises(UnknownNameError, match="unknown parameter of the law exact 'blend'"):
        load_law("exact", {"blend": "tanh"})
