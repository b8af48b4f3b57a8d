"""Maps saved by name on this machine, and by path anywhere else."""

from pathlib import Path

from uvf.models.world.map_file import YAML, GridMap, load_map
from uvf.models.yaml_data import BadInput, nearest
from uvf.runtime.state.state_folder import state_folder


def map_path(name: str, folder: Path = Path()) -> Path:
    """Path of a map: of a plain name the yaml among the saved maps, else a file, from ``folder`` on; need not exist."""
    if Path(name).suffix or "/" in name:
        return folder / name
    return state_folder() / "maps" / f"{name}{YAML[0]}"


def known_path(name: str, folder: Path = Path()) -> Path:
    """Path of a map as by ``map_path``. Raises BadInput with the nearest name for a plain name of no saved map."""
    path = map_path(name, folder)
    if path.stem == name and not path.is_file():
        raise BadInput(f"no map '{name}' is saved; {nearest(name, [p.stem for p in path.parent.glob('*' + YAML[0])])}")
    return path


def find_map(name: str, folder: Path = Path()) -> GridMap:
    """A saved map by its name, or one in a file, from ``folder`` on. Raises BadInput."""
    return load_map(known_path(name, folder))
