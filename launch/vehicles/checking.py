"""``uvf vehicle check``: what was found, the tree of frames, a picture."""

from pathlib import Path

import typer
from rich.console import Console

from launch.refusal import counted
from launch.settings import runs_folder
from launch.vehicles.inspection import Inspection, folder_of, inspect
from launch.vehicles.listing import frame_tree
from launch.vehicles.picture import write_picture
from uvf.models.yaml_data import BadInput


def check_all(names: list[str], vehicles: Path, picture: Path | None) -> int:
    """Number of faults of the vehicles together; by default all in ``vehicles``. Raises BadInput for one that is not there."""
    wanted = names or sorted(p.parent.name for p in vehicles.glob("*/vehicle.yaml"))
    found = [inspect(folder_of(name, vehicles)) for name in wanted]
    for one in found:
        _tell(one, picture or runs_folder() / "vehicles" / f"{one.folder.name}.png")
    return sum(len(one.faults) for one in found)


def _tell(found: Inspection, picture: Path) -> None:
    for line in found.faults:
        typer.echo(line)
    for line in found.notes:
        typer.echo(f"note: {found.folder.name}: {line}")
    if found.model is not None and found.file is not None and found.model.roots:
        Console().print(frame_tree(found.model, found.file))
    count = counted(len(found.faults), "fault") if found.faults else "no faults"
    typer.echo(f"uvf: {found.folder.name}: {count}{_picture(found, picture)}")


def _picture(found: Inspection, target: Path) -> str:
    """Of a vehicle that an engine can load."""
    if found.file is None:
        return ""
    try:
        write_picture(found.folder, found.file, target)
    except BadInput:
        return ""
    return f"; picture: {target}"
