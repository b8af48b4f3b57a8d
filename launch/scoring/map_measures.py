"""Measures of maps: how much of the floor they know, how well their walls and heights fit the world."""

import numpy as np
from numpy.typing import NDArray

from launch.scoring.finding import Finding
from launch.scoring.recorded_track import RecordedTrack
from schemas.messages import Grid
from uvf.maths.raycast import Rays, cast
from uvf.maths.se2 import Pose2
from uvf.models.scenario import Scenario
from uvf.models.shapes.scene import scene
from uvf.models.world.file import WorldFile
from uvf.models.world.geometry import FloorPlan, cell_size, floor_plan, solids
from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.maps.grids import as_map
from uvf.runtime.messages.maps.height_grids import heights_of
from uvf.runtime.messages.maps.mapped_floor import MappedFloor
from uvf.slam.maps.quality import MapScore, score

Floats = NDArray[np.float64]

PLAN_CELL = 0.02  # m
"""m, of the floor plan that maps are held against; in larger cells, so that it has no more than that many."""
AT_ONCE = 20_000  # columns whose heights are looked at together
ABOVE = 1000.0  # m, from where the world is looked at for its heights
EVEN = 0.25  # m, by which heights in and next to a column may differ: at the edge of a wall no height of a column is the right one
PROBES = np.array([(0.0, 0.0)] + [(x, y) for x in (-1.5, -0.5, 0.5, 1.5) for y in (-1.5, -0.5, 0.5, 1.5)])
"""Places in a column and in those around it at which the world is looked at, in sides of it from its centre."""


def mapped_floor(track: RecordedTrack) -> Finding:
    """Share of the reachable floor that the vehicle's own map knows as free [0 to 1].

    Counts at the end of the run, in the last map. The floor is what the outline of the vehicle can cover from its start. 0 without a map.
    """
    if track.grid is None:
        return Finding(0.0, note="there is no map")
    return Finding(MappedFloor(track.site.world, track.site.members[track.name]).share(track.grid))


def map_f1(track: RecordedTrack) -> Finding:
    """F1 score of the walls of the vehicle's own map within 0.10 m of those of the world [0 to 1].

    Counts at the end of the run, in the last map, as placed by the mission's start; walls that the map does not know are left out.
    0 without a map.
    """
    if track.grid is None:
        return Finding(0.0, note="there is no map")
    try:
        tight, loose = _score(track.grid, track).walls.detections
    except BadInput as error:
        return Finding(0.0, note=str(error))
    return Finding(loose.f1, note=f"{tight.f1:.2f} within 0.05 m")


def height_error(track: RecordedTrack) -> Finding:
    """RMS of the difference between the vehicle's map of heights and the world's surface from above [m].

    Counts at the end of the run, in the last map of heights on ``map/heights``, over columns on the world's floor. Those in or beside which
    the world is not even are left out: a wall one column from its place is no error of height. Infinite without such a map.
    """
    if track.heights is None:
        return Finding(np.inf, note="there is no map of heights")
    grid = Grid.FromString(track.heights)
    try:
        top = heights_of(grid)[0].astype(np.float64)
    except BadInput as error:
        return Finding(np.inf, note=str(error))
    rows, columns = np.nonzero(np.isfinite(top))
    corner = np.array((grid.pose.position.x, grid.pose.position.y))
    centres: Floats = corner + (np.column_stack((columns, rows)) + 0.5) * grid.cell_size.x
    mapped = top[rows, columns]
    low, high = np.reshape(track.site.world.floor, (2, 2))
    inside = ((centres >= low) & (centres <= high)).all(axis=1)
    centres, mapped = centres[inside], mapped[inside]
    parts = [_surface(track.site, part, grid.cell_size.x) for part in np.array_split(centres, len(centres) // AT_ONCE + 1)]
    true, even = np.concatenate([part[0] for part in parts]), np.concatenate([part[1] for part in parts])
    if not even.any():
        return Finding(np.inf, note="no column of it lies on the world's floor")
    errors = (mapped - true)[even]
    return Finding(float(np.sqrt(np.mean(errors**2))), note=f"median {np.median(np.abs(errors)):.2f} m of {len(errors)} columns")


def true_plan(world: WorldFile) -> FloorPlan:
    """The floor plan that maps are held against."""
    return floor_plan(world, cell_size(world, PLAN_CELL))


def _score(message: Grid, track: RecordedTrack) -> MapScore:
    grid, start = as_map(message), track.site.members[track.name].entry.start
    return score(grid, true_plan(track.site.world), Pose2(start.x, start.y, start.yaw))


def _surface(site: Scenario, centres: Floats, side: float) -> tuple[Floats, NDArray[np.bool_]]:
    """Height (n,) [m] of the world at the centres (n, 2) [m] of columns, and (n,) whether it is even about it."""
    world = scene(solids(site.world))
    places = (centres[:, None, :] + PROBES * side).reshape(-1, 2)
    origins = np.column_stack((places, np.full(len(places), ABOVE)))
    down = np.broadcast_to((0.0, 0.0, -1.0), origins.shape)
    heights = ABOVE - cast(world, [], Rays(origins, down), 2 * ABOVE).reshape(-1, len(PROBES))
    return heights[:, 0], np.ptp(heights, axis=1) <= EVEN
