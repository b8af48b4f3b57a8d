"""Inertia that a file lacks or that no body can have, guessed from the shapes."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from uvf.models.importing.notes import Notes
from uvf.models.shapes.mesh import triangles
from uvf.models.shapes.solid import Solid
from uvf.models.urdf.robot import Inertial, Link
from uvf.models.urdf.rules import inertial_faults

Floats = NDArray[np.float64]

DENSITY = 300.0  # kg/m^3 of the box about a part: shells, boards, batteries and air
LIGHTEST = 0.005  # kg
FAR = 2.0  # of the shape's largest side: a radius of gyration beyond that is a figure of no body


def mended(link: Link, is_body: bool, notes: Notes) -> Link:
    """The link with an inertia that is physically possible; frames without shapes stay without mass. is_body: it must weigh something."""
    solids = link.collisions or link.visuals
    if not solids:
        return replace(link, inertial=None) if link.inertial is not None and any(inertial_faults(link.inertial)) else link
    low, high = _bounds(solids)
    sides = np.maximum(high - low, 1e-3)
    given = link.inertial
    if given is None and not link.collisions and not is_body:
        return link  # only looks
    if given is not None and given.mass > 0 and not any(inertial_faults(given)) and _radius(given) <= FAR * sides.max():
        return link
    mass = given.mass if given is not None and given.mass > 0 else max(DENSITY * float(np.prod(sides)), LIGHTEST)
    if given is None or given.mass <= 0:
        notes.add("masses guessed from the size of the shapes; weigh them", f"{link.name} {mass:.3g} kg")
    else:
        notes.add("inertia that no such body has, replaced by that of its box", link.name)
    x, y, z = sides
    tensor = mass / 12 * np.diag((y * y + z * z, x * x + z * z, x * x + y * y))
    com = given.com if given is not None and given.mass > 0 and _inside(given.com, low, high) else (low + high) / 2
    return replace(link, inertial=Inertial(mass, com, tensor))


def _bounds(solids: tuple[Solid, ...]) -> tuple[Floats, Floats]:
    corners = np.vstack([triangles(s)[0] for s in solids])
    return corners.min(axis=0), corners.max(axis=0)


def _radius(inertial: Inertial) -> float:
    return float(np.sqrt(np.linalg.eigvalsh(inertial.inertia)[-1] / inertial.mass))


def _inside(point: Floats, low: Floats, high: Floats) -> bool:
    return bool((point >= low - 0.02).all() and (point <= high + 0.02).all())
