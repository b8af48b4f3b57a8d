"""Worlds for rays, the same solids for UVF's own rays and for PyBullet's, and what tells how far both agree.

PyBullet's rays take boxes, cylinders and spheres at their stated measures, without collision margin, but find a convex solid by an
iteration that ends early. Measured on these worlds: triangles are met exactly, so are 99 of 100 beams to a box; the rest of the
boxes' and most of the round solids' beams end up to 2.5 mm early, a few 0.4 mm late, and some that pass an edge within millimetres
meet it. A convex solid that a ray begins in is not met at all; so no ray begins in one here.
"""

from typing import Any

import numpy as np
import pybullet
import trimesh
from numpy.typing import NDArray

from uvf.maths import solids
from uvf.maths.bvh import build
from uvf.maths.raycast import Rays, Scene, cast
from uvf.maths.rotations import IDENTITY, from_euler, matrix
from uvf.maths.solids import Solids
from uvf.models.scenario import ROOT
from uvf.models.shapes.mesh import load_mesh
from uvf.models.world.file import load_world
from uvf.models.world.geometry import solids as world_solids

Floats = NDArray[np.float64]

BATCH = 8000  # rays, below what PyBullet takes in one call
NUDGE = 0.02  # m, by which beams are moved to find those that graze an edge
JUMP = 0.05  # m, change of the distance that tells a graze


class Twin:
    """Solids added to both sides; ``close`` ends the engine's."""

    def __init__(self, ground: float | None = None) -> None:
        self.parts: list[Solids] = []
        self._ground = ground
        self._client: int = pybullet.connect(pybullet.DIRECT)
        if ground is not None:
            self._add(pybullet.GEOM_PLANE, (0.0, 0.0, ground), IDENTITY)

    def box(self, size: Floats, position: Any, orientation: Floats = IDENTITY) -> None:
        """size: whole edges [m]."""
        self.parts.append(solids.box(size, position, orientation))
        self._add(pybullet.GEOM_BOX, position, orientation, halfExtents=[float(s) / 2 for s in size])

    def cylinder(self, radius: float, height: float, position: Any, orientation: Floats = IDENTITY) -> None:
        """Its axis along z [m]."""
        self.parts.append(solids.cylinder(radius, height, position, orientation))
        self._add(pybullet.GEOM_CYLINDER, position, orientation, radius=radius, height=height)

    def sphere(self, radius: float, position: Any) -> None:
        """Radius and position in m."""
        self.parts.append(solids.sphere(radius, position))
        self._add(pybullet.GEOM_SPHERE, position, IDENTITY, radius=radius)

    def mesh(self, shape: trimesh.Trimesh, position: Any, orientation: Floats = IDENTITY) -> None:
        """As triangles, of which PyBullet makes no convex hull."""
        vertices, faces = np.asarray(shape.vertices), np.asarray(shape.faces)
        self.parts.append(solids.mesh(vertices, faces, position, orientation))
        concave = {"vertices": vertices.tolist(), "indices": faces.ravel().tolist(), "flags": pybullet.GEOM_FORCE_CONCAVE_TRIMESH}
        self._add(pybullet.GEOM_MESH, position, orientation, **concave)

    def _add(self, kind: int, position: Any, orientation: Floats, **measures: Any) -> None:
        w, x, y, z = orientation
        shape = pybullet.createCollisionShape(kind, physicsClientId=self._client, **measures)
        pybullet.createMultiBody(0.0, shape, -1, [float(p) for p in position], (x, y, z, w), physicsClientId=self._client)

    def scene(self) -> Scene:
        """The same solids for UVF's own rays."""
        return Scene(build(solids.joined(self.parts)), self._ground)

    def batch(self, origins: list[list[float]], ends: list[list[float]]) -> Any:
        """PyBullet's own call, nothing around it."""
        return pybullet.rayTestBatch(origins, ends, physicsClientId=self._client)

    def cast(self, rays: Rays, max_range: float) -> Floats:
        """(n,) distances [m] as PyBullet finds them, inf where there is nothing."""
        ends = rays.origins + max_range * rays.directions
        hits = []
        for first in range(0, len(ends), BATCH):
            some = slice(first, first + BATCH)
            hits += self.batch(rays.origins[some].tolist(), ends[some].tolist())
        return np.array([max_range * hit[2] if hit[0] >= 0 else np.inf for hit in hits])

    def free(self, points: Floats) -> NDArray[np.bool_]:
        """Which points (n, 3) lie in no box, cylinder or sphere and not close to one."""
        table = solids.joined(self.parts)
        convex = table.kinds != solids.TRIANGLE
        rows = table.rows[convex].reshape(-1, 3, 4)
        u = np.einsum("kij,nj->nki", rows[:, :, :3], points) + rows[:, :, 3]
        widest, round_ = np.abs(u).max(axis=2), np.hypot(u[:, :, 0], u[:, :, 1])
        kinds = table.kinds[convex]
        reach = np.where(kinds == solids.BOX, widest, np.maximum(round_, np.abs(u[:, :, 2])))
        reach = np.where(kinds == solids.SPHERE, np.linalg.norm(u, axis=2), reach)
        return np.asarray((reach > 1.1).all(axis=1))

    def close(self) -> None:
        """Ends the PyBullet world."""
        pybullet.disconnect(self._client)


def fan(beams: int) -> Floats:
    """(beams, 3) level directions all round."""
    angles = np.linspace(-np.pi, np.pi, beams, endpoint=False)
    return np.column_stack((np.cos(angles), np.sin(angles), np.zeros(beams)))


def random_scans(twin: Twin, rng: np.random.Generator, area: Floats, tilt: float) -> Rays:
    """Fans of 36 beams from 1000 random poses in ``area`` (2, 3) low, high [m], rolled and pitched by up to ``tilt`` [rad]."""
    points = rng.uniform(area[0], area[1], (20_000, 3))
    points = points[twin.free(points)][:1000]
    leans = rng.uniform((-tilt, -tilt, -np.pi), (tilt, tilt, np.pi), (len(points), 3))
    turns = [matrix(from_euler(roll, pitch, yaw)) for roll, pitch, yaw in leans]
    return Rays(np.repeat(points, 36, axis=0), np.concatenate([fan(36) @ turn.T for turn in turns]))


def grazing(scene: Scene, rays: Rays, ranges: Floats, max_range: float) -> NDArray[np.bool_]:
    """Which beams meet something clearly nearer or farther when they are moved a little aside."""
    rng, found = np.random.default_rng(1), np.zeros(len(ranges), dtype=bool)
    for _ in range(16):
        aside = rng.normal(size=rays.origins.shape)
        aside *= NUDGE / np.linalg.norm(aside, axis=1, keepdims=True)
        moved = cast(scene, [], Rays(rays.origins + aside, rays.directions), max_range)
        found |= np.abs(np.nan_to_num(moved, posinf=1e9) - np.nan_to_num(ranges, posinf=1e9)) > JUMP
    return found


def built_worlds() -> list[str]:
    """The worlds that have more than a floor."""
    names = sorted(path.parent.name for path in (ROOT / "worlds").glob("*/world.yaml"))
    return [name for name in names if world_solids(load_world(ROOT / "worlds", name))]


def world(name: str) -> Twin:
    """A world's solids at the beginning of their scripts, on its floor."""
    twin = Twin(ground=0.0)
    for solid in world_solids(load_world(ROOT / "worlds", name)):
        if solid.shape == "box":
            twin.box(np.array(solid.size), solid.position, solid.orientation)
        elif solid.shape == "cylinder":
            radius, height = solid.size
            twin.cylinder(radius, height, solid.position, solid.orientation)
        elif solid.shape == "sphere":
            twin.sphere(solid.size[0], solid.position)
        else:
            vertices, faces = load_mesh(solid.mesh)
            vertices = vertices * np.array(solid.size)
            twin.mesh(trimesh.Trimesh(vertices, faces, process=False), solid.position, solid.orientation)
    return twin


def low_places(name: str) -> Floats:
    """(2, 3) m: where scanners of ground vehicles may be in a world, lowest and highest corner."""
    x_min, y_min, x_max, y_max = load_world(ROOT / "worlds", name).floor
    return np.array(((x_min + 0.2, y_min + 0.2, 0.1), (x_max - 0.2, y_max - 0.2, 1.5)))


def mixed() -> Twin:
    """Boxes, cylinders and spheres anyhow, and a ring as concave mesh."""
    rng, twin = np.random.default_rng(11), Twin()
    for _ in range(12):
        pose = (rng.uniform(-3, 3, 3), from_euler(*rng.uniform(-np.pi, np.pi, 3)))
        twin.box(rng.uniform(0.2, 2.0, 3), *pose)
        pose = (rng.uniform(-3, 3, 3), from_euler(*rng.uniform(-np.pi, np.pi, 3)))
        twin.cylinder(rng.uniform(0.1, 0.8), rng.uniform(0.2, 2.0), *pose)
        twin.sphere(rng.uniform(0.1, 0.8), rng.uniform(-3, 3, 3))
    twin.mesh(trimesh.creation.torus(1.5, 0.4, major_sections=24, minor_sections=12), (0.3, -0.2, 0.1), from_euler(0.5, 0.4, 0.0))
    return twin


def meshes() -> Twin:
    """50 000 triangles: a rough bowl round the middle, and rings in it."""
    rng, twin = np.random.default_rng(5), Twin()
    bowl = trimesh.creation.icosphere(subdivisions=5)
    bowl.vertices *= np.array((10.0, 10.0, 3.0)) * rng.uniform(0.95, 1.05, (len(bowl.vertices), 1))
    twin.mesh(bowl, (0.0, 0.0, 0.0))
    ring = trimesh.creation.torus(1.5, 0.4, major_sections=80, minor_sections=31)
    for angle in range(0, 360, 60):
        away = np.deg2rad(angle)
        twin.mesh(ring, (5 * np.cos(away), 5 * np.sin(away), 0.2), from_euler(0.4, 0.3, away))
    return twin
