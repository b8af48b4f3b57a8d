"""Rays in space against a fixed scene and moving bodies: what lidars, range finders and sonars see.

The first surface met counts. From inside of a solid that is its exit face, as in the plane (``raycast.py``); triangles have two
sides. The surface belongs to the solid: a ray along a face meets it. All kernels stand in this one file, for numba's cache on disk
does not notice a change of a kernel that is called from another file.
"""

from collections.abc import Sequence
from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.bvh import Bvh, build
from uvf.maths.compiled import compiled
from uvf.maths.rotations import IDENTITY, matrix
from uvf.maths.solids import BOX, SPHERE, TRIANGLE, box, cylinder, joined, mesh, sphere

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Pose = tuple[Floats, Floats]
"""Position (3,) of a frame in the world [m] and rotation matrix (3, 3) world_from_frame."""

HERE: Pose = (np.zeros(3), np.eye(3))
STILL = 1e-200
"""Direction component below which a ray does not move along that axis."""
SLACK = 1e-6
"""[m] Added to the radius of a body's bounding sphere, against rounding."""


class Scene(NamedTuple):
    """What never moves: the tree of all solids, and the height of an infinite ground plane z = ground [m], None: there is none."""

    tree: Bvh
    ground: float | None = None


class MovingBody(NamedTuple):
    """What moves: solids in the body's own frame (built once), and its pose now: position (3,) [m], quaternion wxyz (4,)."""

    tree: Bvh
    position: Floats
    world_from_body: Floats = IDENTITY


class Rays(NamedTuple):
    """Rays in the world: origins (n, 3), or (3,) for all [m], and directions (n, 3), of unit length."""

    origins: Floats
    directions: Floats


def cast(scene: Scene, bodies: Sequence[MovingBody], rays: Rays, max_range: float) -> Floats:
    """Distances (n,) [m] to the first surface that each ray meets within ``max_range`` [m], inf where there is none.

    A sensor leaves its own body out by not listing it. Directions that are not of unit length give distances, and take
    ``max_range``, in multiples of that length. Raises ValueError when there are neither one origin nor n.
    """
    # copies: a read-only or strided array would have the kernels compiled once more, in the middle of a run
    directions = np.array(rays.directions, dtype=np.float64, order="C").reshape(-1, 3)
    origins = np.array(rays.origins, dtype=np.float64, order="C").reshape(-1, 3)
    if len(origins) not in (1, len(directions)):
        raise ValueError(f"{len(origins)} origins for {len(directions)} directions; give one or as many")
    ranges = np.full(len(directions), np.nextafter(max_range, np.inf))
    if scene.ground is not None:
        _cast_ground(float(scene.ground), origins, directions, ranges)
    _cast_tree(scene.tree, HERE, (origins, directions), ranges)
    for body in bodies:
        pose = (np.array(body.position, dtype=np.float64), matrix(body.world_from_body))
        _cast_tree(body.tree, pose, (origins, directions), ranges)
    ranges[ranges > max_range] = np.inf
    return ranges


def warm_up() -> None:
    """Loads or compiles every kernel: call it once at the start, before timing matters."""
    parts = [box((1, 1, 1), (3, 0, 0)), cylinder(0.5, 1.0, (0, 3, 0)), sphere(0.5, (0, 0, 3)), mesh(np.eye(3), ((0, 1, 2),))]
    tree = build(joined(parts))
    cast(Scene(tree, -1.0), [MovingBody(tree, np.ones(3))], Rays(np.zeros(3), np.eye(3)), 10.0)


@compiled
def _cast_ground(height: float, origins: Floats, directions: Floats, ranges: Floats) -> None:
    """Lowers ``ranges`` where the plane is nearer; the plane is seen from both sides."""
    each = 1 if origins.shape[0] > 1 else 0
    for i in range(directions.shape[0]):
        t = (height - origins[i * each, 2]) / directions[i, 2]
        if 0.0 <= t < ranges[i]:
            ranges[i] = t


@compiled
def _cast_tree(tree: Bvh, pose: Pose, rays: tuple[Floats, Floats], ranges: Floats) -> None:
    """Lowers ``ranges`` where a solid of the tree, which stands at ``pose``, is nearer."""
    if tree.kinds.shape[0] == 0:
        return
    origins, directions = rays
    each = 1 if origins.shape[0] > 1 else 0
    ball = _bounding_ball(tree.bounds, pose)
    ray, axes, stack = np.empty(12), np.empty(3, dtype=np.int64), np.empty(tree.depth + 1, dtype=np.int64)
    for i in range(directions.shape[0]):
        if _may_meet(ball, origins[i * each], directions[i], ranges[i]):
            _into_frame(pose, origins[i * each], directions[i], ray)
            _prepare(ray, axes)
            ranges[i] = _first_hit(tree, (ray, axes), stack, ranges[i])


@compiled
def _bounding_ball(bounds: Floats, pose: Pose) -> tuple[float, float, float, float]:
    """Centre in the world and radius [m] of the sphere round the root's box."""
    position, r = pose
    low, high = bounds[0, :3], bounds[0, 3:]
    x, y, z = (low + high) / 2
    radius = sqrt(((high - low) ** 2).sum()) / 2 + SLACK
    return (
        position[0] + r[0, 0] * x + r[0, 1] * y + r[0, 2] * z,
        position[1] + r[1, 0] * x + r[1, 1] * y + r[1, 2] * z,
        position[2] + r[2, 0] * x + r[2, 1] * y + r[2, 2] * z,
        radius,
    )


@compiled
def _may_meet(ball: tuple[float, float, float, float], o: Floats, d: Floats, best: float) -> bool:
    """Whether the ray comes into the ball before ``best``."""
    x, y, z = ball[0] - o[0], ball[1] - o[1], ball[2] - o[2]
    if x * x + y * y + z * z <= ball[3] * ball[3]:
        return True
    squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
    t = (x * d[0] + y * d[1] + z * d[2]) / squared
    x, y, z = x - t * d[0], y - t * d[1], z - t * d[2]
    inside = ball[3] * ball[3] - (x * x + y * y + z * z)
    return bool(inside >= 0.0 and t >= 0.0 and t - sqrt(inside / squared) <= best)


@compiled
def _into_frame(pose: Pose, o: Floats, d: Floats, ray: Floats) -> None:
    """Origin and direction in the frame that stands at ``pose``, as ray[0:3] and ray[3:6]."""
    position, r = pose
    x, y, z = o[0] - position[0], o[1] - position[1], o[2] - position[2]
    for k in range(3):
        ray[k] = r[0, k] * x + r[1, k] * y + r[2, k] * z
        ray[3 + k] = r[0, k] * d[0] + r[1, k] * d[1] + r[2, k] * d[2]


@compiled
def _prepare(ray: Floats, axes: Ints) -> None:
    """Inverse direction ray[6:9]; shear ray[9:12] and axes (kx, ky, kz) that turn the ray into the z axis (Woop et al. 2013)."""
    kz = 0
    for k in range(3):
        d = ray[3 + k]
        ray[6 + k] = 1.0 / d if abs(d) > STILL else 1.0 / STILL
        if abs(d) > abs(ray[3 + kz]):
            kz = k
    kx, ky = (kz + 1) % 3, (kz + 2) % 3
    axes[0], axes[1], axes[2] = kx, ky, kz
    ray[9], ray[10], ray[11] = ray[3 + kx] / ray[3 + kz], ray[3 + ky] / ray[3 + kz], 1.0 / ray[3 + kz]


@compiled
def _first_hit(tree: Bvh, ray_axes: tuple[Floats, Ints], stack: Ints, best: float) -> float:
    """The least of ``best`` and the distances to the solids of the tree: nearer child first, the other waits on the stack."""
    ray, axes = ray_axes
    node, top = 0, 0
    while True:
        link, count = tree.links[node, 0], tree.links[node, 1]
        if count > 0:
            for i in range(link, link + count):
                t = _distance(tree.kinds[i], tree.rows[i], ray, axes)
                if t < best:
                    best = t
        else:
            one, other = _entry(tree.bounds, link, ray, best), _entry(tree.bounds, link + 1, ray, best)
            near = link if one <= other else link + 1
            if one < np.inf and other < np.inf:
                stack[top] = 2 * link + 1 - near
                top += 1
            if one < np.inf or other < np.inf:
                node = near
                continue
        while top > 0 and not _entry(tree.bounds, stack[top - 1], ray, best) < np.inf:
            top -= 1
        if top == 0:
            return best
        top -= 1
        node = stack[top]


@compiled
def _entry(bounds: Floats, node: int, ray: Floats, best: float) -> float:
    """Where the ray comes into a node's box, inf when it misses it or comes later than ``best``; slabs (Kay & Kajiya 1986)."""
    near, far = 0.0, best
    for k in range(3):
        a = (bounds[node, k] - ray[k]) * ray[6 + k]
        b = (bounds[node, 3 + k] - ray[k]) * ray[6 + k]
        near = max(near, min(a, b))
        far = min(far, max(a, b))
    return near if near <= far else np.inf


@compiled
def _distance(kind: int, row: Floats, ray: Floats, axes: Ints) -> float:
    """Parameter along the ray of the first surface of one primitive, inf when it is not met."""
    if kind == TRIANGLE:
        return _triangle(row, ray, axes)
    ox = row[0] * ray[0] + row[1] * ray[1] + row[2] * ray[2] + row[3]
    oy = row[4] * ray[0] + row[5] * ray[1] + row[6] * ray[2] + row[7]
    oz = row[8] * ray[0] + row[9] * ray[1] + row[10] * ray[2] + row[11]
    dx = row[0] * ray[3] + row[1] * ray[4] + row[2] * ray[5]
    dy = row[4] * ray[3] + row[5] * ray[4] + row[6] * ray[5]
    dz = row[8] * ray[3] + row[9] * ray[4] + row[10] * ray[5]
    if kind == SPHERE:
        near, far = _unit_sphere((ox, oy, oz), (dx, dy, dz))
    else:
        near, far = _slab(oz, dz)
        a, b = _slab(ox, dx) if kind == BOX else _unit_sphere((ox, oy, 0.0), (dx, dy, 0.0))
        near, far = max(near, a), min(far, b)
        if kind == BOX:
            a, b = _slab(oy, dy)
            near, far = max(near, a), min(far, b)
    if near > far or far < 0.0:
        return np.inf
    return near if near >= 0.0 else far


@compiled
def _slab(o: float, d: float) -> tuple[float, float]:
    """Where |o + t d| <= 1 begins and ends."""
    if d == 0.0:
        return (-np.inf, np.inf) if abs(o) <= 1.0 else (np.inf, -np.inf)
    a, b = (-1.0 - o) / d, (1.0 - o) / d
    return min(a, b), max(a, b)


@compiled
def _unit_sphere(o: tuple[float, float, float], d: tuple[float, float, float]) -> tuple[float, float]:
    """Where |o + t d| <= 1 begins and ends, from the point nearest to the centre: no cancellation far away (Haines et al. 2019)."""
    squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
    if squared == 0.0:
        return (-np.inf, np.inf) if o[0] * o[0] + o[1] * o[1] + o[2] * o[2] <= 1.0 else (np.inf, -np.inf)
    t = -(o[0] * d[0] + o[1] * d[1] + o[2] * d[2]) / squared
    x, y, z = o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]
    inside = 1.0 - (x * x + y * y + z * z)
    if inside < 0.0:
        return np.inf, -np.inf
    half = sqrt(inside / squared)
    return t - half, t + half


@compiled
def _triangle(row: Floats, ray: Floats, axes: Ints) -> float:
    """Woop, Benthin & Wald, "Watertight Ray/Triangle Intersection" (2013): no ray slips through an edge that two triangles share."""
    kx, ky, kz = axes[0], axes[1], axes[2]
    az, bz, cz = row[kz] - ray[kz], row[3 + kz] - ray[kz], row[6 + kz] - ray[kz]
    ax, ay = row[kx] - ray[kx] - ray[9] * az, row[ky] - ray[ky] - ray[10] * az
    bx, by = row[3 + kx] - ray[kx] - ray[9] * bz, row[3 + ky] - ray[ky] - ray[10] * bz
    cx, cy = row[6 + kx] - ray[kx] - ray[9] * cz, row[6 + ky] - ray[ky] - ray[10] * cz
    u, v, w = cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax
    if (u < 0.0 or v < 0.0 or w < 0.0) and (u > 0.0 or v > 0.0 or w > 0.0):
        return np.inf
    determinant = u + v + w
    if determinant == 0.0:
        return np.inf
    t = (u * az + v * bz + w * cz) * ray[11] / determinant
    return t if t >= 0.0 else np.inf
