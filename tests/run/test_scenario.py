from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import msgspec
import pytest

from overreach.errors import SetupError
from overreach.model.planar import planar
from overreach.plugs import law_names
from overreach.run.row import Row
from overreach.run.scenario import builtin_scenarios, load_scenario, parse_scenario
from overreach.run.simulate import simulate
from overreach.types import Frame

COMMAND = "[command]\nduration = 1.0\nsegments = [{t = 0.0, v_c = 0.1, w_c = 0.0}]\n"

BAD = {
    "unknown table": ("[robbot]\nl = 0.5\n" + COMMAND, "Did you mean 'robot'"),
    "unknown key": ("[robot]\nlength = 0.5\n" + COMMAND, "unknown key in [robot] 'length'"),
    "unknown key in a segment": (COMMAND.replace("w_c", "wc"), "Did you mean 'w_c'"),
    "limits out of order": ("[workspace]\nl_min = 0.9\n" + COMMAND, "l_min < l_max"),
    "nan": ("[robot]\nl = nan\n" + COMMAND, "robot.l must be a finite number"),
    "inf in a command": (COMMAND.replace("0.1", "inf"), "command.segments.v_c must be a finite number"),
    "wrong type": ('[robot]\nl = "far"\n' + COMMAND, "robot.l: Expected"),
    "unreachable start": ("[robot]\nl = 1.4\n" + COMMAND, "cannot reach l = 1.4 m"),
    "start turned too far": ("[robot]\npsi = 4.0\n" + COMMAND, "robot.psi"),
    "workspace out of reach": ("[workspace]\nl_max = 1.4\n" + COMMAND, "reach"),
    "unknown robot": ('[robot]\nname = "plannar"\n' + COMMAND, "Did you mean 'planar'"),
    "unknown blend": ('[law]\nblend = "tan"\n' + COMMAND, "Did you mean 'tanh'"),
    "unknown frame": (COMMAND + 'frame = "hnd"', "valid: hand, polar, base, world"),
    "no command": ("[robot]\nl = 0.5\n", "missing required table [command]"),
    "negative width": ("[law]\nalpha = -1.0\n" + COMMAND, "alpha must be a finite number > 0"),
    "command beyond reason": (COMMAND.replace("0.1", "1e308"), "within +-1000"),
    "noise beyond reason": ("[robot]\nnoise = 1e308\n" + COMMAND, "noise must be at most"),
    "no time": (COMMAND.replace("1.0", "0.0"), "must be > 0 s"),
    "too many steps": (COMMAND + "dt = 1e-9", "steps"),
    "times out of order": (
        "[command]\nduration = 1.0\nsegments = [{t=1.0,v_c=0,w_c=0},{t=0.5,v_c=0,w_c=0}]",
        "must increase",
    ),
    "neither segments nor file": ("[command]\nduration = 1.0\n", "either segments or file"),
    "both": (COMMAND + 'file = "x.csv"', "either segments or file"),
    "missing file": ('[command]\nduration = 1.0\nfile = "none.csv"', "no command file"),
    "not TOML": ("[command\n", "not valid TOML"),
    "noise below zero": ("[robot]\nnoise = -0.1\n" + COMMAND, "noise"),
    "limit of zero": (COMMAND + "[limits]\nv_c = 0.0\n", "limit v_c"),
    "hand over the turning centre": ("[robot]\nshoulder = [-0.7, 0.0]\n" + COMMAND, "turning centre"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_scenarios_say_what_is_wrong(name: str) -> None:
    """What cannot be run is refused with one line that says what is wrong and what is valid."""
    text, says = BAD[name]
    with pytest.raises(SetupError) as caught:
        simulate(parse_scenario(text))
    assert says in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("law", law_names(planar()))
@pytest.mark.parametrize("name", builtin_scenarios())
def test_every_builtin_runs_with_every_law(name: str, law: str) -> None:
    """Every built-in scenario runs with every law, in its own frame, and says what it is about."""
    whole = load_scenario(name)
    scenario = msgspec.structs.replace(whole, dt=0.01, duration=min(whole.duration, 20.0))
    done = simulate(scenario, law)
    assert done.summary.steps == len(done.rows) == scenario.steps
    assert done.summary.frame == (scenario.frame or ("hand" if law in ("exact", "holistic", "weighted") else "polar"))
    assert scenario.description
    assert set(done.summary.verdicts) <= ({"moving", "out_of_reach"} if law in ("weighted", "qp") else {"moving"})


def test_commands_from_a_file_are_those_of_segments(tmp_path: Path) -> None:
    """A command file, looked for beside its scenario, gives the same run as the same segments."""
    (tmp_path / "commands.csv").write_text("t,v_c,w_c\n0.0,0.1,0.0\n0.5,-0.2,0.3\n")
    (tmp_path / "a.toml").write_text('[command]\nduration = 1.0\nfile = "commands.csv"\n')
    segments = "segments = [{t=0.0, v_c=0.1, w_c=0.0}, {t=0.5, v_c=-0.2, w_c=0.3}]"
    same = parse_scenario(f"[command]\nduration = 1.0\n{segments}")
    assert simulate(str(tmp_path / "a.toml")).rows == simulate(same).rows


@pytest.mark.parametrize("text", ["0,1,2\n", "t,v_c,w_c\n0,1\n", "t,v_c,w_c\n0,nan,1\n", "t,v_c,w_c\n0,a,1\n", ""])
def test_bad_command_files(text: str, tmp_path: Path) -> None:
    """A command file without its header or with a row that is not three finite numbers is refused."""
    (tmp_path / "commands.csv").write_text(text)
    (tmp_path / "a.toml").write_text('[command]\nduration = 1.0\nfile = "commands.csv"\n')
    with pytest.raises(SetupError, match="commands"):
        load_scenario(str(tmp_path / "a.toml"))


def test_segments_hold_until_the_next() -> None:
    """Each segment's command holds from its time until the next; before the first nothing is asked for."""
    scenario = parse_scenario(
        "[command]\nduration = 1.0\ndt = 0.1\nsegments = [{t=0.3,v_c=0.1,w_c=0.0},{t=0.7,v_c=0.2,w_c=0.0}]"
    )
    assert [row.v_c for row in simulate(scenario).rows] == [0, 0, 0, 0.1, 0.1, 0.1, 0.1, 0.2, 0.2, 0.2]


def test_limits_are_off_unless_asked_for() -> None:
    """Without [limits] a step is a step; with it the command ramps and never passes its limit."""
    text = COMMAND.replace("0.1", "0.8")
    assert simulate(parse_scenario(text)).rows[0].v_c == 0.8
    rows = simulate(parse_scenario(text + "[limits]\n")).rows
    assert rows[0].v_c == pytest.approx(0.0025)
    assert max(row.v_c for row in rows) == pytest.approx(0.4)


def test_frames_of_a_scenario() -> None:
    """A frame that the scenario names is used instead of the law's own."""
    for frame in Frame:
        done = simulate(parse_scenario(COMMAND + f'frame = "{frame}"'), "paper")
        assert done.summary.frame == frame


def test_same_seed_same_run() -> None:
    """Noise is drawn from the scenario's seed: the same seed gives the same rows, another gives others."""
    text = "[robot]\nnoise = 0.01\nlag_s = 0.05\ndelay_s = 0.01\nseed = SEED\n" + COMMAND
    one, same, other = (simulate(parse_scenario(text.replace("SEED", str(seed)))).rows for seed in (1, 1, 2))
    assert one == same != other


def test_the_hard_switch_chatters_where_a_blend_does_not() -> None:
    """Through the limit with noisy encoders the switch throws the base on and off; a blend never does."""
    text = (
        '[robot]\nl = 0.84\nnoise = 0.005\n[law]\nblend = "smoothstep"\n'
        "[command]\nduration = 4.0\nsegments = [{t = 0.0, v_c = 0.05, w_c = 0.0}]"
    )
    hard, soft = (simulate(parse_scenario(text), law).rows for law in ("switch", "exact"))

    def jumps(rows: list[Row]) -> list[float]:
        return [abs(after.v_b - before.v_b) for before, after in pairwise(rows)]

    assert max(jumps(hard)) == pytest.approx(0.05, rel=1e-3)
    assert max(jumps(soft)) < 0.02
    assert sum(jumps(hard)) > 1.5 * sum(jumps(soft))
