"""The plain geometry of a world: its solids, what a level lidar meets of them, the floor plan and what can be reached."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from uvf.maths.footprint import Footprint, covered, footprint, segments
from uvf.maths.rotations import from_euler, rotate
from uvf.maths.solids import Solids, chosen
from uvf.models.shapes.scene import still
from uvf.models.shapes.solid import Keyframes, Solid
from uvf.models.world.drivable import drivable
from uvf.models.world.file import TERRAIN, Box, Ramp, Script, Terrain, Wall, WorldFile
from uvf.models.world.terrain import relief, terrain_mesh

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
WALL, LOOK = "wall", "look"  # every stretch of wall, and whatever is only seen, is called so
GRAZE = 0.001  # m, lower than that nothing is bumped into
POLE_RADIUS, POLE_COLOUR = 0.06, (0.85, 0.85, 0.85)  # m; of a windsock
BLOCK = 16  # cells a side, of which the ground's lowest and highest are known together
MOST_CELLS = 4_000_000
BESIDE_BUILDING = 0.25
"""What a square metre about a building counts beside one in it."""
BAND = 0.05  # m, steps of height in which obstacles on ramps are looked for


@dataclass(frozen=True)
class FloorPlan:
    """True occupancy. cells: (rows, columns), row 0 at the lowest y; cell [0, 0] has its lower left corner at (x, y) [m, world].

    resolution: side of a cell [m].
    """

    cells: Mask
    resolution: float
    x: float
    y: float

    def cell(self, x: float, y: float) -> tuple[int, int]:
        """(row, column) of the point (x, y) [m, world]."""
        return int(np.floor((y - self.y) / self.resolution)), int(np.floor((x - self.x) / self.resolution))

    def axes(self) -> tuple[Floats, Floats]:
        """x (columns,) and y (rows,) [m, world] of the cells' centres."""
        rows, columns = self.cells.shape
        xs = self.x + (np.arange(columns, dtype=np.float64) + 0.5) * self.resolution
        ys = self.y + (np.arange(rows, dtype=np.float64) + 0.5) * self.resolution
        return xs, ys

    def under(self, shadows: Footprint) -> Mask:
        """Cells (rows, columns) that shadows cover in any part."""
        return covered(shadows, (self.x, self.y), self.resolution, (self.cells.shape[0], self.cells.shape[1]))

    def centres(self) -> tuple[Floats, Floats]:
        """x and y [m, world] of the cells' centres, each (rows, columns)."""
        grid_x, grid_y = np.meshgrid(*self.axes())
        return grid_x, grid_y


def wall_boxes(wall: Wall) -> Iterator[Box]:
    """One box for each stretch of a wall; stretches overlap where they meet at a corner, free ends (door frames) keep their length."""
    closed = wall.points[0] == wall.points[-1]
    last = len(wall.points) - 2
    for i, (a, b) in enumerate(zip(wall.points, wall.points[1:], strict=False)):
        start, end = np.array(a), np.array(b)
        along = (end - start) / np.linalg.norm(end - start)
        overlap = along * wall.thickness / 2
        start = start - overlap if i > 0 or closed else start
        end = end + overlap if i < last or closed else end
        x, y = (start + end) / 2
        size = (float(np.linalg.norm(end - start)), wall.thickness, wall.height)
        yaw = float(np.arctan2(along[1], along[0]))
        yield Box(name=WALL, centre=(float(x), float(y), wall.height / 2), size=size, rpy=(0.0, 0.0, yaw), colour=wall.colour)


def ramp_box(ramp: Ramp) -> Box:
    """The box of which a ramp is the upper face; the rest of it lies below the face, and where that is low in the ground."""
    slope, along = float(np.arctan2(ramp.height, ramp.length)), np.array((np.cos(ramp.yaw), np.sin(ramp.yaw)))
    depth = ramp.height * float(np.cos(slope))
    x, y = np.array(ramp.foot) + along * (ramp.length + depth * np.sin(slope)) / 2
    centre = (float(x), float(y), float(ramp.height - depth * np.cos(slope)) / 2)
    size = (float(np.hypot(ramp.length, ramp.height)), ramp.width, depth)
    return Box(ramp.name, centre, size, (0.0, -slope, ramp.yaw), ramp.colour)


def all_boxes(world: WorldFile) -> list[Box]:
    """The boxes of a world: those of the walls, then the furniture, then the ramps."""
    return [*(box for wall in world.walls for box in wall_boxes(wall)), *world.boxes, *map(ramp_box, world.ramps)]


def solids(world: WorldFile, folder: Path = Path()) -> list[Solid]:
    """Every solid of a world, walls first, the terrain last. The ground, z = 0, is none of them.

    folder: holds the files of a world that was not loaded from a file; a loaded one knows where they are.
    """
    return [*things(world, folder), *hills(world, folder)]


def hills(world: WorldFile, folder: Path = Path()) -> list[Solid]:
    """The terrain of a world, if it has one; folder: as for ``solids``."""
    return [] if world.terrain is None else [land(world.terrain, terrain_mesh(world.terrain, folder))]


def land(terrain: Terrain, mesh: Path) -> Solid:
    """The terrain as a solid; mesh: its triangles in metres, world axes."""
    return Solid(TERRAIN, "mesh", (1.0, 1.0, 1.0), np.zeros(3), colour=terrain.colour, mesh=mesh)


def things(world: WorldFile, folder: Path = Path()) -> list[Solid]:
    """Solids that stand on the ground or the terrain of a world; folder: as for ``solids``."""
    made = [Solid(b.name, "box", b.size, np.array(b.centre), from_euler(*b.rpy), b.colour, path=_script(b.path)) for b in all_boxes(world)]
    for c in world.cylinders:
        tilt = from_euler(*c.rpy)
        middle = np.array(c.base) + rotate(tilt, np.array((0.0, 0.0, c.height / 2)))
        made.append(Solid(c.name, "cylinder", (c.radius, c.height), middle, tilt, c.colour, path=_script(c.path)))
    made += [Solid(s.name, "sphere", (s.radius,), np.array(s.centre), colour=s.colour) for s in world.spheres]
    for sock in world.windsocks:
        middle = np.array(sock.base) + np.array((0.0, 0.0, sock.height / 2))
        made.append(Solid(sock.name, "cylinder", (POLE_RADIUS, sock.height), middle, colour=POLE_COLOUR))
    for m in world.meshes:
        made.append(Solid(m.name, "mesh", m.scale, np.array(m.position), from_euler(*m.rpy), m.colour, folder / m.file))
    return made


def seen(world: WorldFile, folder: Path = Path()) -> list[Solid]:
    """What is drawn of a world but its terrain: the things that are not hidden, and the looks; folder: as for ``solids``."""
    hidden = {thing.name for group in (world.boxes, world.cylinders, world.spheres, world.meshes) for thing in group if thing.hidden}
    looks = [Solid(LOOK, "mesh", k.scale, np.array(k.position), from_euler(*k.rpy), k.colour, folder / k.file) for k in world.looks]
    return [*(solid for solid in things(world, folder) if solid.name not in hidden), *looks]


def _script(path: Script) -> Keyframes | None:
    return Keyframes(np.array(path)) if path else None


def floor_plan(world: WorldFile, resolution: float, height: float = 0.2) -> FloorPlan:
    """Which cells, of side ``resolution`` [m], hold an obstacle for a robot of ``height`` [m], above the ground that it drives on.

    Ramps and platforms with a ramp are driven on (``drivable.py``), their steep edges are obstacles. What moves by script is left out.
    Exact in the plane: a cell is occupied when any part of it is. Raises BadInput for a mesh that cannot be read.
    """
    plan = empty_plan(world, resolution)
    parts = still(things(world))
    ground = drivable(parts, *plan.axes(), relief(world))
    standing = above(plan, ground.height, chosen(parts, ~ground.surface), (GRAZE, height))
    return replace(plan, cells=ground.cliffs(resolution) | standing)


def above(plan: FloorPlan, ground: Floats, parts: Solids, span: tuple[float, float]) -> Mask:
    """Cells (rows, columns) that hold any part of the primitives within a span [m] above the ground, whose height is known by cell."""
    low, high = span
    ranges = _ground_under(parts, ground, plan)
    cells = plan.under(footprint(parts, low, high)) & (ground <= GRAZE)
    for band in np.unique(np.floor(ground[ground > GRAZE] / BAND) * BAND):
        about = (ranges[:, 0] <= band + BAND) & (ranges[:, 1] > band)
        shadows = footprint(chosen(parts, about), band + BAND + low, band + BAND + high)
        if shadows.outlines or len(shadows.discs):
            cells |= (ground > max(band, GRAZE)) & (ground <= band + BAND) & plan.under(shadows)
    return cells


def _ground_under(parts: Solids, heights: Floats, plan: FloorPlan) -> Floats:
    """Lowest and highest ground (n, 2) [m] under the rectangle about each primitive, or somewhat more about it."""
    rows, columns = heights.shape
    blocks = np.pad(heights, ((0, -rows % BLOCK), (0, -columns % BLOCK)), mode="edge")
    blocks = blocks.reshape(len(blocks) // BLOCK, BLOCK, -1, BLOCK)
    lowest, highest = blocks.min(axis=(1, 3)), blocks.max(axis=(1, 3))
    side, corner, last = BLOCK * plan.resolution, np.array((plan.x, plan.y)), np.array(lowest.shape[::-1]) - 1
    first, end = (np.clip(np.floor((ends[:, :2] - corner) / side), 0, last).astype(np.int64) for ends in (parts.low, parts.high))
    found = [
        (lowest[b : d + 1, a : c + 1].min(), highest[b : d + 1, a : c + 1].max())
        for (a, b), (c, d) in zip(first.tolist(), end.tolist(), strict=True)
    ]
    return np.array(found, dtype=np.float64).reshape(-1, 2)


def cell_size(world: WorldFile, finest: float) -> float:
    """Side [m] of the cells in which a world's floor is looked at: ``finest`` [m], or more of a floor that has too many of them."""
    x_min, y_min, x_max, y_max = world.floor
    return max(finest, float(np.sqrt((x_max - x_min) * (y_max - y_min) / MOST_CELLS)))


def floor_segments(world: WorldFile, height: float) -> Floats:
    """Segments (n, 2, 2) [m, world], by their ends, of the outlines of all that stands still at ``height`` [m]; outlines may overlap."""
    return segments(footprint(still(solids(world)), height - GRAZE, height + GRAZE))


def section(world: WorldFile, resolution: float, height: float) -> FloorPlan:
    """Which cells, of side ``resolution`` [m], hold anything that stands still at ``height`` [m]: what a level lidar there sees."""
    plan = empty_plan(world, resolution)
    return replace(plan, cells=plan.under(footprint(still(solids(world)), height - GRAZE, height + GRAZE)))


def empty_plan(world: WorldFile, resolution: float) -> FloorPlan:
    """The floor of a world with nothing on it, in cells of side ``resolution`` [m]."""
    x_min, y_min, x_max, y_max = world.floor
    rows, columns = (int(np.ceil((high - low) / resolution - 1e-9)) for low, high in ((y_min, y_max), (x_min, x_max)))
    return FloorPlan(np.zeros((rows, columns), dtype=np.bool_), resolution, x_min, y_min)


def reachable_floor(plan: FloorPlan, x: float, y: float, radius: float) -> Mask:
    """Floor (rows, columns) that a round robot of ``radius`` [m] starting at (x, y) [m, world] can cover with its body.

    It is what its disc sweeps, its centre being at ``reachable_places``.
    """
    return _swept(plan, reachable_places(plan, x, y, radius), radius)


def reachable_places(plan: FloorPlan, x: float, y: float, radius: float) -> Mask:
    """Places (rows, columns) of the centre of a round robot of ``radius`` [m] starting at (x, y) [m, world].

    It may be where the nearest solid is no closer than the radius. Empty when the start is not free.
    """
    labels = _where_it_fits(plan, radius)
    row, column = plan.cell(x, y)
    if not (0 <= row < plan.cells.shape[0] and 0 <= column < plan.cells.shape[1]) or labels[row, column] == 0:
        return np.zeros_like(plan.cells)
    places: Mask = labels == labels[row, column]
    return places


def free_regions(plan: FloorPlan, radius: float) -> NDArray[np.int32]:
    """Floors (rows, columns) that a round robot of ``radius`` [m] can cover from one start, numbered from 1 by size; 0: none of them.

    What it could cover from two starts belongs to the nearer. What lies about a closed building comes after the building's largest
    floor, unless that is small beside it.
    """
    labels = _where_it_fits(plan, radius)
    if not labels.any():
        return labels
    away, nearest = ndimage.distance_transform_edt(labels == 0, return_indices=True)
    covered = np.where((away * plan.resolution <= radius) & ~plan.cells, labels[tuple(nearest)], 0)
    sizes = np.bincount(covered.ravel()).astype(np.float64)
    sizes[0] = 0.0
    sizes[list(around(covered))] *= BESIDE_BUILDING
    number = np.zeros(len(sizes), dtype=np.int32)
    number[np.argsort(-sizes, kind="stable")] = np.arange(1, len(sizes) + 1)
    number[0] = 0
    found: NDArray[np.int32] = number[covered]
    return found


def around(regions: NDArray[np.int32]) -> set[int]:
    """Numbers of the regions that reach to all four sides: what lies about a closed building."""
    sides = (regions[0], regions[-1], regions[:, 0], regions[:, -1])
    return set.intersection(*(set(np.unique(side).tolist()) for side in sides)) - {0}


def _where_it_fits(plan: FloorPlan, radius: float) -> NDArray[np.int32]:
    """Connected places of a round robot's centre, numbered from 1; 0 where it does not fit."""
    room = ndimage.distance_transform_edt(np.pad(~plan.cells, 1))[1:-1, 1:-1] * plan.resolution
    labels: NDArray[np.int32] = ndimage.label(room > radius)[0]
    return labels


def _swept(plan: FloorPlan, centres: Mask, radius: float) -> Mask:
    if not centres.any():
        return np.zeros_like(plan.cells)
    swept: Mask = ndimage.distance_transform_edt(~centres) * plan.resolution <= radius
    return swept & ~plan.cells
