"""Random scenes for the tests of rays and floor plans."""

import numpy as np
import trimesh

from uvf.maths.rotations import from_euler
from uvf.maths.solids import box, cylinder, mesh, sphere


def turn(rng):
    return from_euler(*rng.uniform(-np.pi, np.pi, 3))


def torus(major_sections=24, minor_sections=12):
    """Vertices and faces of a concave mesh: a ring of radius 1.5 m, 0.4 m thick, its axis z."""
    ring = trimesh.creation.torus(1.5, 0.4, major_sections=major_sections, minor_sections=minor_sections)
    return np.asarray(ring.vertices), np.asarray(ring.faces)


def random_parts(rng, each=6, reach=5.0):
    """``each`` boxes, cylinders and spheres anyhow, and one torus in the middle."""
    parts = [mesh(*torus(), rng.uniform(-1, 1, 3), turn(rng))]
    for _ in range(each):
        parts.append(box(rng.uniform(0.2, 2.0, 3), rng.uniform(-reach, reach, 3), turn(rng)))
        parts.append(cylinder(rng.uniform(0.1, 0.8), rng.uniform(0.2, 2.0), rng.uniform(-reach, reach, 3), turn(rng)))
        parts.append(sphere(rng.uniform(0.1, 0.8), rng.uniform(-reach, reach, 3)))
    return parts


def random_directions(rng, n):
    directions = rng.normal(size=(n, 3))
    return directions / np.linalg.norm(directions, axis=1, keepdims=True)
