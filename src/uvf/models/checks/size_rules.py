"""Measures and masses that no ground vehicle has: of files in millimetres or grams."""

from collections.abc import Iterable, Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se3 import IDENTITY, Transform
from uvf.models.shapes.mesh import placed, reach
from uvf.models.urdf.robot import Link, ModelFault, UrdfModel

LARGEST = 20.0  # m
HEAVIEST = 20_000.0  # kg/m^3 of the box about a link: of gold
SMALLEST = 1e-6  # m^3, below which a box is that of a sheet
SIDES: NDArray[np.float64] = np.vstack((np.eye(3), -np.eye(3)))


def size_faults(model: UrdfModel, poses: Mapping[str, Transform]) -> Iterator[str]:
    """A vehicle larger than any, and links that are heavier than their measures allow."""
    whole = _box(model, poses, poses)
    if whole is not None:
        longest = float((whole[0] - whole[1]).max())
        if longest > LARGEST:
            yield f"{model.path}: the vehicle is {longest:.4g} m across; give metres (if these are millimetres: {longest / 1000:.4g} m)"
    for name in poses:
        yield from _heavy(model, model.links[name], poses)


def _heavy(model: UrdfModel, link: Link, poses: Mapping[str, Transform]) -> Iterator[str]:
    """Where what is fast to a link tells no mass, its own is that of all of them."""
    extents = _extents(link, IDENTITY)
    if link.inertial is None or extents is None or not _is_too_heavy(link.inertial.mass, extents):
        return
    fast = [name for name in model.rigid_with(link.name) if name in poses]
    body = _box(model, fast, poses) if all(model.links[name].inertial is None for name in fast if name != link.name) else None
    if body is None or _is_too_heavy(link.inertial.mass, body):
        box = f"in a box of {1000 * float(np.prod(extents[0] - extents[1])):.3g} l"
        what = f"link '{link.name}' weighs {link.inertial.mass:.4g} kg {box}, more than gold would; give kilograms"
        yield str(ModelFault(model.path, link.line, what))


def _is_too_heavy(mass: float, extents: tuple[NDArray[np.float64], NDArray[np.float64]]) -> bool:
    """Whether a mass [kg] is more than that of the heaviest in a box, by its highest and lowest corner (3,) [m]; not of a sheet."""
    volume = float(np.prod(extents[0] - extents[1]))
    return volume > SMALLEST and mass > HEAVIEST * volume


def _box(model: UrdfModel, names: Iterable[str], poses: Mapping[str, Transform]) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Highest and lowest corner (3,) [m, base_link] of the box about some links; None where they have no shapes."""
    found = [extents for name in names if (extents := _extents(model.links[name], poses[name])) is not None]
    return (np.max([high for high, _ in found], axis=0), np.min([low for _, low in found], axis=0)) if found else None


def _extents(link: Link, frame_from_link: Transform) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Highest and lowest corner (3,) [m] of the box about a link's shapes; None where it has none."""
    solids = [placed(solid, frame_from_link) for solid in (*link.collisions, *link.visuals)]
    if not solids:
        return None
    found = np.max([reach(solid, SIDES) for solid in solids], axis=0)
    return found[:3], -found[3:]
