"""The commands, typed. Each imports what it needs when it runs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro
from tyro.extras import SubcommandApp

if TYPE_CHECKING:
    from overreach.parameters import Parameters

app = SubcommandApp()
Repeated = Annotated[tuple[str, ...], tyro.conf.UseAppendAction]


@app.command
def drive(
    robot: Annotated[str, tyro.conf.Positional] = "planar",
    port: int | None = None,
    host: str = "127.0.0.1",
    allow_host: Repeated = (),
    rate: float = 200.0,
    browser: bool = True,
    law: str = "exact",
    set: tuple[str, ...] = (),
    hosted: bool = True,
    max_delay: float = 0.4,
) -> None:
    """Start a simulated robot and the page to drive it with; open a browser where there is one.

    Args:
        robot: Name of the robot (see `overreach robots`).
        port: Port of the page; by default 8420, or a free one where that is taken.
        host: Address the page is served at. Anyone who can reach it can drive the robot.
        allow_host: A further name of this machine, such as robot.local, that the page may be opened by; repeatable.
        rate: Rate of the control loop [Hz], 50 to 1000.
        browser: Whether to open a browser.
        law: Name of the law it starts with (see `overreach laws`).
        set: Parameters of the law, NAME=VALUE (see `overreach laws`).
        hosted: Whether the robot runs in a process of its own, which brings it to rest if the loop hangs or dies.
        max_delay: Commands older than this [s] are not obeyed, 0.1 to 2.
    """
    from overreach.cockpit.drive import run_drive

    run_drive(robot, host, port, rate, browser, law, set, allow_host, hosted, max_delay)


@app.command
def robot(
    robot: Annotated[str, tyro.conf.Positional] = "planar",
    listen: str = "tcp/127.0.0.1:7460",
    rate: float = 200.0,
    name: str = "",
    law: str = "exact",
    set: tuple[str, ...] = (),
    hosted: bool = True,
    max_delay: float = 0.4,
    parent: int | None = None,
) -> None:
    """Run the robot side: loop, gate, law and robot. A cockpit connects to it.

    Args:
        robot: Name of the robot (see `overreach robots`).
        listen: Endpoint to listen at, HOST:PORT or tcp/HOST:PORT.
        rate: Rate of the control loop [Hz], 50 to 1000.
        name: Its name in the network, by default the robot's own; two robots need two names.
        law: Name of the law it starts with (see `overreach laws`).
        set: Parameters of the law, NAME=VALUE (see `overreach laws`).
        hosted: Whether the robot runs in a process of its own, which brings it to rest if the loop hangs or dies.
        max_delay: Commands older than this [s] are not obeyed, 0.1 to 2.
        parent: End when this process, which started this one, ends.
    """
    from overreach.link.messages import Choice
    from overreach.parameters import assignments
    from overreach.robot_side.process import run_robot

    run_robot(robot, listen, rate, parent, name, Choice(law, dict(assignments(set))), hosted, max_delay)


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
    law: str = "exact",
    set: tuple[str, ...] = (),
    out: Path | None = None,
    json: bool = False,
) -> None:
    """Run a scenario without a page, as fast as possible, and print what happened.

    Args:
        scenario: A built-in scenario (outward, inward, left, right, mixed, aside, aside_back, reach, held, dither,
            dither_pushed) or a TOML file.
        law: Name of the law (see `overreach laws`).
        set: Parameters of the law, NAME=VALUE (see `overreach laws`).
        out: CSV file to write, one row per step.
        json: Print the summary as JSON.
    """
    import msgspec

    from overreach.parameters import assignments
    from overreach.run.files import check_writable, write_csv
    from overreach.run.metrics import cost_per_step
    from overreach.run.scenario import load_scenario
    from overreach.run.simulate import law_of
    from overreach.run.simulate import simulate as run_scenario
    from overreach.run.summary import table

    if out is not None:
        check_writable(out, "--out")
    loaded = load_scenario(scenario)
    made = law_of(loaded, law, assignments(set))
    run = run_scenario(loaded, made)
    if out is not None:
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
def bench(json: Path | None = None) -> None:
    """Measure the cost of a control step: plain, compiled and batched, next to the quadratic programs.

    Args:
        json: File to write the numbers to.
    """
    from overreach.bench.report import text
    from overreach.bench.run import measure
    from overreach.run.files import check_writable, write_json

    if json is not None:
        check_writable(json, "--json")
    found = measure()
    if json is not None:
        write_json(json, found)
    print(text(found))


@app.command
def laws() -> None:
    """List the laws, the blends and the command frames."""
    from overreach.law.frame import FRAMES
    from overreach.plugs import BLENDS, blend_plug, law_names, law_plug, names, usable

    _list_plugs("laws (--law), with their parameters (--set NAME=VALUE)", usable(law_names(), law_plug))
    _list_plugs("blends", usable(names(BLENDS), blend_plug))
    _list("command frames", {name: (frame.__doc__ or "").splitlines()[0] for name, frame in FRAMES.items()})


@app.command
def robots() -> None:
    """List the robots."""
    from overreach.plugs import MODELS, summaries
    from overreach.robots.load import ROBOTS

    _list("robots", summaries(MODELS, ROBOTS))


@app.command
def doctor() -> None:
    """Say what is installed, what is missing and how to get it."""
    from overreach.doctor import report

    print(report())


def _list(title: str, entries: dict[str, str]) -> None:
    print(title)
    for name, line in entries.items():
        print(f"  {name:<12}{line}")


def _list_plugs(title: str, plugs: dict[str, type[Parameters] | str]) -> None:
    from overreach.parameters import schema, summary

    print(title)
    for name, plug in plugs.items():
        if isinstance(plug, str):
            print(f"  {name:<12}cannot be used: {plug}")
            continue
        print(f"  {name:<12}{summary(plug)}")
        for one in schema(plug):
            choices = f", one of {', '.join(one.choices)}" if one.choices else ""
            print(f"{'':<14}{f'{one.name} = {one.shown}':<28}{one.title}{choices}")
