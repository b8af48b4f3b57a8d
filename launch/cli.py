"""The Unmanned Vehicle Framework: simulate, fly and drive unmanned vehicles over Zenoh and MAVLink.

Heavy imports happen inside the commands, so that ``uvf --help`` is quick.
"""

import os
import sys
from pathlib import Path
from typing import Annotated

import typer

from launch import settings
from launch.commands.live.bus import node_app, topic_app
from launch.commands.live.orders import arm, cancel, disarm, goal, joints, mode
from launch.commands.live.param import param_app
from launch.commands.live.running import NUMBERS
from launch.commands.live.sim import sim_app
from launch.commands.log import LogArgument, log_app
from launch.commands.map import map_app
from launch.commands.plan import plan_app
from launch.commands.slam import slam
from launch.commands.vehicle import vehicle_app
from launch.commands.world import world_app
from launch.help import without_types_of_flags
from launch.refusal import bad_input_is_one_line, counted, usage_is_one_line, within

app = typer.Typer(no_args_is_help=True, add_completion=False, pretty_exceptions_enable=False, help=(__doc__ or "").splitlines()[0])
app.add_typer(topic_app, name="topic")
app.add_typer(node_app, name="node")
app.add_typer(log_app, name="log")
app.add_typer(map_app, name="map")
app.add_typer(param_app, name="param")
app.add_typer(plan_app, name="plan")
app.add_typer(sim_app, name="sim")
app.add_typer(vehicle_app, name="vehicle")
app.add_typer(world_app, name="world")
app.command()(slam)


def known_mission(name: str | None) -> str | None:
    """Rejects a misspelt mission name before anything is imported."""
    with bad_input_is_one_line():
        if name:
            settings.mission_path(name)
    return name


def known_run(path: Path | None) -> Path | None:
    """Resolves the folder of a run or a log, if one is given, or exits with one line."""
    with bad_input_is_one_line():
        return path and settings.log_path(path, "run")


def known_runs(paths: list[Path]) -> list[Path]:
    """As ``known_run``, of several."""
    with bad_input_is_one_line():
        return [settings.log_path(path, "run") for path in paths]


def known_benchmarks(names: list[str]) -> list[str]:
    """Checks the first name, a benchmark group; those that follow may be cases, which only the group knows."""
    with bad_input_is_one_line():
        settings.benchmark_group(names[0])
    return names


DEMO = "demo"
AS_TODAY = "With these files instead of those attached to the log."
RUN = "Folder of a run, or a log; by default the latest run."
BENCHMARKS = f"Groups, each followed by the cases wanted of it: {', '.join(settings.benchmark_names())}."
WORLDS = "Those of the data that are run: numbers, ranges FIRST:BEYOND:STEP, names or patterns, with commas between. By default all."
SEEDS = "Run it so often, each time with another seed: success rate and spread."
SET = "Another value than the file's, as vehicles.rover.model=burger; may be given several times."
RATE = "Simulation seconds per second, at most 1000; 0 = as fast as it goes."
MISSION = "Name in missions/ or path of a mission file."
MissionArgument = Annotated[str, typer.Argument(help=MISSION, callback=known_mission)]
RUNNING = "By default that of the running system."
RunningMissionOption = Annotated[str | None, typer.Option("--mission", "-m", help=RUNNING, callback=known_mission)]
MissionOption = Annotated[str, typer.Option("--mission", "-m", help=MISSION, callback=known_mission)]

BRIDGE_ADDRESS = """udpin:HOST:PORT: listen for autopilots that send there, as simulators do to 14550.

udp:HOST:PORT: the same, as MAVProxy has it.

udpout:HOST:PORT: call an autopilot that listens there."""


def say(line: str) -> None:
    """Prints a line with the prefix ``uvf:``."""
    typer.echo(f"uvf: {line}")


@app.command()
def up(
    mission: MissionArgument = DEMO,
    rate: Annotated[float, typer.Option(callback=within(0.0, 1000.0), help=RATE)] = 1.0,
    gcs: Annotated[bool, typer.Option("--gcs/--no-gcs", help="The page at http://127.0.0.1:8080.")] = True,
    host: Annotated[str, typer.Option(help="Address at which the page is served; 0.0.0.0 for other machines, with a token.")] = "",
    seconds: Annotated[float | None, typer.Option("--for", callback=within(0.01), help="Seconds after time began to run, to stop.")] = None,
    change: Annotated[list[str] | None, typer.Option("--set", help=SET)] = None,
) -> None:
    """Start a whole mission: every service in its own process, watched over, until Ctrl-C."""
    from launch.changed_mission import changed_mission, load_changed
    from launch.runs import new_run
    from launch.up import StartOptions
    from launch.up import up as run_up
    from services.autopilot.mavlink.connection.targets import where_mavlink_goes
    from uvf.runtime.bus.address import HOST, TOKEN, address_from, claim, claim_router, router_from

    with bad_input_is_one_line():
        path = settings.mission_path(mission)
        claim_router(router_from())
        address = address_from(os.environ | ({HOST: host} if host else {}))
        if gcs:
            claim(address)
        os.environ |= {HOST: address.host, TOKEN: address.token}  # the page's process has the token that is printed here
        load_changed(path, change or [])
        folder = new_run()
        mission = str(changed_mission(path, change, folder)) if change else mission
        say(f"mission {path.stem}; logs in {folder}")
        page = f"page {address.url}   " if gcs else ""
        say(f"{page}{where_mavlink_goes(os.environ)}   Ctrl-C ends")
        raise typer.Exit(run_up(StartOptions(mission, rate, gcs, seconds), folder, say))


@app.command()
def run(
    mission: MissionArgument = DEMO,
    lockstep: Annotated[bool, typer.Option("--lockstep", hidden=True)] = True,  # it always is; scripts of before say so
    until: Annotated[float | None, typer.Option(help="Simulation seconds; by default the mission's duration.")] = None,
    log: Annotated[Path | None, typer.Option(help="Where to record; by default in runs/.")] = None,
    seeds: Annotated[int | None, typer.Option(min=1, max=10_000, help=SEEDS)] = None,
    change: Annotated[list[str] | None, typer.Option("--set", help=SET)] = None,
) -> None:
    """Run a mission in one process, as fast as it goes, and score it; 'uvf up' runs it live.

    The exit code is 0 when every criterion holds; where there are none, when all tasks are done.
    """
    from launch.commands.run import run_and_report, run_campaign
    from uvf.models.yaml_data import BadInput

    with bad_input_is_one_line():
        if seeds is not None and log is not None:
            raise BadInput("--log: each of --seeds has a log of its own, in runs/; leave one of the two out")
        if seeds is not None:
            raise typer.Exit(run_campaign(mission, seeds, until, change or []))
        raise typer.Exit(run_and_report(mission, until, log, change or []))


@app.command()
def service(
    name: Annotated[str, typer.Argument(help="Which service, or 'conductor'.")],
    mission: MissionOption = DEMO,
    vehicle: Annotated[str | None, typer.Option(help="Only for this vehicle.")] = None,
    rate: Annotated[float, typer.Option(callback=within(0.0, 1000.0), help="Real-time factor.")] = 1.0,
    lockstep: Annotated[bool, typer.Option("--lockstep", help="The next tick waits for everybody.")] = False,
) -> None:
    """Run one service in this process."""
    from launch.processes import run_conductor, run_service

    if name == "conductor":
        run_conductor(mission, rate, lockstep)
    else:
        run_service(name, mission, vehicle, lockstep)


@app.command(context_settings={"allow_extra_args": True, "ignore_unknown_options": True})
def supervise(context: typer.Context) -> None:
    """Run 'service NAME ...', 'router ...' or 'record ...', started again when it dies; for containers."""
    from launch.supervise import supervise as run_supervised

    with bad_input_is_one_line():
        raise typer.Exit(run_supervised(context.args, say))


@app.command()
def router(listen: Annotated[str | None, typer.Option(help="Endpoint; by default UVF_ROUTER or tcp/127.0.0.1:7447.")] = None) -> None:
    """Run the Zenoh router."""
    from launch.processes import run_router
    from uvf.runtime.bus.address import host_and_port, router_from

    with bad_input_is_one_line():
        if listen is not None:
            host_and_port(listen, "--listen ")
        run_router(listen or router_from())


@app.command()
def record(folder: Annotated[Path, typer.Argument(help="Where the log goes.")], mission: MissionOption = DEMO) -> None:
    """Record everything on the bus into MCAP files."""
    from launch.recorder import run_recorder

    run_recorder(folder, mission)


@app.command()
def replay(
    log: LogArgument,
    rate: Annotated[float, typer.Option(callback=within(0.01), help="Times real time.")] = 1.0,
    service: Annotated[str | None, typer.Option(help="Into this service instead, comparing what comes out.")] = None,
    vehicle: Annotated[str | None, typer.Option(help="Of this vehicle.")] = None,
    mission: Annotated[str | None, typer.Option("--mission", "-m", help=AS_TODAY, callback=known_mission)] = None,
) -> None:
    """Put a log back onto the bus, or into one service and compare the output."""
    from launch.commands.log_tools import replay_into, replay_onto_bus

    with bad_input_is_one_line():
        raise typer.Exit(replay_into(log, service, vehicle, mission) if service else replay_onto_bus(log, rate))


@app.command()
def report(
    run: Annotated[Path | None, typer.Argument(help=RUN, callback=known_run)] = None,
    out: Annotated[Path | None, typer.Option(help="Folder to write into; by default report/ beside the logs.")] = None,
) -> None:
    """Report on a run: one page with pictures, figures, criteria and events of all vehicles, and the pictures beside it."""
    from launch.commands.report import report_run

    with bad_input_is_one_line():
        report_run(run or settings.runs_folder() / "latest", out)


@app.command()
def compare(
    runs: Annotated[list[Path], typer.Argument(help="Two runs or more: folders or logs.", callback=known_runs)],
    out: Annotated[Path | None, typer.Option(help="Folder to write into; by default compare/ beside the first run's logs.")] = None,
) -> None:
    """Compare runs side by side: criteria, figures, ways and curves of each vehicle, and what differed in their missions."""
    from launch.commands.report import compare_runs

    with bad_input_is_one_line():
        compare_runs(runs, out)


@app.command()
def plot(
    run: Annotated[Path, typer.Argument(help=RUN, callback=known_run)],
    fields: Annotated[list[str], typer.Argument(help="KEY.FIELD, as burger/nav/pose.pose.position.x; * stands for any vehicle.")],
    out: Annotated[Path | None, typer.Option(help="Picture to write (.png, .svg, .pdf); by default plot.png beside the logs.")] = None,
) -> None:
    """Plot fields of messages over time, a panel for each."""
    from launch.commands.report import plot_fields

    with bad_input_is_one_line():
        plot_fields(run, fields, out)


@app.command()
def teleop(
    vehicles: Annotated[list[str] | None, typer.Argument(help="Ground vehicles, driven together, or one aircraft.")] = None,
    mission: RunningMissionOption = None,
) -> None:
    """Drive ground vehicles, or fly an aircraft by its surfaces, from this terminal's keyboard or with a gamepad."""
    from launch.teleop.command import teleop as run_teleop

    with bad_input_is_one_line():
        run_teleop(vehicles or [], mission, say)


@app.command()
def flightgear(
    vehicle: Annotated[str, typer.Argument(help="An aircraft of the mission.")],
    to: Annotated[str, typer.Option(help="HOST:PORT where FlightGear listens.")] = "127.0.0.1:5550",
    hz: Annotated[float, typer.Option(callback=within(1.0, 100.0), help="Packets a second, 1 to 100.")] = 30.0,
    mission: RunningMissionOption = None,
) -> None:
    """Show an aircraft in FlightGear (native FDM packets over UDP), until Ctrl-C."""
    from launch.flightgear.flightgear import flightgear as run_flightgear

    with bad_input_is_one_line():
        run_flightgear(vehicle, to, hz, mission)


@app.command("mavlink-bridge")
def mavlink_bridge(
    address: Annotated[str, typer.Argument(help=BRIDGE_ADDRESS)],
    name: Annotated[list[str] | None, typer.Option(help="NAME of the first autopilot; NAME=SYSTEM for one of several, by its id.")] = None,
    mission: Annotated[str, typer.Option("--mission", "-m", help="Whose world it is; without one the world begins at home.")] = "",
    model: Annotated[str, typer.Option(help="Vehicle model used for display, a folder of vehicles/.")] = "",
) -> None:
    """Take the autopilots at a MAVLink address (PX4, ArduPilot, ours) as vehicles on the bus, until Ctrl-C."""
    from launch.mavlink_bridge import BridgeOptions, bridge

    with bad_input_is_one_line():
        bridge(BridgeOptions(address, tuple(name or ()), model, mission))


@app.command()
def check(mission: MissionArgument = DEMO) -> None:
    """Check a mission: wiring (writers, readers, types, rates), faults of its vehicles, compose file."""
    from launch.checks import check_mission

    with bad_input_is_one_line():
        problems = check_mission(mission)
        for line in problems:
            typer.echo(line)
        say(counted(len(problems), "problem") if problems else "wiring and vehicles are right")
        raise typer.Exit(1 if problems else 0)


@app.command()
def doctor() -> None:
    """Look at this machine: Python, wheels, ports, Zenoh, browser, disk."""
    from launch.commands.doctor import examine

    raise typer.Exit(examine(typer.echo))


@app.command()
def docs(
    build: Annotated[Path | None, typer.Option(help="Build the site into this folder instead; a broken link is an error.")] = None,
    port: Annotated[int, typer.Option(min=1024, max=65535, help="Where to serve it, on 127.0.0.1.")] = 8000,
) -> None:
    """Read the documentation: serve it as a site at http://127.0.0.1:8000 until Ctrl-C, or build it."""
    from launch.commands.docs import build_docs, serve_docs

    with bad_input_is_one_line():
        if build is None:
            serve_docs(port)
        raise typer.Exit(build_docs(build))


@app.command()
def bench(
    names: Annotated[list[str], typer.Argument(help=BENCHMARKS, callback=known_benchmarks)],
    data: Annotated[Path | None, typer.Option(envvar="UVF_DATA", help="Folder with data sets.")] = None,
    json: Annotated[Path | None, typer.Option(help="Write the figures there.")] = None,
    write: Annotated[bool, typer.Option("--write", help="Renew benchmarks/results.md.")] = False,
    worlds: Annotated[str | None, typer.Option(help=WORLDS)] = None,
    trials: Annotated[int | None, typer.Option(min=1, max=10_000, help="Runs in each world.")] = None,
    seed: Annotated[int | None, typer.Option(min=0, help="Of all random numbers.")] = None,
    controller: Annotated[str | None, typer.Option(help="What drives, by its name.")] = None,
    csv: Annotated[Path | None, typer.Option(help="Write a row for each run there.")] = None,
    pictures: Annotated[Path | None, typer.Option(help="Draw each failed run into this folder.")] = None,
) -> None:
    """Measure: one table, the same figures as JSON."""
    from launch.commands.bench import run_groups
    from launch.commands.bench_selection import Selection

    with bad_input_is_one_line():
        run_groups(names, data, json, write, Selection(worlds, trials, seed, controller, csv, pictures))


@app.command(context_settings={"allow_extra_args": True, "ignore_unknown_options": True})
def test(context: typer.Context) -> None:
    """Run the tests; further arguments go to pytest."""
    from launch.commands.testing import run_tests

    raise typer.Exit(run_tests(context.args))


for order in (arm, disarm, mode, cancel, joints):
    app.command()(order)
app.command(context_settings=NUMBERS)(goal)


def main() -> None:
    """Runs the command line and exits with its code."""
    with usage_is_one_line():
        sys.exit(without_types_of_flags(typer.main.get_command(app))(prog_name="uvf", standalone_mode=False))


if __name__ == "__main__":
    main()
