"""What stands in a world, as prisms that an aircraft keeps clear of."""

import numpy as np
import shapely

from uvf.maths.footprint import footprint
from uvf.maths.rotations import rotate
from uvf.maths.solids import TRIANGLE
from uvf.maths.zones import Disc, Point, Polygon
from uvf.models.shapes.scene import still
from uvf.models.shapes.solid import Solid
from uvf.models.world.file import WorldFile
from uvf.models.world.geometry import things
from uvf.planning.flight.airspace import Prism

ANY_HEIGHT = 1e6  # m


def prisms_of(world: WorldFile) -> list[Prism]:
    """A prism from below the ground for each thing that stands still: its convex outline, up to its top. Raises BadInput for a bad mesh."""
    return [prism for solid in things(world) if solid.path is None and (prism := _prism(solid)) is not None]


def _prism(solid: Solid) -> Prism | None:
    parts = still([solid])
    shadow = footprint(parts, -ANY_HEIGHT, ANY_HEIGHT)
    if solid.shape == "mesh":
        heights = parts.rows[parts.kinds == TRIANGLE, :9].reshape(-1, 3)[:, 2]
        top = float(heights.max()) if len(heights) else -ANY_HEIGHT
    else:
        top = float(solid.position[2]) + _half_height(solid)
    if len(shadow.discs) and not shadow.outlines:
        x, y, radius = shadow.discs[0].tolist()
        return Prism(Disc((x, y), radius), ceiling=top)
    hull = shapely.MultiPoint(np.concatenate([np.zeros((0, 2)), *shadow.outlines])).convex_hull
    if not isinstance(hull, shapely.Polygon) or hull.is_empty:
        return None
    corners: list[Point] = [(x, y) for x, y in np.array(hull.exterior.coords)[:-1].tolist()]
    return Prism(Polygon(corners), ceiling=top)


def _half_height(solid: Solid) -> float:
    if solid.shape == "sphere":
        return solid.size[0]
    up = [abs(float(rotate(solid.orientation, axis)[2])) for axis in np.eye(3)]
    if solid.shape == "box":
        return float(np.dot(up, solid.size)) / 2
    radius, height = solid.size
    return up[2] * height / 2 + float(np.sqrt(max(1.0 - up[2] ** 2, 0.0))) * radius
