"""The occupancy map of keyframes: it grows without bounds, forgets what has gone, and follows the poses after a loop.

Log-odds (Moravec & Elfes 1985) as sums of whole numbers, so that a keyframe can be taken out exactly. 64 keyframes make an
epoch, which has sums of its own; belief goes from epoch to epoch and is bounded between them. So newer evidence
counts more: what has gone vanishes in the next epoch at the latest, after about ten looks through it.
"""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from math import cos, floor, isfinite, sin

import numpy as np
from numpy.typing import NDArray

from uvf.maths.grids import distance_field
from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2, compose, inverse
from uvf.models.yaml_data import BadInput
from uvf.slam.maps.evidence import CellEvidence
from uvf.slam.maps.tile_kernels import TILE, beam_ends, sketch, touched_tiles
from uvf.slam.method import Keyframe
from uvf.slam.reading import Reading

Floats = NDArray[np.float64]
Cells = NDArray[np.int8]

EPOCH = 64  # keyframes
NO_RETURN_REACH = 0.9
"""Part of the lidar's range that a beam without a return counts as free."""
OPEN_LIMIT = 5.0
"""m, and no farther than that: glass and black things give no return either (Cartographer's missing_data_ray_length)."""
LONGEST = 200.0
"""m, beams that say they are longer are no return."""
GAP = 0.4
"""m between neighbouring ends up to which they are taken for one surface; no door is as narrow."""
MOVED = 0.5
"""Part of a cell by which a keyframe's hits have to move, on average, before it is drawn again."""
FARTHEST = 1e6  # m, from the map's origin
MOST_CELLS = 400_000_000
OCCUPIED = 50  # per cent, above which something stands there
_KEY = 1 << 32


@dataclass
class _Drawn:
    """A keyframe as it stands in the map. reach: mean range of its hits [m]."""

    reading: Reading
    map_from_base: Pose2
    epoch: int
    reach: float


class TileMap:
    """Occupancy map of square cells of ``resolution`` [m] in tiles.

    Cell (row, column) covers resolution * (column..+1, row..+1) of the map frame.
    """

    def __init__(self, resolution: float = 0.05) -> None:
        self.resolution = resolution
        self._drawn: dict[int, _Drawn] = {}
        self._count = 0
        self._members: Counter[int] = Counter()
        self._evidence = CellEvidence()
        self._outdated = False
        self._window = np.zeros(0, dtype=np.int8)
        self._folded: dict[int, Cells] = {}
        self._dirty: set[int] = set()

    def __len__(self) -> int:
        """Keyframes in the map."""
        return len(self._drawn)

    def follow(self, keyframes: Iterable[Keyframe]) -> int:
        """Makes this the map of these keyframes; returns how many had to be drawn, drawn again or taken out.

        A reading is known by its identity: new ones are drawn, those that have moved are drawn again, missing ones taken out.
        Raises BadInput for a pose that is not finite or beyond FARTHEST, and for a wrong number of ranges.
        """
        changed, seen = 0, set()
        for keyframe in keyframes:
            seen.add(id(keyframe.reading))
            changed += self.add(keyframe)
        for key in self._drawn.keys() - seen:
            self._take_out(self._drawn.pop(key))
            changed += 1
        return changed

    def add(self, keyframe: Keyframe) -> bool:
        """Draws a keyframe, again if it is drawn elsewhere by more than a part of a cell; True when the map may have changed."""
        pose = keyframe.map_from_base
        if not all(isfinite(v) and abs(v) < FARTHEST for v in pose):
            raise BadInput(f"a keyframe at {tuple(pose)} cannot be drawn: the map reaches to {FARTHEST:g} m; look at the odometry")
        for reading in (keyframe.reading, *keyframe.reading.others):
            if len(reading.ranges) != len(reading.beams.bearings):
                bearings = len(reading.beams.bearings)
                raise BadInput(f"a keyframe of {len(reading.ranges)} ranges cannot be drawn: its lidar has {bearings} beams")
        old = self._drawn.get(id(keyframe.reading))
        if old is None:
            old = _Drawn(keyframe.reading, pose, self._count // EPOCH, _mean_range(keyframe.reading))
            self._drawn[id(keyframe.reading)] = old
            self._members[old.epoch] += 1
            self._count += 1
        elif _shift(old, pose) <= MOVED * self.resolution:
            return False
        else:
            self._draw(old, -1)
        old.map_from_base = pose
        self._draw(old, 1)
        return True

    def cells(self) -> tuple[Cells, tuple[float, float]]:
        """Occupancy (rows, columns), -1 unknown, 0..100 per cent occupied, and the corner (x, y) [m, map] of cell [0, 0].

        Of the tiles in which anything is known or from which a keyframe was seen; one unknown cell where nothing is known.
        Raises BadInput when that is too large.
        """
        self._fold()
        if not self._folded:
            return np.full((1, 1), -1, dtype=np.int8), (0.0, 0.0)
        places = np.array([*map(_place, self._folded), *self._standing()])
        low = places.min(axis=0)
        rows, columns = ((places.max(axis=0) - low + 1) * TILE).tolist()
        if rows * columns > MOST_CELLS:
            size = f"{columns * self.resolution:.0f} x {rows * self.resolution:.0f} m"
            raise BadInput(f"a map of {size} has more than {MOST_CELLS} cells; look for a jump in the odometry, or take larger cells")
        out = np.full((rows, columns), -1, dtype=np.int8)
        for (row, column), tile in zip((places[: len(self._folded)] - low) * TILE, self._folded.values(), strict=True):
            out[row : row + TILE, column : column + TILE] = tile
        return out, (float(low[1] * TILE * self.resolution), float(low[0] * TILE * self.resolution))

    def _standing(self) -> set[tuple[int, int]]:
        """Rows and columns of the tiles that the vehicle has stood in: a lidar ahead of its centre sees nothing of them at first."""
        side = TILE * self.resolution
        return {(floor(d.map_from_base.y / side), floor(d.map_from_base.x / side)) for d in self._drawn.values()}

    def distances(self) -> tuple[Floats, tuple[float, float]]:
        """Distances (rows, columns) [m] from each cell's centre to the nearest occupied one's, and the corner [m, map] of cell [0, 0]."""
        cells, corner = self.cells()
        return distance_field(cells > OCCUPIED) * self.resolution, corner

    def _draw(self, drawn: _Drawn, sign: int) -> None:
        """What all lidars saw, with where the base was then."""
        map_from_odom = compose(drawn.map_from_base, inverse(drawn.reading.odom_from_base))
        self._draw_reading(drawn.reading, drawn.map_from_base, drawn.epoch, sign)
        for other in drawn.reading.others:
            self._draw_reading(other, compose(map_from_odom, other.odom_from_base), drawn.epoch, sign)

    def _draw_reading(self, reading: Reading, pose: Pose2, epoch: int, sign: int) -> None:
        if self._outdated:
            return  # all will be drawn anew
        beams = reading.beams
        c, s = cos(pose.yaw), sin(pose.yaw)
        sensor = (pose.x + c * beams.origin[0] - s * beams.origin[1], pose.y + s * beams.origin[0] + c * beams.origin[1], pose.yaw)
        gate = (beams.range_min, min(beams.range_max, LONGEST), min(NO_RETURN_REACH * beams.range_max, OPEN_LIMIT))
        ends, hit, start, (row, column, rows, columns) = beam_ends((reading.ranges, beams.directions), sensor, gate, self.resolution)
        size = rows * columns * TILE * TILE
        if size > self._window.size:
            self._window = np.zeros(size, dtype=np.int8)
        window = self._window[:size]
        sketch(ends, hit, start, GAP / self.resolution, (window, columns * TILE))
        window = window.reshape(rows * TILE, columns * TILE)
        tiles = touched_tiles(window.view(np.int64))
        keys = ((tiles[:, 0] + row) * _KEY + (tiles[:, 1] + column)).tolist()
        if self._evidence.is_settled(epoch, keys):
            self._outdated, window[:] = True, 0
        else:
            self._evidence.add(epoch, keys, (window, tiles), sign)
            self._dirty.update(keys)

    def _take_out(self, drawn: _Drawn) -> None:
        self._draw(drawn, -1)
        self._members[drawn.epoch] -= 1
        if self._members[drawn.epoch] == 0 and not self._outdated:
            self._evidence.forget(drawn.epoch)

    def _fold(self) -> None:
        """Brings up to date what the touched tiles show; all of it when something has moved that had been settled."""
        if self._outdated:
            self._evidence, self._outdated = CellEvidence(), False
            self._folded.clear()
            self._dirty.clear()
            for drawn in self._drawn.values():
                self._draw(drawn, 1)
        keys = list(self._dirty)
        for key, tile in zip(keys, self._evidence.cells(keys), strict=True):
            if (tile >= 0).any():
                self._folded[key] = tile
            else:
                self._folded.pop(key, None)
        self._dirty.clear()


def _place(key: int) -> tuple[int, int]:
    """Row and column of a tile."""
    column = (key + _KEY // 2) % _KEY - _KEY // 2
    return (key - column) // _KEY, column


def _mean_range(reading: Reading) -> float:
    returned = reading.returned
    return float(reading.ranges[returned].mean()) if returned.any() else OPEN_LIMIT


def _shift(drawn: _Drawn, pose: Pose2) -> float:
    """m, bound of how far a hit at the mean range lies from where it is drawn."""
    old = drawn.map_from_base
    return float(np.hypot(pose.x - old.x, pose.y - old.y)) + abs(wrap(pose.yaw - old.yaw)) * drawn.reach
