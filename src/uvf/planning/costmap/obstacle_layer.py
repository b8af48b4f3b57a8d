"""A rolling window of obstacles: marked where a sensor's beams end, cleared where they pass, forgotten where nothing renews them.

Any range sensor speaks the same way: where it is, where its beams end, and which of them ended at something. A lidar gives one end a
beam, a depth camera its points between the heights that matter, a sonar the arc of its cone, a bumper the place that was touched.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.planning.costmap.costmap import Costmap
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import FREE_SPACE, LETHAL, NO_INFORMATION, Inflation, inflate

Bytes = NDArray[np.uint8]
Floats = NDArray[np.float64]
Stamps = NDArray[np.int32]
Mask = NDArray[np.bool_]
Point = tuple[float, float]
Frame = tuple[float, float, float]

BEYOND = 1.5  # times the window's side, where beams are cut off
LATELY = 1.0  # s
SWING, MOST_SWING = 0.025, 0.25  # m/m, m
LONG_AGO = -(2**30)  # ms


@compiled
def mark_ends(cells: Bytes, seen: Floats, hit: Stamps, frame: Frame, ends: Floats, stamps: tuple[float, int]) -> None:
    """Sets the cells of the points (n, 2) [m] to lethal, ``seen`` at an age and ``hit`` by a scan of a number; others are passed over.

    frame: (x, y of cell [0, 0]'s corner, resolution) [m]; stamps: age, number.
    """
    rows, columns = cells.shape
    for k in range(ends.shape[0]):
        r, c = int(np.floor((ends[k, 1] - frame[1]) / frame[2])), int(np.floor((ends[k, 0] - frame[0]) / frame[2]))
        if 0 <= r < rows and 0 <= c < columns:
            cells[r, c], seen[r, c], hit[r, c] = LETHAL, stamps[0], stamps[1]


@compiled
def clear_beams(cells: Bytes, freed: Stamps, hit: Stamps, frame: Frame, beams: tuple[Floats, Floats], stamps: tuple[int, int]) -> None:
    """Sets the cells that beams pass to free, ``freed`` at a time, without those in which they end and those that the same scan has hit.

    cells: (rows, columns); beams: from their starts to their ends (n, 2) [m], which may lie outside; stamps: time [ms], number of the
    scan. Bresenham's line from the start's cell to the end's; what lies off the grid is passed over.
    """
    starts, ends = beams
    rows, columns = cells.shape
    for k in range(ends.shape[0]):
        r0, c0 = int(np.floor((starts[k, 1] - frame[1]) / frame[2])), int(np.floor((starts[k, 0] - frame[0]) / frame[2]))
        r1, c1 = int(np.floor((ends[k, 1] - frame[1]) / frame[2])), int(np.floor((ends[k, 0] - frame[0]) / frame[2]))
        down, across = abs(r1 - r0), abs(c1 - c0)
        step_r, step_c = (1 if r1 > r0 else -1), (1 if c1 > c0 else -1)
        error, r, c = across - down, r0, c0
        while r != r1 or c != c1:
            if 0 <= r < rows and 0 <= c < columns and hit[r, c] != stamps[1]:
                cells[r, c], freed[r, c] = FREE_SPACE, stamps[0]
            twice = 2 * error
            if twice > -down:
                error -= down
                c += step_c
            if twice < across:
                error += across
                r += step_r


@compiled
def stand_on(freed: Stamps, frame: Frame, eye: Point, points: Floats, since: int) -> Mask:
    """(n,) whether the cells of the points (n, 2) [m] and those next to them were seen free after ``since`` [ms]; never off the grid.

    The farther from the eye, the more cells about a point count: a heading that is late by a few milliseconds swings what is far.
    """
    rows, columns = freed.shape
    found = np.zeros(points.shape[0], dtype=np.bool_)
    for k in range(points.shape[0]):
        r, c = int(np.floor((points[k, 1] - frame[1]) / frame[2])), int(np.floor((points[k, 0] - frame[0]) / frame[2]))
        away = np.hypot(points[k, 0] - eye[0], points[k, 1] - eye[1])
        n = 1 + int(np.ceil(min(SWING * away, MOST_SWING) / frame[2]))
        if n <= r < rows - n and n <= c < columns - n:
            found[k] = freed[r - n : r + n + 1, c - n : c + n + 1].min() > since
    return found


@dataclass(frozen=True)
class BeamObservation:
    """What one sensor saw at ``t`` [s] from ``eye`` (x, y) [m] by beams to ``ends`` (n, 2) [m], all in the window's frame."""

    t: float
    age: float
    """What the lifetime of obstacles is measured by: time [s] or distance travelled [m]; it only rises."""
    eye: Point
    ends: Floats
    hits: Mask
    """(n,) whether the beam ended at something; else it is free up to its end and beyond nothing is known."""
    starts: Floats | None = None
    """(n, 2) m, from where on the beams see the ground; None: from the eye."""


class ObstacleLayer:
    """Obstacles in a square window that moves with the vehicle, in a frame that does not jump (odom) or in the map's.

    size: side of the window [m]; resolution [m]; obstacle_lifetime: age (of observations: time [s] or travel [m]) after which an obstacle
    that no beam has touched again is forgotten, so that nothing stays for ever where the sensors do not look.
    """

    def __init__(self, size: float, resolution: float, obstacle_lifetime: float = np.inf) -> None:
        if not (np.isfinite(size) and 0.0 < resolution < size):
            raise ValueError(f"a window of {size} m in cells of {resolution} m; both must be positive, the cells smaller")
        n = int(np.ceil(size / resolution))
        self.resolution, self.obstacle_lifetime = resolution, obstacle_lifetime
        self.cells: Bytes = np.full((n, n), NO_INFORMATION, dtype=np.uint8)
        self._seen = np.zeros((n, n))
        self._freed: Stamps = np.full((n, n), LONG_AGO, dtype=np.int32)
        self._hit: Stamps = np.zeros((n, n), dtype=np.int32)  # is not moved with the window: it counts within one observation only
        self._count, self._begun = 0, 0.0
        self._corner: tuple[int, int] | None = None  # row, column of cell [0, 0] in a grid that covers the plane

    @property
    def origin(self) -> Point:
        """(x, y) [m] of the corner of cell [0, 0]."""
        row, column = self._corner or (0, 0)
        return column * self.resolution, row * self.resolution

    def recentre(self, centre: Point) -> None:
        """Moves the window so that ``centre`` [m] lies in its middle; what it uncovers is unknown."""
        n = len(self.cells)
        row, column = (int(np.floor(v / self.resolution)) - n // 2 for v in (centre[1], centre[0]))
        if self._corner is None or self._corner == (row, column):
            self._corner = row, column
            return
        down, across = row - self._corner[0], column - self._corner[1]
        self._corner = row, column
        for array, empty in ((self.cells, NO_INFORMATION), (self._seen, 0.0), (self._freed, LONG_AGO)):
            _shift(array, down, across, empty)

    def observe(self, seen: BeamObservation) -> None:
        """Marks the beams' ends and clears along them; what is not finite is left out."""
        self._begun = seen.t if self._count == 0 else self._begun
        self._count += 1
        away = seen.ends - np.array(seen.eye)
        distances, reach = np.hypot(away[:, 0], away[:, 1]), BEYOND * self.resolution * len(self.cells)
        whole, inside = np.isfinite(distances), distances <= reach
        eyes = np.tile(np.array(seen.eye), (len(away), 1))
        ends = eyes[whole] + away[whole] * np.minimum(reach / np.maximum(distances[whole], reach), 1.0)[:, None]
        starts = (eyes if seen.starts is None else seen.starts)[whole]
        frame = (*self.origin, self.resolution)
        mark_ends(self.cells, self._seen, self._hit, frame, seen.ends[whole & inside & seen.hits], (seen.age, self._count))
        clear_beams(self.cells, self._freed, self._hit, frame, (starts, ends), (self._ms(seen.t), self._count))

    def mark(self, points: Floats, age: float) -> None:
        """Marks points (n, 2) [m] that no beam can see: where it was touched, or where nobody is to drive."""
        mark_ends(self.cells, self._seen, self._hit, (*self.origin, self.resolution), points, (age, self._count))

    def lately_free(self, t: float, eye: Point, points: Floats) -> Mask:
        """(n,) whether something that ends beams from ``eye`` at the points (n, 2) [m] at ``t`` [s] has come there.

        The ground there and next to it was seen free within the second before; so it was not where a wall only comes into view.
        """
        return stand_on(self._freed, (*self.origin, self.resolution), eye, points, self._ms(t - LATELY))

    def _ms(self, t: float) -> int:
        """Time since the first observation [ms]."""
        return round(1000.0 * (t - self._begun))

    def forget(self, age: float) -> None:
        """Obstacles that were last seen longer ago than ``obstacle_lifetime`` at ``age`` are unknown again."""
        if np.isfinite(self.obstacle_lifetime):
            self.cells[(self.cells == LETHAL) & (self._seen < age - self.obstacle_lifetime)] = NO_INFORMATION

    def lethal_near(self, centre: Point, reach: float) -> Floats:
        """(n, 2) m centres of the obstacle cells within ``reach`` [m] of ``centre`` along both axes."""
        n, half = len(self.cells), int(np.ceil(reach / self.resolution))
        row, column = (int(np.floor((c - o) / self.resolution)) for c, o in ((centre[1], self.origin[1]), (centre[0], self.origin[0])))
        rows, columns = (slice(min(max(at - half, 0), n), min(max(at + half + 1, 0), n)) for at in (row, column))
        found = np.argwhere(self.cells[rows, columns] == LETHAL) + np.array((rows.start, columns.start))
        out: Floats = (found[:, ::-1] + 0.5) * self.resolution + np.array(self.origin)
        return out

    def free_disc(self, centre: Point, radius: float) -> None:
        """Frees the obstacle cells whose middle lies within ``radius`` [m] of ``centre`` [m]: something that moves is there now."""
        n, reach = len(self.cells), radius / self.resolution
        row, column = ((at - corner) / self.resolution - 0.5 for at, corner in zip(centre[::-1], self.origin[::-1], strict=True))
        top, left = (min(max(int(np.floor(at - reach)), 0), n) for at in (row, column))
        part = self.cells[top : max(int(row + reach) + 2, 0), left : max(int(column + reach) + 2, 0)]
        down, across = np.ogrid[: part.shape[0], : part.shape[1]]
        part[(np.hypot(down + top - row, across + left - column) <= reach) & (part == LETHAL)] = FREE_SPACE

    def is_known(self, points: Floats) -> bool:
        """Whether something is known of the ground at all points (n, 2) [m]."""
        columns, rows = np.floor((points - np.array(self.origin)) / self.resolution).astype(np.int64).T
        n = len(self.cells)
        inside = (rows >= 0) & (rows < n) & (columns >= 0) & (columns < n)
        return bool(inside.all() and (self.cells[rows, columns] != NO_INFORMATION).all())

    def has_room(self, place: Point, radius: float) -> bool:
        """Whether no obstacle lies within ``radius`` [m] of a place [m]."""
        near = self.lethal_near(place, radius)
        return not (np.hypot(near[:, 0] - place[0], near[:, 1] - place[1]) < radius).any()

    def clear(self, beyond: float = 0.0, centre: Point | None = None) -> None:
        """Forgets everything farther than ``beyond`` [m] from ``centre`` [m]: it is unknown again (the resets of move_base)."""
        if centre is None or beyond <= 0.0:
            self.cells[:] = NO_INFORMATION
            return
        n, (x, y) = len(self.cells), self.origin
        at = (np.arange(n) + 0.5) * self.resolution
        self.cells[np.hypot((at + y - centre[1])[:, None], at + x - centre[0]) > beyond] = NO_INFORMATION

    def costmap(self, footprint: RobotFootprint, inflation: Inflation, size: float | None = None) -> Costmap:
        """The window, or its middle of ``size`` [m], as a costmap.

        No half cell is added to the footprint: a beam's end is known better than its cell.
        """
        n = len(self.cells)
        cut = 0 if size is None else max((n - int(np.ceil(size / self.resolution))) // 2, 0)
        cells = np.ascontiguousarray(self.cells[cut : n - cut, cut : n - cut])
        values, distance = inflate(cells, self.resolution, footprint.inscribed_radius, inflation)
        origin = (self.origin[0] + cut * self.resolution, self.origin[1] + cut * self.resolution)
        return Costmap(self.resolution, origin, footprint, values, cells == FREE_SPACE, cells == NO_INFORMATION, distance)


def _shift(array: NDArray[np.generic], down: int, across: int, empty: float) -> None:
    """Moves the contents by so many rows and columns towards [0, 0], in place."""
    n = len(array)
    if abs(down) >= n or abs(across) >= n:
        array[:] = empty
        return
    to_rows, from_rows = _slices(down, n)
    to_columns, from_columns = _slices(across, n)
    kept = array[from_rows, from_columns].copy()
    array[:] = empty
    array[to_rows, to_columns] = kept


def _slices(shift: int, n: int) -> tuple[slice, slice]:
    return (slice(0, n - shift), slice(shift, n)) if shift >= 0 else (slice(-shift, n), slice(0, n + shift))
