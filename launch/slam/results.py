"""The folder that a run over a log leaves: trajectories, map, figures, parameters, report."""

import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import yaml
from numpy.typing import NDArray

from launch.slam.drawing import draw_map, draw_page
from launch.slam.known import Known
from launch.slam.scoring import Figures
from launch.slam.tables import Rows, all_tables, remarks
from uvf.maths.se2 import Pose2
from uvf.models.params import Params
from uvf.models.whole_file import write_whole
from uvf.models.world.map_file import GridMap, save_map
from uvf.slam.evaluation.run import LogRun
from uvf.slam.maps.tiles import TileMap
from uvf.slam.method import Keyframe

Floats = NDArray[np.float64]


def grid_of(keyframes: Iterable[Keyframe], resolution: float) -> GridMap:
    """The occupancy map of keyframes with cells of ``resolution`` [m]. Raises BadInput."""
    tiles = TileMap(resolution)
    tiles.follow(keyframes)
    cells, corner = tiles.cells()
    return GridMap(cells, resolution, Pose2(corner[0], corner[1], 0.0))


@dataclass(frozen=True)
class Made:
    """How a run was made. resolution: cell size of its map [m]."""

    method: str
    params: Params
    resolution: float


def write_results(run: LogRun, known: Known, made: Made, figures: Figures, folder: Path) -> None:
    """Writes trajectories, map, figures, parameters and report into ``folder``. Raises BadInput."""
    grid = grid_of(run.keyframes, made.resolution)
    write_whole(folder / "trajectory.txt", _trajectory(run, run.final))
    write_whole(folder / "trajectory_online.txt", _trajectory(run, run.online))
    save_map(grid, folder / "map.yaml")
    if run.session is not None:
        run.session.save(folder / "session.npz")
    write_whole(folder / "figures.json", json.dumps(figures, indent=1).encode())
    effective = {"method": made.method, "resolution": made.resolution, "params": msgspec.to_builtins(made.params)}
    write_whole(folder / "params.yaml", yaml.safe_dump(effective, sort_keys=False).encode())
    title = f"{run.log.name}, {made.method}"
    draw_map(grid, run, title, folder / "map.png")
    draw_page(grid, run, known, title, folder / "report.png")
    write_whole(folder / "report.md", _report(run, title, figures, effective).encode())


def _trajectory(run: LogRun, poses: Floats) -> bytes:
    lines = [f"{stamp:.6f} {x:.6f} {y:.6f} {yaw:.7f}" for stamp, (x, y, yaw) in zip(run.log.stamps.tolist(), poses.tolist(), strict=True)]
    return "\n".join(("# stamp x y yaw: map_from_base, s, m, rad", *lines, "")).encode()


def _report(run: LogRun, title: str, figures: Figures, effective: dict[str, Any]) -> str:
    parts = [f"# {title}", *(f"- {note}" for note in run.log.notes)]
    for heading, rows in all_tables(figures).items():
        parts += [f"## {heading.capitalize()}", _markdown(rows)]
    parts += remarks(figures)
    parts += ["![Map, trajectory, errors](report.png)", "## Map", "![Map](map.png)"]
    parts += ["## Parameters", f"```yaml\n{yaml.safe_dump(effective, sort_keys=False)}```", ""]
    return "\n\n".join(parts)


def _markdown(rows: Rows) -> str:
    head, *body = rows
    return "\n".join((f"| {' | '.join(head)} |", "|---" * len(head) + "|", *(f"| {' | '.join(row)} |" for row in body)))
