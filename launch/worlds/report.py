"""What there is of a world: lists, figures, its floor plan."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from uvf.models.world.file import WorldFile, load_world
from uvf.models.world.geometry import FloorPlan, free_regions
from uvf.models.world.terrain import relief_of
from uvf.models.yaml_data import BadInput

Mask = NDArray[np.bool_]

RESOLUTION = 0.05  # m


def listed(worlds: Path) -> Iterator[str]:
    """Yields a line for each world: what it is about, or what is wrong with it."""
    for path in sorted(worlds.glob("*/world.yaml")):
        name = path.parent.name
        try:
            yield f"{name:12} {load_world(worlds, name).about}"
        except BadInput as error:
            yield f"{name:12} cannot be read: {error}"


def figures(world: WorldFile) -> Iterator[str]:
    """Yields lines on size, geographic origin, weather, and the number of things of each kind."""
    x_min, y_min, x_max, y_max = world.floor
    origin, east_north_up = world.origin, ", ".join(f"{v:g}" for v in world.wind.steady)
    yield world.about
    yield f"floor    {x_max - x_min:g} x {y_max - y_min:g} m, x {x_min:g} .. {x_max:g}, y {y_min:g} .. {y_max:g}"
    if world.terrain is not None:
        land = relief_of(world.terrain)
        low, high, cell = land.heights.min(), land.heights.max(), land.x[1] - land.x[0]
        yield f"terrain  {land.x[-1] - land.x[0]:g} x {land.y[-1] - land.y[0]:g} m, {low:.1f} .. {high:.1f} m high, cells of {cell:g} m"
    yield f"origin   {origin.latitude:.5f}, {origin.longitude:.5f} deg, {origin.altitude:g} m"
    yield f"wind     {east_north_up} m/s (east, north, up)"
    yield f"field    {np.linalg.norm(world.magnetic_field) * 1e6:.1f} uT"
    counts = {kind: len(getattr(world, kind)) for kind in ("walls", "boxes", "cylinders", "spheres", "meshes", "fields")}
    yield "things   " + ", ".join(f"{count} {kind}" for kind, count in counts.items() if count)
    moving = [thing.name for things in (world.boxes, world.cylinders) for thing in things if thing.path]
    if moving:
        yield f"moving   {', '.join(moving)}"


def largest_reachable(plan: FloorPlan, radius: float) -> Mask:
    """Mask (rows, columns) of the largest floor region that a round robot of ``radius`` [m] covers from one start."""
    largest: Mask = free_regions(plan, radius) == 1
    return largest
