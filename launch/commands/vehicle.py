"""``uvf vehicle``: what vehicles there are, what is wrong with them, what they look like; new ones, and third-party models."""

from pathlib import Path
from typing import Annotated

import typer

from launch.refusal import bad_input_is_one_line
from uvf.models.yaml_data import BadInput

vehicle_app = typer.Typer(no_args_is_help=True, help="Look at vehicles, check them, make new ones, import third-party models.")

NameArgument = Annotated[str, typer.Argument(help="Name in vehicles/ or path of a vehicle's folder.")]
NewName = Annotated[str, typer.Option("--name", help="Of the new folder in vehicles/.")]
IntoOption = Annotated[Path | None, typer.Option("--into", help="Where the folder goes; by default vehicles/.")]

LEAST, MOST = 0.005, 5.0  # m


def _root() -> Path:
    from uvf.models.scenario import ROOT

    return ROOT


def _vehicles() -> Path:
    return _root() / "vehicles"


@vehicle_app.command("list")
def list_vehicles() -> None:
    """All vehicles."""
    from rich.console import Console

    from launch.vehicles.listing import vehicle_table

    Console().print(vehicle_table(_vehicles()))


@vehicle_app.command()
def show(name: NameArgument) -> None:
    """One vehicle: its figures, its sensors, its frames."""
    from rich.console import Console

    from launch.vehicles.inspection import folder_of, inspect
    from launch.vehicles.listing import frame_tree, vehicle_figures

    with bad_input_is_one_line():
        found = inspect(folder_of(name, _vehicles()))
        if found.file is None:
            raise BadInput(found.faults[0])
    console = Console()
    console.print(vehicle_figures(found.file, found.model))
    if found.model is not None:
        console.print(frame_tree(found.model, found.file))


@vehicle_app.command()
def check(
    names: Annotated[list[str] | None, typer.Argument(help="Names in vehicles/ or folders; by default all in vehicles/.")] = None,
    picture: Annotated[Path | None, typer.Option(help="Where to draw it; by default runs/vehicles/NAME.png.")] = None,
) -> None:
    """Every fault of a vehicle's files with file and line, the tree of its frames, a picture: exit code 1 when there are faults."""
    from launch.vehicles.checking import check_all

    with bad_input_is_one_line():
        raise typer.Exit(1 if check_all(names or [], _vehicles(), picture) else 0)


@vehicle_app.command()
def picture(
    names: Annotated[list[str] | None, typer.Argument(help="By default all vehicles.")] = None,
    into: Annotated[Path | None, typer.Option(help="Folder of the pictures; by default docs/images/vehicles.")] = None,
) -> None:
    """Draw vehicles from the front, from above and from their side."""
    from launch.vehicles.inspection import folder_of
    from launch.vehicles.picture import write_picture
    from uvf.models.vehicle.file import load_vehicle

    with bad_input_is_one_line():
        target = into or _root() / "docs" / "images" / "vehicles"
        for name in names or sorted(p.parent.name for p in _vehicles().glob("*/vehicle.yaml")):
            folder = folder_of(name, _vehicles())
            write_picture(folder, load_vehicle(folder.parent, folder.name), target / f"{folder.name}.png")
            typer.echo(f"uvf: {target / folder.name}.png")


@vehicle_app.command()
def linearize(
    name: NameArgument,
    speed: Annotated[
        float | None, typer.Option(min=0.1, metavar="m/s", help="Airspeed; by default the trim_speed of the vehicle's file.")
    ] = None,
    altitude: Annotated[float, typer.Option(min=-500.0, max=80_000.0, metavar="m", help="Above mean sea level.")] = 100.0,
    picture: Annotated[Path | None, typer.Option(help="Where to draw the map of the poles, a .png.")] = None,
    json: Annotated[Path | None, typer.Option(help="File for the figures.")] = None,
) -> None:
    """An aircraft in level flight: trim, state-space matrices, modes, the book's transfer functions."""
    from rich.console import Console

    from launch.vehicles.inspection import folder_of
    from launch.vehicles.linearize import linear_models, tables, write_json, write_pole_map

    with bad_input_is_one_line():
        folder = folder_of(name, _vehicles())
        models = linear_models(folder, speed, altitude)
        if picture is not None:
            write_pole_map(models, f"{folder.name}: {models.trim.airspeed:g} m/s, {altitude:g} m", picture)
        if json is not None:
            write_json(models, json)
    console = Console()
    for table in tables(models):
        console.print(table)


@vehicle_app.command()
def tune(
    name: NameArgument,
    write: Annotated[bool, typer.Option("--write", help="Put the figures into the vehicle.yaml, and fly it.")] = False,
    picture: Annotated[Path | None, typer.Option(help="Where to draw loops and step responses, a .png.")] = None,
    firmness: Annotated[float, typer.Option(min=0.2, max=5.0, help="Above 1: nearer to the path, for more motion of the surfaces.")] = 1.0,
) -> None:
    """The autopilot's figures of an aircraft from its own model: balance, gains, limits, the loops' margins, flights that prove them."""
    from rich.console import Console

    from launch.vehicles import tuning
    from launch.vehicles.inspection import folder_of

    with bad_input_is_one_line():
        found = tuning.tune(folder_of(name, _vehicles()), firmness)
        if picture is not None:
            tuning.draw(found, picture)
        written = tuning.write(found) if write else None
    console = Console()
    for table in tuning.tables(found):
        console.print(table)
    for line in found.unmet:
        typer.echo(f"uvf: {line}")
    if written is None:
        typer.echo(f"uvf: 'uvf vehicle tune {name} --write' puts them into its vehicle.yaml and flies it")
        return
    from launch.vehicles.proof import prove

    typer.echo(f"uvf: {written} has them now; it flies to prove them")
    with bad_input_is_one_line():
        proof = prove(found.folder)
    console.print(proof.table())
    for line in proof.lines():
        typer.echo(f"uvf: {line}")


@vehicle_app.command()
def new(
    name: Annotated[str, typer.Argument(help="Of the new folder in vehicles/.")],
    radius: Annotated[float, typer.Option(min=LEAST, max=MOST, metavar="m", help="Of the body, seen from above.")],
    track: Annotated[float, typer.Option(min=LEAST, max=MOST, metavar="m", help="From the middle of one wheel to that of the other.")],
    wheel_radius: Annotated[float, typer.Option(min=LEAST, max=MOST, metavar="m", help="Of the two driven wheels.")],
    height: Annotated[float, typer.Option(min=LEAST, max=MOST, metavar="m", help="From the floor to the top of the body.")],
) -> None:
    """Make a round two-wheeled vehicle from four dimensions: a working vehicle to start from."""
    from launch.vehicles.creation import Measures, create

    with bad_input_is_one_line():
        folder = create(_vehicles() / name, Measures(radius, track, wheel_radius, height))
    typer.echo(f"uvf: {folder}; look at it with 'uvf vehicle check {name}'")


@vehicle_app.command("import")
def import_(
    source: Annotated[Path, typer.Argument(help="A .urdf, .xacro or .sdf, or a JSBSim aircraft: its .xml or folder.")],
    name: NewName,
    into: IntoOption = None,
    arg: Annotated[list[str] | None, typer.Option(help="Of the xacro, as name:=value.")] = None,
    env: Annotated[list[str] | None, typer.Option(help="Variable of the environment for the xacro, as NAME=value.")] = None,
    joint: Annotated[list[str] | None, typer.Option(help="To be moved on command, though no file says so: a lift, a pan, an arm.")] = None,
) -> None:
    """Import a third-party robot or aircraft: a folder in vehicles/, and a note of what was dropped or guessed. Checks it at once."""
    from launch.vehicles.checking import check_all
    from launch.vehicles.importing import import_vehicle
    from uvf.models.urdf.source import XacroValues

    with bad_input_is_one_line():
        values = XacroValues(dict(_pair("--arg", text, ":=") for text in arg or []), dict(_pair("--env", text, "=") for text in env or []))
        target = into or _vehicles()
        for line in import_vehicle(source, target / name, values, joint or []):
            typer.echo(f"note: {line}")
        raise typer.Exit(1 if check_all([str(target / name)], target, None) else 0)


def _pair(option: str, text: str, sign: str) -> tuple[str, str]:
    """Raises BadInput."""
    name, found, value = text.partition(sign)
    if not found or not name:
        raise BadInput(f"{option} {text}: write it as name{sign}value")
    return name, value
