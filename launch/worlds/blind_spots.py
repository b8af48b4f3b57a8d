"""What a vehicle's level lidar tells wrong of a world: edges and things that it does not see, and slopes that it takes for walls."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from launch.worlds.report import RESOLUTION
from uvf.maths.footprint import footprint
from uvf.models.shapes.scene import primitives, still
from uvf.models.vehicle.file import VehicleFile
from uvf.models.world.drivable import LEDGE, drivable
from uvf.models.world.file import WorldFile
from uvf.models.world.footing import distance
from uvf.models.world.geometry import GRAZE, above, cell_size, floor_plan, free_regions, things
from uvf.models.world.terrain import relief

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

BESIDE = 0.15  # m from what a lidar sees, within which it is warned
UPHILL = 0.5  # m, within which a slope has to rise to the lidar to be seen
SHORTEST = 0.2  # m
MOST = 6  # of each kind that are told one by one
FEW = 0.05  # m, nothing is nearer than that to a thing that is told by its name


class _Patch(NamedTuple):
    """Cells that hang together: how many metres of them there are, and one in their middle [m, world]."""

    cells: Mask
    length: float
    x: float
    y: float


def blind_spots(world: WorldFile, name: str, file: VehicleFile) -> Iterator[str]:
    """Yields lines on what the lidar of a ground vehicle, called ``name``, tells wrong of a world. Raises BadInput for a mesh."""
    body, lidars = file.ground, file.sensors.lidars
    if body is None or not lidars:
        return
    heights = [lidar.mount.xyz[2] for lidar in lidars]
    plan = floor_plan(world, cell_size(world, RESOLUTION))
    parts = still(things(world))
    ground = drivable(parts, *plan.axes(), relief(world)).height
    floor = free_regions(plan, body.radius) == 1
    side = plan.resolution
    rim = plan.cells & _wider(floor, side, side)
    seen, rises = np.zeros_like(rim), np.zeros_like(rim)
    uphill = ndimage.maximum_filter(ground, size=2 * round(UPHILL / side) + 1)
    for height in heights:
        seen |= above(plan, ground, parts, (height - GRAZE, height + GRAZE))
        rises |= uphill > ground + height
    driven = ndimage.maximum_filter(np.where(floor, ground, -np.inf), size=5)
    falls = driven - ndimage.minimum_filter(ground, size=3) > LEDGE
    unseen = rim & ~_wider(seen, side, BESIDE) & (falls | ~_wider(rises, side, BESIDE))
    by = f"the lidar of {name}, " + " and ".join(f"{height:.2f}" for height in sorted(set(heights))) + " m high,"
    others = "only its depth camera does" if file.sensors.camera is not None and file.sensors.camera.depth else "keep-out zones help"
    hidden = _patches(unseen, plan.axes(), side)
    yield from _told([_hidden(world, ground, patch, side) for patch in hidden], f"{by} does not see", others)
    walls = above(plan, np.zeros_like(ground), parts, (min(heights) - GRAZE, min(heights) + GRAZE)) | (ground > min(heights))
    slopes = _patches(walls & floor & _wider(floor & (ground <= min(heights)), side, side), plan.axes(), side)
    yield from _told([_slope(world, patch) for patch in slopes], f"{by} takes for walls", "it goes round them")


def _wider(cells: Mask, side: float, by: float) -> Mask:
    wide: Mask = ndimage.distance_transform_edt(~cells) * side <= by * 1.01 if cells.any() else cells
    return wide


def _patches(cells: Mask, axes: tuple[Floats, Floats], side: float) -> list[_Patch]:
    """The longest first."""
    near = _wider(cells, side, 2 * side)
    numbers, _ = ndimage.label(near)
    found = []
    for number, window in enumerate(ndimage.find_objects(numbers), 1):
        own = np.zeros_like(cells)
        own[window] = (numbers[window] == number) & cells[window]
        rows, columns = np.nonzero(own)
        length = len(rows) * side
        if length >= SHORTEST:
            middle = np.argmin((rows - rows.mean()) ** 2 + (columns - columns.mean()) ** 2)
            found.append(_Patch(own, length, float(axes[0][columns[middle]]), float(axes[1][rows[middle]])))
    return sorted(found, key=lambda patch: -patch.length)


def _hidden(world: WorldFile, ground: Floats, patch: _Patch, side: float) -> str:
    about = _wider(patch.cells, side, 2 * side)
    step, thing = float(np.ptp(ground[about])), _thing_at(world, patch, GRAZE)
    at = f"about ({patch.x:.1f}, {patch.y:.1f})"
    if step <= LEDGE:
        return f"{thing or 'steep ground'} {at}"
    return f"an edge of {step:.2f} m {at}" + (f", of {thing}" if thing is not None else "")


def _slope(world: WorldFile, patch: _Patch) -> str:
    return f"{_thing_at(world, patch, -1.0) or 'the terrain'} about ({patch.x:.1f}, {patch.y:.1f})"


def _thing_at(world: WorldFile, patch: _Patch, low: float) -> str | None:
    """Name of the nearest thing there that reaches above ``low`` [m]; None where there is none."""
    near = [(distance(footprint(primitives(t), low, 1e3), patch.x, patch.y), t.name) for t in things(world) if t.path is None]
    away, name = min(near, default=(np.inf, ""))
    return name if away < FEW else None


def _told(found: list[str], what: str, remedy: str) -> Iterator[str]:
    if found:
        several = list(dict.fromkeys(found))
        more = f" and {len(several) - MOST} more" if len(several) > MOST else ""
        yield f"{what}: {'; '.join(several[:MOST])}{more} ({remedy})"
