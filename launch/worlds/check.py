"""What is likely to be a mistake in a world: things in the air or in the ground, floor out of reach, scripts that go through walls."""

from collections.abc import Iterator

import msgspec
import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from launch.worlds.report import RESOLUTION
from uvf.maths.footprint import Footprint, footprint
from uvf.maths.se2 import Pose2
from uvf.models.mission.fixtures import MARKER
from uvf.models.scenario import Scenario
from uvf.models.shapes.scene import primitives
from uvf.models.shapes.solid import Solid
from uvf.models.urdf.outline import ground_outline
from uvf.models.world.file import WorldFile
from uvf.models.world.footing import Footing
from uvf.models.world.geometry import WALL, around, cell_size, floor_plan, free_regions, things
from uvf.models.world.terrain import Relief, relief
from uvf.models.yaml_data import FileLocation

Floats = NDArray[np.float64]

GAP = 0.02  # m, that still counts as standing on something
SMALLEST_ROOM = 0.5  # m^2
MOST_ROOMS = 8  # that are told one by one
LARGEST_HOLLOW = 3.0  # m, side of a mesh that is a thing and no building
LONGEST = 120.0  # s of the scripts that are looked at
STEP = 0.1  # s
RIM = 16  # points on a round one's rim


def problems(world: WorldFile, radius: float) -> Iterator[str]:
    """Yields likely mistakes in a world, a line each; radius [m]: of the vehicle that is to drive there.

    Raises BadInput for a mesh that cannot be read.
    """
    standing = things(world)
    yield from _heights(standing, relief(world))
    yield from _out_of_reach(world, radius)
    yield from _crossings(standing)


def blocked_starts(site: Scenario) -> Iterator[str]:
    """Yields the ground vehicles of a mission that start inside of something."""
    footing = Footing(site.world)
    for name, member in site.members.items():
        body, start = member.file.ground, member.entry.start
        if body is None:
            continue
        outline = ground_outline(member.folder / body.urdf, body.radius)
        if not footing.is_free(Pose2(start.x, start.y, start.yaw), outline):
            yield f"start of {name} at ({start.x:g}, {start.y:g}), {np.degrees(start.yaw):.0f} deg: it stands in a wall or furniture"


def hidden_markers(site: Scenario) -> Iterator[str]:
    """Yields the markers of a mission that stand in something, where nobody can see them or come to them."""
    posts = {f"{MARKER}{i + 1}" for i in range(len(site.mission.markers))}
    if posts:
        bare = msgspec.structs.replace(site.world, cylinders=[post for post in site.world.cylinders if post.name not in posts])
        footing, place = Footing(bare), FileLocation(str(site.mission_path))
        for i, marker in enumerate(site.mission.markers):
            if (room := footing.at(marker.x, marker.y, marker.height).room) < marker.radius:
                yield f"{place.at('markers', i)}: ({marker.x:g}, {marker.y:g}) is {room:.2f} m from a wall or furniture; move it"


def _heights(things: list[Solid], land: Relief | None) -> Iterator[str]:
    """Things that hang in the air, resting on nothing that stands; things that nobody sees for they lie below the ground."""
    bounds = [_bounds(thing) for thing in things]
    grounds = [0.0 if land is None else _land_under(land, *bound) for bound in bounds]
    standing = {i for i, (low, _) in enumerate(bounds) if low[2] <= grounds[i] + GAP}
    new = set(standing)
    while new:
        reached = {i for i in range(len(things)) if i not in standing and any(_touch(bounds[i], bounds[k]) for k in new)}
        standing |= reached
        new = reached
    for i, thing in enumerate(things):
        low, high = (bound[2] - grounds[i] for bound in bounds[i])
        if i not in standing:
            yield f"{thing.name} floats: nothing between it and the ground, {low:.2f} m below"
        elif high < -GAP:
            yield f"{thing.name} is sunk: it ends {-high:.2f} m below the ground"
        elif -low > high and thing.shape != "mesh" and _level(thing):
            yield f"{thing.name} is sunk: {-low:.2f} m of it lie below the ground, {high:.2f} m above"


def _bounds(thing: Solid) -> tuple[Floats, Floats]:
    parts = primitives(thing)
    return parts.low.min(axis=0), parts.high.max(axis=0)


def _land_under(land: Relief, low: Floats, high: Floats) -> float:
    """Height [m] of the terrain at its highest under the corners and the middle of a thing: what it stands on."""
    x, y = np.meshgrid(*np.linspace(low[:2], high[:2], 3).T)
    return float(land.at(x, y)[0].max())


def _touch(one: tuple[Floats, Floats], other: tuple[Floats, Floats]) -> bool:
    return bool((one[0] <= other[1] + GAP).all() and (one[1] >= other[0] - GAP).all())


def _level(thing: Solid) -> bool:
    return bool(abs(thing.orientation[1]) + abs(thing.orientation[2]) < 1e-6)


def _out_of_reach(world: WorldFile, radius: float) -> Iterator[str]:
    """All floor but the largest connected one, what lies about a closed building, and the hollows of meshes."""
    hollows = [b for t in things(world) if t.shape == "mesh" and ((b := _bounds(t))[1] - b[0])[:2].max() <= LARGEST_HOLLOW]
    plan = floor_plan(world, cell_size(world, RESOLUTION))
    regions, (xs, ys), told, left = free_regions(plan, radius), plan.axes(), 0, 0.0
    about = around(regions)
    for number, window in enumerate(ndimage.find_objects(regions), 1):
        region = regions[window] == number
        area = float(region.sum()) * plan.resolution**2
        if number == 1 or number in about or area < SMALLEST_ROOM:
            continue
        rows, columns = np.nonzero(region)
        cells = np.column_stack((xs[window[1]][columns], ys[window[0]][rows]))
        if any((cells >= low[:2]).all() and (cells <= high[:2]).all() for low, high in hollows):
            continue
        told += 1
        if told <= MOST_ROOMS:
            at = cells.mean(axis=0)
            yield f"{area:.1f} m^2 of floor about ({at[0]:.1f}, {at[1]:.1f}) are out of reach for a radius of {radius:g} m"
        else:
            left += area
    if told > MOST_ROOMS:
        yield f"{told - MOST_ROOMS} more pieces of floor, {left:.1f} m^2 in all, are out of reach for a radius of {radius:g} m"


def _crossings(things: list[Solid]) -> Iterator[str]:
    """Scripts that lead through things that stand, or through each other."""
    moving = [thing for thing in things if thing.path is not None]
    for i, mover in enumerate(moving):
        times = np.arange(0.0, LONGEST, STEP, dtype=np.float64)
        points = _rims(mover, times)
        low, high = _bounds(mover)
        for thing in things:
            if thing.path is None:
                shadow = footprint(primitives(thing), low[2] + GAP, high[2])
                met = _inside(shadow, points.reshape(-1, 2)).reshape(points.shape[:2])
                yield from _told(mover, thing, times, np.flatnonzero(met.any(axis=1)))
        for other in moving[:i]:
            reach = _reach(mover) + _reach(other)
            apart = np.linalg.norm(points.mean(axis=1) - _rims(other, times).mean(axis=1), axis=1)
            yield from _told(mover, other, times, np.flatnonzero(apart < reach))


def _told(mover: Solid, thing: Solid, times: Floats, met: NDArray[np.intp]) -> Iterator[str]:
    if len(met) and mover.path is not None:
        t = float(times[met[0]])
        x, y, _ = mover.path.at(t)
        name = "a wall" if thing.name == WALL else thing.name
        yield f"{mover.name} goes through {name} at t = {t:.1f} s, ({x:.2f}, {y:.2f})"


def _rims(mover: Solid, times: Floats) -> Floats:
    """(times, points, 2) m: points on its rim and inside, as it moves."""
    if mover.shape == "box":
        half = np.array(mover.size[:2]) / 2
        local = np.array([(a, b) for a in np.linspace(-1, 1, 5) for b in np.linspace(-1, 1, 5)]) * half
    else:
        angles = np.arange(RIM) * (2 * np.pi / RIM)
        local = mover.size[0] * np.column_stack((np.cos(angles), np.sin(angles)))
    path = mover.path
    assert path is not None
    poses = np.array([path.at(float(t)) for t in times])
    c, s = np.cos(poses[:, 2, np.newaxis]), np.sin(poses[:, 2, np.newaxis])
    x = poses[:, 0, np.newaxis] + c * local[:, 0] - s * local[:, 1]
    y = poses[:, 1, np.newaxis] + s * local[:, 0] + c * local[:, 1]
    return np.stack((x, y), axis=2)


def _reach(mover: Solid) -> float:
    return float(min(mover.size[:2]) / 2 if mover.shape == "box" else mover.size[0])


def _inside(shadow: Footprint, points: Floats) -> NDArray[np.bool_]:
    """(n,) which points lie in any shadow."""
    found = np.zeros(len(points), dtype=np.bool_)
    for outline in shadow.outlines:
        sides = np.roll(outline, -1, axis=0) - outline
        turns = [ex * (points[:, 1] - oy) - ey * (points[:, 0] - ox) for (ox, oy), (ex, ey) in zip(outline, sides, strict=True)]
        found |= (np.array(turns) > 0).all(axis=0) if len(outline) > 2 else False
    for x, y, radius in shadow.discs:
        found |= np.hypot(points[:, 0] - x, points[:, 1] - y) < radius
    return found
