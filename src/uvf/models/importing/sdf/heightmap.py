"""A <heightmap> of SDF as the terrain of a world."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from uvf.maths.rotations import rotate
from uvf.maths.se3 import Transform
from uvf.models.importing.heights import read_heights, terrain_of
from uvf.models.importing.notes import Notes
from uvf.models.importing.sdf.poses import numbers
from uvf.models.world.file import Terrain
from uvf.models.yaml_data import BadInput

TURNED = 1e-3


class Heightmaps:
    """Takes the first heightmap of a world; its picture goes into ``folder``."""

    def __init__(self, folder: Path, find: Callable[[str, Any], Path | None], notes: Notes) -> None:
        self._folder, self._find, self._notes = folder, find, notes
        self.terrain: Terrain | None = None
        self.lowest = 0.0
        """Height [m] of the terrain's lowest in the axes of the file."""

    def take(self, heightmap: Any, pose: Transform, name: str) -> None:
        """As Gazebo does it: the highest cell becomes the height of <size>, from 0 of the picture or the elevation model on."""
        uri = (heightmap.findtext("uri") or "").strip()
        source = self._find(uri, heightmap)
        if self.terrain is not None:
            self._notes.add("a world has one heightmap; the others are left out", name)
            return
        if source is None or not source.is_file():
            self._notes.add("heightmaps not found, the ground is level instead", uri)
            return
        if abs(rotate(pose.rotation, np.eye(3)[0])[0] - 1.0) > TURNED:
            self._notes.add("a heightmap that is turned is taken unturned", name)
        try:
            self.terrain, self.lowest = self._made(heightmap, pose, source)
        except BadInput as error:
            self._notes.add("heightmaps that cannot be read, the ground is level instead", f"{name} ({error})")

    def _made(self, heightmap: Any, pose: Transform, source: Path) -> tuple[Terrain, float]:
        grid = read_heights(source, self._notes)
        top, whole = float(grid.heights.max()), heightmap.find("size")
        if whole is not None:
            east, north, height = (float(v) for v in numbers(whole, 3))
        else:
            east, north, height = (*grid.size, top) if grid.size is not None else (1.0, 1.0, 1.0)
        if not (np.isfinite((east, north, height)).all() and min(east, north) > 0.0):
            raise BadInput(f"<size> is {east:g} {north:g} {height:g}; metres above 0 are needed")
        scale = abs(height) / top if top > 0.0 else 1.0
        offset = pose.translation + (numbers(heightmap.find("pos"), 3) if heightmap.find("pos") is not None else np.zeros(3))
        size = (east, north, float(np.ptp(grid.heights)) * scale)
        terrain = terrain_of(grid, size, self._folder / f"{source.stem}-heights.png", self._notes)
        x, y, z = offset.tolist()
        made = Terrain(terrain.heights, size, (x, y, 0.0))
        return made, z + float(grid.heights.min()) * scale
