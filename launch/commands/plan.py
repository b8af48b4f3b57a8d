"""``uvf plan``: missions worked out from what is to be done."""

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from launch.refusal import bad_input_is_one_line, within
from uvf.models.yaml_data import BadInput

if TYPE_CHECKING:
    from uvf.planning.coverage.camera import SurveyCamera

plan_app = typer.Typer(no_args_is_help=True, help="Plan missions: surveys of an area, flights past obstacles.")

AREA = "Polygons (.geojson, .json, .kml, .gml, .xml), or a .yaml with outline and holes in metres."
Share = within(0.0, 0.95)
Positive = within(0.01, 1e6)
Margin = within(0.0, 1e4)


@plan_app.callback()
def plan() -> None:
    """Plan missions."""


@plan_app.command()
def survey(
    area: Annotated[Path, typer.Argument(help=AREA)],
    height: Annotated[float, typer.Option(metavar="m", callback=within(1.0, 10_000.0), help="Above the highest ground of the area.")],
    vehicle: Annotated[str, typer.Option("--vehicle", "-v", help="An aircraft, name in vehicles/ or path of its folder.")] = "milvus",
    world: Annotated[str, typer.Option(help="Name in worlds/.")] = "empty",
    sidelap: Annotated[float, typer.Option(callback=Share, help="Overlap of pictures of neighbouring swaths, 0 to 0.95.")] = 0.6,
    frontlap: Annotated[float, typer.Option(callback=Share, help="Overlap of pictures along a swath, 0 to 0.95.")] = 0.75,
    fov: Annotated[
        tuple[float, float] | None,
        typer.Option(metavar="DEG DEG", help="Field of view across and along; by default the vehicle's."),
    ] = None,
    sensor: Annotated[
        tuple[float, float, float] | None, typer.Option(metavar="mm mm mm", help="Instead: sensor width and height, focal length.")
    ] = None,
    spacing: Annotated[float | None, typer.Option(metavar="m", callback=Positive, help="Between swaths, if not by the camera.")] = None,
    trigger: Annotated[float | None, typer.Option(metavar="m", callback=Positive, help="Between pictures, if not by the camera.")] = None,
    wind: Annotated[tuple[float, float], typer.Option(metavar="EAST NORTH", help="Wind expected in m/s, where it blows to.")] = (0.0, 0.0),
    airspeed: Annotated[float | None, typer.Option(metavar="m/s", callback=Positive, help="By default the vehicle's cruise.")] = None,
    direction: Annotated[float | None, typer.Option(metavar="deg", help="Of the swaths, from north; by default the best.")] = None,
    at: Annotated[tuple[float, float] | None, typer.Option(metavar="X Y", help="Put the area's middle there in the world in m.")] = None,
    seed: Annotated[int, typer.Option(help="Of the search and of the mission.")] = 1,
    out: Annotated[Path | None, typer.Option(help="Mission file to write; by default it is printed.")] = None,
) -> None:
    """Survey an area from the air: swaths in the best direction and order for the wind, as a mission file."""
    from launch.planning.survey import SurveyWishes, plan_survey

    with bad_input_is_one_line():
        if not all(math.isfinite(value) for value in (*wind, *(at or ()), direction or 0.0)):
            raise BadInput("--wind, --at and --direction are finite numbers")
        heading = None if direction is None else math.radians(90.0 - direction)
        wishes = SurveyWishes(
            area, height, vehicle, world, wind, _camera(fov, sensor), (sidelap, frontlap), spacing, trigger, airspeed, heading, at, seed
        )
        planned = plan_survey(wishes)
        for line in planned.lines():
            typer.echo(f"uvf: {line}", err=True)
        if out is None:
            typer.echo(planned.mission_text(), nl=False)
        else:
            _write(out, planned.mission_text())


@plan_app.command()
def flight(
    file: Annotated[Path, typer.Argument(help="A .yaml with start, goal, fence and obstacles in metres.")],
    vehicle: Annotated[str, typer.Option("--vehicle", "-v", help="An aircraft, name in vehicles/ or path of its folder.")] = "milvus",
    world: Annotated[str, typer.Option(help="Name in worlds/; what stands in it is kept clear of, too.")] = "empty",
    aside: Annotated[float, typer.Option(metavar="m", callback=Margin, help="Kept from obstacles and from the fence's edges.")] = 20.0,
    above: Annotated[float, typer.Option(metavar="m", callback=Margin, help="Kept from heights, above and below.")] = 10.0,
    wind: Annotated[tuple[float, float], typer.Option(metavar="EAST NORTH", help="Wind expected in m/s, where it blows to.")] = (0.0, 0.0),
    airspeed: Annotated[float | None, typer.Option(metavar="m/s", callback=Positive, help="By default the vehicle's cruise.")] = None,
    seed: Annotated[int, typer.Option(min=0, help="Of the search and of the mission.")] = 1,
    out: Annotated[Path | None, typer.Option(help="Mission file to write; by default it is printed.")] = None,
) -> None:
    """Fly from a start to a goal past obstacles and within a fence, by RRT* with climbing Dubins paths, as a mission file."""
    from launch.planning.flight import FlightWishes, plan_flight

    with bad_input_is_one_line():
        if not all(math.isfinite(value) for value in wind):
            raise BadInput("--wind takes finite numbers")
        planned = plan_flight(FlightWishes(file, vehicle, world, wind, airspeed, aside, above, seed))
        for line in planned.lines():
            typer.echo(f"uvf: {line}", err=True)
        if out is None:
            typer.echo(planned.mission_text(), nl=False)
        else:
            _write(out, planned.mission_text())


def _camera(fov: tuple[float, float] | None, sensor: tuple[float, float, float] | None) -> "SurveyCamera | None":
    from uvf.planning.coverage.camera import SurveyCamera

    if fov is not None and sensor is not None:
        raise BadInput("give either --fov or --sensor")
    try:
        if sensor is not None:
            return SurveyCamera.from_sensor(*sensor)
        return None if fov is None else SurveyCamera(math.radians(fov[0]), math.radians(fov[1]))
    except ValueError as error:
        raise BadInput(str(error)) from error


def _write(path: Path, text: str) -> None:
    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise BadInput(f"{path}: cannot be written: {error.strerror}") from error
    typer.echo(f"uvf: {path}   fly it with 'uvf run {path}'")
