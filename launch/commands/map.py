"""``uvf map ...``: maps written to files, checked, served, merged and compared."""

from pathlib import Path
from typing import Annotated

import typer

from launch.refusal import bad_input_is_one_line
from launch.settings import log_path, runs_folder

map_app = typer.Typer(no_args_is_help=True, help="Maps: save, load, merge, compare.")

MapArgument = Annotated[str, typer.Argument(help="A saved map's name, or a file (.yaml, .pgm, .png).")]
VehicleOption = Annotated[str | None, typer.Option("--vehicle", "-v", help="Vehicle (optional if only one publishes a map).")]


@map_app.command("save")
def map_save(
    name: MapArgument,
    vehicle: VehicleOption = None,
    mode: Annotated[str, typer.Option(help="trinary, scale (keeps each cell's value, PNG) or raw (the same, PGM).")] = "trinary",
    own_frame: Annotated[bool, typer.Option("--own-frame", help="Origin in the vehicle's map frame instead of the world's.")] = False,
    session: Annotated[bool, typer.Option("--session", help="Also NAME.npz: to merge, to be localized on, to go on with.")] = False,
    run: Annotated[Path | None, typer.Option(help="Of a past run instead: its folder or log, as runs/latest.")] = None,
    layer: Annotated[str, typer.Option(help="Of a past run: grid, the vehicle's own map, or team, the merged one.")] = "grid",
) -> None:
    """Write the map of a running vehicle, or the last one of a past run, as picture and yaml, as map_saver does."""
    from launch.maps.recorded import recorded_map
    from launch.maps.running import doubt, drawn_map, running_session
    from uvf.models.world.map_file import check_mode, save_map
    from uvf.models.yaml_data import BadInput
    from uvf.runtime.state.saved_maps import map_path

    with bad_input_is_one_line():
        check_mode(map_path(name), mode)
        if run is not None:
            if session:
                raise BadInput("--session: a log holds no session; leave it out, or save while the mission runs")
            owner, grid = recorded_map(log_path(run, "run"), vehicle, layer, own_frame)
        elif layer != "grid":
            raise BadInput(f"--layer {layer}: of a past run only; name it with --run")
        else:
            owner, grid = drawn_map(vehicle, own_frame)
        yaml = save_map(grid, map_path(name), mode)
        typer.echo(f"uvf: map of {owner}: {yaml}")
        if warning := doubt(grid, mode):
            typer.echo(f"uvf: {warning}", err=True)
        if session:
            running_session(owner).save(yaml.with_suffix(".npz"))
            typer.echo(f"uvf: session of {owner}, in its own map frame: {yaml.with_suffix('.npz')}")


@map_app.command("load")
def map_load(
    name: MapArgument,
    vehicle: Annotated[
        str | None, typer.Option("--vehicle", "-v", help="Serve it to this vehicle until Ctrl-C, as map_server does.")
    ] = None,
) -> None:
    """Check a map and tell what is in it; with --vehicle serve it on map/known."""
    from launch.maps.report import figures
    from launch.maps.running import serve
    from uvf.runtime.state.saved_maps import find_map

    with bad_input_is_one_line():
        grid = find_map(name)
        for line in figures(grid):
            typer.echo(line)
        if vehicle is not None:
            serve(grid, vehicle, lambda: typer.echo(f"uvf: served on {vehicle}/map/known   Ctrl-C ends"))


@map_app.command("merge")
def map_merge(
    sessions: Annotated[list[str], typer.Argument(help="Files (.npz) of 'uvf slam', or names given to 'uvf map save --session'.")],
    out: Annotated[str, typer.Option(help="A saved map's name, or a file: map, session (.npz) and picture (.png) are written.")] = "merged",
    resolution: Annotated[float, typer.Option(min=0.01, max=1.0, metavar="m", help="Side of the map's cells.")] = 0.05,
) -> None:
    """Put the maps of several vehicles, or of several days, together, wherever each of them began; 1 when nothing fits."""
    from launch.maps.merging import merge_files

    with bad_input_is_one_line():
        lines, merged = merge_files(sessions, out, resolution)
        for line in lines:
            typer.echo(f"uvf: {line}")
    if not merged:
        raise typer.Exit(1)


@map_app.command("compare")
def map_compare(
    a: MapArgument,
    b: Annotated[str | None, typer.Argument(help="Reference map.")] = None,
    world: Annotated[str | None, typer.Option(help="A world in worlds/, whose floor plan is the truth, instead of another map.")] = None,
    shift: Annotated[
        tuple[float, float, float],
        typer.Option(
            metavar="X Y YAW", help="Pose of the first map in the other's frame: x and y in m, yaw in degrees, as --shift 1.5 -0.2 90."
        ),
    ] = (
        0.0,
        0.0,
        0.0,
    ),
    out: Annotated[Path | None, typer.Option(help="Picture of the differences; by default runs/compare.png.")] = None,
) -> None:
    """Compare two maps, or a map with a world: figures, and a picture of the differences."""
    from launch.maps.report import compared, scored
    from uvf.models.yaml_data import BadInput
    from uvf.runtime.state.saved_maps import find_map

    with bad_input_is_one_line():
        if (b is None) == (world is None):
            raise BadInput("'uvf map compare' needs one thing to compare with: another map, or --world NAME")
        first, picture = find_map(a), out or runs_folder() / "compare.png"
        lines = compared(first, find_map(b), shift, picture) if b is not None else scored(first, str(world), shift, picture)
        for line in lines:
            typer.echo(line)
        typer.echo(f"uvf: {picture}: white and black the same, red only in {a}, blue only in {b or world}")
