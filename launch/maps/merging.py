"""``uvf map merge``: session files put together, and what is written of it."""

from pathlib import Path
from typing import Any

import matplotlib
import numpy as np

from launch.slam.drawing import draw_on_map
from launch.slam.results import grid_of
from uvf.models.world.map_file import GridMap, save_map
from uvf.models.yaml_data import BadInput
from uvf.runtime.state.saved_maps import map_path
from uvf.slam.maps.session import MappingSession
from uvf.slam.merging.team import MapGroup, Team

SUFFIX = ".npz"
COLOURS = matplotlib.colormaps["tab10"].colors  # type: ignore[attr-defined]


def merge_files(names: list[str], out: str, resolution: float) -> tuple[list[str], bool]:
    """Merges saved sessions into one map with cells of ``resolution`` [m]; writes map, session and picture.

    Returns (lines about each session and what was written, whether any of them fit). names: files, or saved sessions. Raises BadInput.
    """
    if len(names) < 2:
        raise BadInput("'uvf map merge' needs two sessions at least")
    paths = [_session_path(name) for name in names]
    twice = next((name for k, name in enumerate(names) if paths[k].resolve() in [path.resolve() for path in paths[:k]]), None)
    if twice is not None:
        raise BadInput(f"session {twice}: given twice")
    team = Team()
    for name, path in zip(names, paths, strict=True):
        team.follow(name, MappingSession.load(path))
    team.finish()
    group = max(team.groups, key=lambda group: len(group.names))
    lines = [_line(team, group, name) for name in names]
    if len(group.names) == 1:
        return [*lines, "nothing is written: no two of them have enough in common to be sure that they are of one place"], False
    return [*lines, f"written: {_write(team, group, out, resolution)}"], True


def _session_path(name: str) -> Path:
    path = map_path(name)
    return path if path == Path(name) else path.with_suffix(SUFFIX)


def _line(team: Team, group: MapGroup, name: str) -> str:
    own = team.group_of(name)
    if len(own.names) == 1:
        return f"{name}: fits nowhere"
    if own is not group:
        return f"{name}: fits {', '.join(other for other in own.names if other != name)}, but not {group.names[0]}"
    if name == group.names[0]:
        return f"{name}: the frame of the others"
    x, y, yaw = team.team_from_map(name)
    closures = sum(name in (c.a, c.b) for c in group.joint.crossings)
    where = f"its origin is at ({x:.2f}, {y:.2f}) m, {np.degrees(yaw):.1f} deg in {group.names[0]}"
    return f"{name}: {where}; {closures} closures, {group.quality:.0%} of what was seen twice is the same"


def _write(team: Team, group: MapGroup, out: str, resolution: float) -> str:
    """Map, session and picture. Raises BadInput."""
    session = team.session_of(group)
    path = map_path(out)
    stem = path.with_suffix("") if path.suffix in (".yaml", ".pgm", ".png", SUFFIX) else path
    grid = grid_of(session.keyframes, resolution)
    yaml = save_map(grid, stem.with_name(f"{stem.name}.yaml"))
    session.save(yaml.with_suffix(SUFFIX))
    draw_team(group, grid, yaml.with_suffix(".png"))
    return ", ".join(str(yaml.with_suffix(suffix)) for suffix in (".yaml", SUFFIX, ".png"))


def draw_team(group: MapGroup, grid: GridMap, target: Path) -> None:
    """Draws the map with the trajectory of each session in its own colour into a PNG."""

    def ways(axes: Any) -> None:
        for colour, (name, poses) in zip(COLOURS * len(group.names), group.joint.poses.items(), strict=False):
            axes.plot(*poses[:, :2].T, lw=1.0, color=colour, label=Path(name).name)
            axes.plot(*poses[0, :2], "o", ms=5, color=colour)
        axes.legend(fontsize=8)

    draw_on_map(grid, ways, f"{len(group.names)} sessions", target)
