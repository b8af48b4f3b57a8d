"""Mass and inertia of several links as one body."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import matrix
from uvf.maths.se3 import Transform, apply
from uvf.models.urdf.robot import Inertial, UrdfModel

Floats = NDArray[np.float64]


def moved(inertial: Inertial, a_from_b: Transform) -> Inertial:
    """The same inertial seen from frame a."""
    turn = matrix(a_from_b.rotation)
    return Inertial(inertial.mass, apply(a_from_b, inertial.com[None])[0], turn @ inertial.inertia @ turn.T)


def joined(parts: Sequence[Inertial]) -> Inertial | None:
    """Several inertials of one frame as one (Steiner's theorem); None of none."""
    mass = sum(p.mass for p in parts)
    if not parts or mass <= 0:
        return None
    com: Floats = sum((p.mass * p.com for p in parts), np.zeros(3)) / mass
    inertia = np.zeros((3, 3))
    for part in parts:
        arm = part.com - com
        inertia += part.inertia + part.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return Inertial(mass, com, inertia)


def whole(model: UrdfModel, poses: Mapping[str, Transform]) -> Inertial | None:
    """All links of these poses as one inertial; None where the model states no mass."""
    links = [link for name, link in model.links.items() if name in poses]
    return joined([moved(link.inertial, poses[link.name]) for link in links if link.inertial is not None])
