"""Solids that rays meet: boxes, capped cylinders, spheres and triangles as rows of one table.

A box, cylinder or sphere is the image of a unit solid (cube of half edge 1, cylinder of radius 1 and half height 1 along z, unit
sphere), and its row is the affine map into the unit solid's frame: three rows (m, t) with ``unit = m @ point + t``. An affine map
keeps the parameter along a ray, so every test is done on the unit solid. A triangle's row is its three corners.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from uvf.maths.rotations import IDENTITY, matrix

Floats = NDArray[np.float64]

BOX, CYLINDER, SPHERE, TRIANGLE = 0, 1, 2, 3


class Solids(NamedTuple):
    """Table of n primitives in one frame: kinds (n,) int64, rows (n, 12), and their bounds low, high (n, 3) [m]."""

    kinds: NDArray[np.int64]
    rows: Floats
    low: Floats
    high: Floats


def box(size: ArrayLike, position: ArrayLike, orientation: Floats = IDENTITY) -> Solids:
    """Box of full edges ``size`` (3,) [m], centred at ``position`` (3,) [m], turned by a unit quaternion wxyz (4,).

    Raises ValueError for a size that is not positive or a pose that is not finite.
    """
    half = _positive(size, "box size") / 2
    return _image(BOX, half, position, orientation, np.abs(matrix(orientation)) @ half)


def cylinder(radius: float, height: float, position: ArrayLike, orientation: Floats = IDENTITY) -> Solids:
    """Cylinder with both caps, ``radius`` and ``height`` [m], turned by a unit quaternion wxyz (4,).

    Its axis is the local z, ``position`` (3,) [m] the middle of the axis. Raises ValueError as ``box`` does.
    """
    _positive((radius, height), "cylinder radius and height")
    axis = matrix(orientation)[:, 2]
    reach = np.abs(axis) * height / 2 + radius * np.sqrt(np.maximum(0.0, 1 - axis * axis))
    return _image(CYLINDER, np.array((radius, radius, height / 2)), position, orientation, reach)


def sphere(radius: float, position: ArrayLike) -> Solids:
    """Sphere of ``radius`` [m] round ``position`` (3,) [m]. Raises ValueError as ``box`` does."""
    _positive(radius, "sphere radius")
    return _image(SPHERE, np.full(3, radius), position, IDENTITY, np.full(3, radius))


def mesh(vertices: ArrayLike, faces: ArrayLike, position: ArrayLike = (0.0, 0.0, 0.0), orientation: Floats = IDENTITY) -> Solids:
    """Two-sided triangles: vertices (k, 3) [m] in the mesh's frame, faces (n, 3) their indices.

    Raises ValueError for a face that names no vertex, and for vertices or a pose that are not finite.
    """
    corners = np.asarray(vertices, dtype=np.float64).reshape(-1, 3) @ matrix(orientation).T + np.asarray(position, dtype=np.float64)
    indices = np.asarray(faces, dtype=np.int64).reshape(-1, 3)
    if indices.size and not (indices.min() >= 0 and indices.max() < len(corners)):
        raise ValueError(f"mesh: a face names vertex {indices.max()} or {indices.min()}, of {len(corners)} vertices")
    if not np.isfinite(corners).all():
        raise ValueError("mesh: a vertex or the pose is not finite")
    triangles = corners[indices]
    rows = np.zeros((len(indices), 12))
    rows[:, :9] = triangles.reshape(-1, 9)
    return Solids(np.full(len(indices), TRIANGLE), rows, triangles.min(axis=1), triangles.max(axis=1))


def joined(parts: Sequence[Solids]) -> Solids:
    """All primitives of several tables in one, in their order; an empty table where there are none."""
    empty = Solids(np.zeros(0, dtype=np.int64), np.zeros((0, 12)), np.zeros((0, 3)), np.zeros((0, 3)))
    return Solids(*(np.concatenate(columns) for columns in zip(empty, *parts, strict=True)))


def chosen(parts: Solids, which: NDArray[np.bool_]) -> Solids:
    """The primitives that the mask ``which`` (n,) selects."""
    return Solids(parts.kinds[which], parts.rows[which], parts.low[which], parts.high[which])


def _positive(lengths: ArrayLike, what: str) -> Floats:
    values = np.asarray(lengths, dtype=np.float64)
    if not (np.isfinite(values).all() and (values > 0).all()):
        raise ValueError(f"{what} must be positive and finite, not {values.tolist()}")
    return values


def _image(kind: int, scale: Floats, position: ArrayLike, orientation: Floats, reach: Floats) -> Solids:
    centre = np.asarray(position, dtype=np.float64)
    if not (np.isfinite(centre).all() and np.isfinite(orientation).all()):
        raise ValueError(f"the pose of a solid must be finite, not {centre.tolist()}, {orientation.tolist()}")
    unit_from_world = matrix(orientation).T / scale[:, np.newaxis]
    row = np.column_stack((unit_from_world, -unit_from_world @ centre)).reshape(1, 12)
    return Solids(np.array((kind,), dtype=np.int64), row, (centre - reach)[np.newaxis], (centre + reach)[np.newaxis])
