"""The commands, typed. Each imports what it needs when it runs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import tyro
from tyro.extras import SubcommandApp

app = SubcommandApp()
Repeated = Annotated[tuple[str, ...], tyro.conf.UseAppendAction]


@app.command
def drive(
    robot: Annotated[str, tyro.conf.Positional] = "mobile7",
    mode: str = "",
    hand: str = "",
    port: int | None = None,
    host: str = "127.0.0.1",
    allow_host: Repeated = (),
    rate: float = 200.0,
    browser: bool = True,
    law: str = "",
    set: tuple[str, ...] = (),
    hosted: bool = True,
    max_delay: float = 0.4,
) -> None:
    """Start a simulated robot and the page to drive it with; open a browser where there is one.

    Args:
        robot: A name (see `overreach robots`), a TOML or a model file.
        mode: How its hand is held: follow, fixed, level or free.
        hand: The hand that is driven alone, of a robot that has several; by default they can be driven in turn.
        port: Port of the page; by default 8420, or a free one where that is taken.
        host: Address the page is served at. Anyone who can reach it can drive the robot.
        allow_host: A further name of this machine, such as robot.local, that the page may be opened by; repeatable.
        rate: Rate of the control loop [Hz], 50 to 1000.
        browser: Whether to open a browser.
        law: Name of the law it starts with (see `overreach laws`); by default the one that suits the robot.
        set: Parameters of the law, NAME=VALUE (see `overreach laws`).
        hosted: Whether the robot runs in a process of its own, which brings it to rest if the loop hangs or dies.
        max_delay: Commands older than this [s] are not obeyed, 0.1 to 2.
    """
    from overreach.cockpit.drive import run_drive
    from overreach.plugs import in_mode

    run_drive(in_mode(robot, mode, hand), host, port, rate, browser, law, set, allow_host, hosted, max_delay)


@app.command
def robot(
    robot: Annotated[str, tyro.conf.Positional] = "mobile7",
    mode: str = "",
    hand: str = "",
    listen: str = "tcp/127.0.0.1:7460",
    rate: float = 200.0,
    name: str = "",
    law: str = "",
    set: tuple[str, ...] = (),
    hosted: bool = True,
    max_delay: float = 0.4,
    parent: int | None = None,
) -> None:
    """Run the robot side: loop, gate, law and robot. A cockpit connects to it.

    Args:
        robot: A name (see `overreach robots`), a TOML or a model file.
        mode: How its hand is held: follow, fixed, level or free.
        hand: The hand that is driven alone, of a robot that has several; by default they can be driven in turn.
        listen: Endpoint to listen at, HOST:PORT or tcp/HOST:PORT.
        rate: Rate of the control loop [Hz], 50 to 1000.
        name: Its name in the network, by default the robot's own; two robots need two names.
        law: Name of the law it starts with (see `overreach laws`); by default the one that suits the robot.
        set: Parameters of the law, NAME=VALUE (see `overreach laws`).
        hosted: Whether the robot runs in a process of its own, which brings it to rest if the loop hangs or dies.
        max_delay: Commands older than this [s] are not obeyed, 0.1 to 2.
        parent: End when this process, which started this one, ends.
    """
    from overreach.link.messages import Choice
    from overreach.parameters import assignments
    from overreach.plugs import in_mode
    from overreach.robot_side.process import run_robot

    which, chosen = in_mode(robot, mode, hand), Choice(law, dict(assignments(set)))
    run_robot(which, listen, rate, parent, name, chosen, hosted, max_delay)


@app.command
def cockpit(
    connect: str = "tcp/127.0.0.1:7460",
    robot: str = "",
    port: int | None = None,
    host: str = "127.0.0.1",
    allow_host: Repeated = (),
    browser: bool = True,
) -> None:
    """Run the operator side: the page, connected to a robot side.

    Args:
        connect: Endpoint of the robot side, HOST:PORT or tcp/HOST:PORT.
        robot: Name of the robot in the network, if there are several.
        port: Port of the page; by default 8420, or a free one where that is taken.
        host: Address the page is served at. Anyone who can reach it can drive the robot.
        allow_host: A further name of this machine, such as robot.local, that the page may be opened by; repeatable.
        browser: Whether to open a browser.
    """
    from overreach.cockpit.drive import run_cockpit

    run_cockpit(connect, host, port, browser, robot, allow_host)


@app.command
def simulate(
    scenario: Annotated[str, tyro.conf.Positional],
    robot: str = "",
    mode: str = "",
    hand: str = "",
    law: str = "",
    set: tuple[str, ...] = (),
    out: Path | None = None,
    json: bool = False,
) -> None:
    """Run a scenario without a page, as fast as possible, and print what happened.

    Args:
        scenario: A built-in scenario (outward, inward, left, right, mixed, aside, aside_back, reach, held, dither,
            dither_pushed) or a TOML file.
        robot: Robot to run it on: a name (see `overreach robots`) or a file; by default the scenario's own.
        mode: How its hand is held: follow, fixed, level or free.
        hand: The hand that is driven, of a robot that has several.
        law: Name of the law (see `overreach laws`); by default the one that suits the robot.
        set: Parameters of the law, NAME=VALUE (see `overreach laws`).
        out: CSV file to write, one row per step.
        json: Print the summary as JSON.
    """
    import msgspec

    from overreach.files import check_writable
    from overreach.parameters import assignments
    from overreach.plugs import in_mode
    from overreach.run.files import write_csv, write_spatial_csv
    from overreach.run.metrics import cost_per_step
    from overreach.run.scenario import load_scenario
    from overreach.run.simulate import law_of
    from overreach.run.simulate import simulate as run_scenario
    from overreach.run.summary import table

    if out is not None:
        check_writable(out, "--out")
    loaded = load_scenario(scenario, in_mode(robot, mode, hand))
    made = law_of(loaded, law, assignments(set))
    run = run_scenario(loaded, made)
    if out is not None and run.spatial:
        write_spatial_csv(out, run.spatial, loaded.model)
    elif out is not None:
        write_csv(out, run.rows)
    if json:
        print(msgspec.json.encode(run.summary).decode())
        return
    cost = cost_per_step(made, loaded.frame or made.frame, run.rows, loaded.model)
    print(f"{table(run.summary)}\n  {'one plan, median, here and now':<32}{cost:>12.4g}  us")


@app.command
def reproduce(out: Path) -> None:
    """Reproduce the paper's figures, show what the paper does not, and compare with the alternatives: one page.

    Args:
        out: Folder to write to: report.html, headline.md, results.json, figures/ and data/.
    """
    from overreach.reproduce.run import reproduce as write_report

    write_report(out)
    print(f"report: {out / 'report.html'}")


@app.command
def bench(robot: str = "", mode: str = "", json: Path | None = None) -> None:
    """Measure the cost of a control step: plain, compiled and batched, next to the quadratic programs.

    Args:
        robot: A robot whose arm moves in space, measured beside mink; by default the planar one, beside its rivals.
        mode: How its hand is held: follow, fixed, level or free.
        json: File to write the numbers to.
    """
    from overreach.bench import report, run, spatial
    from overreach.files import check_writable, write_json
    from overreach.plugs import in_mode

    if json is not None:
        check_writable(json, "--json")
    found = spatial.measure(in_mode(robot, mode)) if robot else run.measure()
    if json is not None:
        write_json(json, found)
    print(spatial.text(found) if robot else report.text(found))


@app.command
def workspace(
    robot: Annotated[str, tyro.conf.Positional],
    mode: str = "",
    hand: str = "",
    find_home: bool = False,
    out: Path | None = None,
    figure: Path | None = None,
) -> None:
    """Measure where a robot's hand can go, draw it, and print the table for its description.

    Args:
        robot: A name (see `overreach robots`) or a TOML file.
        mode: How the hand is held: follow, fixed, level or free; by default as the description says, else follow.
        hand: The hand that is driven, of a robot that has several.
        find_home: Look for home postures first, and measure from the best one.
        out: TOML file to put the table into; a description that is there keeps the rest.
        figure: File to draw to, as its suffix says: SVG, PNG or PDF.
    """
    from overreach.files import check_writable
    from overreach.model.measure.command import run_workspace
    from overreach.plugs import in_mode

    for path, option in ((out, "--out"), (figure, "--figure")):
        if path is not None:
            check_writable(path, option)
    run_workspace(in_mode(robot, "", hand), mode, find_home, out, figure)


@app.command
def check(
    robot: Annotated[str, tyro.conf.Positional] = "",
    all: Annotated[bool, tyro.conf.FlagCreatePairsOff] = False,
    mode: str = "",
    hand: str = "",
    streams: int = 200,
    seed: int = 0,
    json: Path | None = None,
    jobs: int = 0,
) -> None:
    """Say what was found of a robot and what looks wrong, and drive it by random command streams.

    Args:
        robot: A name (see `overreach robots`) or a TOML file.
        all: Instead, every property of the law for every robot that ships, in each of its modes; exit code 1 if one is
            not kept.
        mode: How the hand is held: follow, fixed, level or free; by default as the description says, else follow.
        hand: The hand that is driven, of a robot that has several.
        streams: How many streams of each kind, smooth ones and stick steps: 20 s each.
        seed: Of the streams.
        json: File to write the numbers to.
        jobs: Processes; by default one a core.
    """
    from overreach.check.every import run_one_or_all
    from overreach.files import check_writable
    from overreach.plugs import in_mode

    if json is not None:
        check_writable(json, "--json")
    if not run_one_or_all(in_mode(robot, "", hand), all, mode, streams, seed, json, jobs):
        raise SystemExit(1)


@app.command
def describe(model: Annotated[Path, tyro.conf.Positional], out: Path | None = None) -> None:
    """Print a first description of a robot from its model file, MJCF or URDF: what was found, and what was guessed.

    Args:
        model: The model file.
        out: TOML file to write the description to.
    """
    from overreach.files import check_writable
    from overreach.model.mujoco.describe import run_describe

    if out is not None:
        check_writable(out, "--out")
    run_describe(model, out)


@app.command
def laws() -> None:
    """List the laws, the blends and the command frames."""
    from overreach.lists import laws as lines

    print("\n".join(lines()))


@app.command
def robots() -> None:
    """List the robots."""
    from overreach.lists import robots as lines

    print("\n".join(lines()))


@app.command
def doctor() -> None:
    """Say what is installed, what is missing and how to get it."""
    from overreach.doctor import report

    print(report())
