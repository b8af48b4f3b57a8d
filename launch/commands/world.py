"""``uvf world ...``: look at worlds, check them, draw them, make new ones and take them over from others."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from launch.refusal import bad_input_is_one_line, counted

if TYPE_CHECKING:
    from uvf.models.world.file import WorldFile

world_app = typer.Typer(no_args_is_help=True, help="Worlds: list, show, check, picture, new, import.")
new_app = typer.Typer(no_args_is_help=True, help="Make up a world: a house, an airfield.")
world_app.add_typer(new_app, name="new")

NameArgument = Annotated[str, typer.Argument(help="A folder in worlds/.")]
RadiusOption = Annotated[float, typer.Option(min=0.01, max=10.0, metavar="m", help="Of the vehicle that is to drive there.")]
BURGER = 0.115  # m


def _worlds() -> Path:
    from uvf.models.scenario import ROOT

    return ROOT / "worlds"


@world_app.command("list")
def world_list() -> None:
    """The worlds there are."""
    from launch.worlds.report import listed

    for line in listed(_worlds()):
        typer.echo(line)


@world_app.command("show")
def world_show(name: NameArgument) -> None:
    """Size, place, air and things of a world."""
    from launch.worlds.report import figures
    from uvf.models.world.file import load_world

    with bad_input_is_one_line():
        for line in figures(load_world(_worlds(), name)):
            typer.echo(line)


@world_app.command("picture")
def world_picture(
    name: NameArgument,
    radius: RadiusOption = BURGER,
    out: Annotated[Path | None, typer.Option(help="By default picture.png beside its world.yaml.")] = None,
) -> None:
    """Draw floor plan and view side by side."""
    from launch.worlds.picture import save_picture
    from launch.worlds.report import RESOLUTION, largest_reachable
    from uvf.models.world.file import load_world
    from uvf.models.world.geometry import cell_size, floor_plan

    path = out or _worlds() / name / "picture.png"
    with bad_input_is_one_line():
        world = load_world(_worlds(), name)
        plan = floor_plan(world, cell_size(world, RESOLUTION))
        save_picture(world, plan, largest_reachable(plan, radius), path)
    typer.echo(f"uvf: {path}")


@world_app.command("check")
def world_check(
    name: NameArgument,
    radius: RadiusOption = BURGER,
    mission: Annotated[str | None, typer.Option("--mission", "-m", help="Also look whether its vehicles start freely.")] = None,
    vehicle: Annotated[
        str | None, typer.Option("--vehicle", "-v", help="Also tell what its lidar does not see or takes for walls.")
    ] = None,
) -> None:
    """Look for things in the air or in the ground, floor out of reach, scripts through walls, blocked starts."""
    from launch import settings
    from launch.worlds.blind_spots import blind_spots
    from launch.worlds.check import blocked_starts, problems
    from launch.worlds.leaning import notes
    from uvf.models.scenario import load_scenario
    from uvf.models.vehicle.file import load_vehicle
    from uvf.models.world.file import load_world

    with bad_input_is_one_line():
        world = load_world(_worlds(), name)
        found = list(problems(world, radius))
        found += blocked_starts(load_scenario(settings.mission_path(mission))) if mission else []
        told = list(notes(world))
        if vehicle is not None:
            told += blind_spots(world, vehicle, load_vehicle(_worlds().parent / "vehicles", vehicle))
    for line in (*found, *(f"note: {each}" for each in told)):
        typer.echo(line)
    typer.echo(f"uvf: {counted(len(found), 'problem')}" if found else "uvf: nothing wrong")
    raise typer.Exit(1 if found else 0)


NewName = Annotated[str, typer.Argument(help="Of the new folder in worlds/.")]
ReplaceOption = Annotated[bool, typer.Option("--replace", help="Overwrite a world of that name.")]


@new_app.command("house")
def new_house(
    name: NewName,
    rooms: Annotated[int, typer.Option(min=1, max=40, help="How many.")] = 6,
    seed: Annotated[int, typer.Option(min=0, help="The same seed makes the same house.")] = 1,
    replace: ReplaceOption = False,
) -> None:
    """Make up a house with rooms, doors and furniture; every room can be reached."""
    from launch.worlds.generator import generate

    _write_new(name, replace, generate(rooms, seed))


@new_app.command("airfield")
def new_airfield(
    name: NewName,
    at: Annotated[
        tuple[float, float, float], typer.Option(metavar="deg deg m", help="Latitude, longitude and height above mean sea level.")
    ] = (40.77, 14.79, 300.0),
    strip: Annotated[tuple[float, float], typer.Option(metavar="m m", help="Length and width of its strip.")] = (300.0, 12.0),
    course: Annotated[
        float, typer.Option(min=-360.0, max=360.0, metavar="deg", help="One direction of the strip, from true north.")
    ] = 90.0,
    replace: ReplaceOption = False,
) -> None:
    """Make up an airfield: a strip with markings, a hangar, a windsock, the magnetic field of the place."""
    from math import radians

    from launch.worlds.airfield import AirfieldPlan, airfield, write_plate
    from uvf.models.world.file import Origin, Strip
    from uvf.models.yaml_data import convert

    with bad_input_is_one_line():
        place = convert(dict(zip(Origin.__struct_fields__, at, strict=True)), Origin, "--at")
        sizes = {"length": strip[0], "width": strip[1]}
        convert({"name": "strip", "centre": (0.0, 0.0, 0.0), "yaw": 0.0, **sizes}, Strip, "--strip")
    about = f"An airfield with a strip of {strip[0]:g} x {strip[1]:g} m, course {course % 360.0:03.0f} deg."
    _write_new(name, replace, airfield(AirfieldPlan(place, *strip, radians(course)), about), write_plate)


def _write_new(name: str, replace: bool, world: "WorldFile", more: Callable[[Path], None] = lambda folder: None) -> None:
    """Writes a made-up world, and with ``more`` the files beside it."""
    from uvf.models.importing.worlds import make_room, new_folder
    from uvf.models.world.writer import write_world

    with bad_input_is_one_line():
        folder = new_folder(_worlds(), name)
        make_room(folder, replace)
    path = write_world(world, folder)
    more(folder)
    typer.echo(f"uvf: {path}; look at it with 'uvf world picture {name}'")


@world_app.command("import")
def world_import(
    file: Annotated[Path, typer.Argument(help="A Gazebo .world or .sdf, the yaml of a map, or heights: a GeoTIFF or a picture.")],
    name: Annotated[str, typer.Option(help="Of the new folder in worlds/.")],
    models: Annotated[list[Path] | None, typer.Option(help="Folders with Gazebo models.")] = None,
    height: Annotated[float, typer.Option(min=0.1, max=100.0, metavar="m", help="Of the walls of a map.")] = 2.0,
    upright: Annotated[bool, typer.Option("--upright", help="Turn meshes that say that y is up, which Gazebo does not.")] = False,
    terrain: Annotated[
        tuple[float, float, float] | None,
        typer.Option(
            metavar="m m m",
            help="Take the file as heights: extent east, north, and from the darkest to the brightest.",
        ),
    ] = None,
    replace: Annotated[bool, typer.Option("--replace", help="Overwrite a world of that name.")] = False,
) -> None:
    """Import a Gazebo world, a map or a terrain, with a note of what was left out."""
    from uvf.models.importing.worlds import Options, import_world, new_folder

    with bad_input_is_one_line():
        path, lines = import_world(file, new_folder(_worlds(), name), Options(models or (), height, replace, upright, terrain))
    for line in lines:
        typer.echo(line)
    typer.echo(f"uvf: {path}; look at it with 'uvf world picture {name}' and 'uvf world check {name}'")
