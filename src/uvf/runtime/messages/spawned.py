"""What has been put into the running simulation, as its message tells it, and what cannot be."""

import math
import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

from schemas.limits import VEHICLE
from schemas.messages import Pose, SimObject, SimObjects
from schemas.topics import SYSTEM
from uvf.models.shapes.solid import Solid
from uvf.models.yaml_data import nearest
from uvf.runtime.messages.convert import array, wxyz

GREY = (0.6, 0.6, 0.6)


NAME = re.compile(VEHICLE)
FARTHEST = 1e5  # m
SIZES = {"box": 3, "cylinder": 2, "sphere": 1}
LARGEST, HEAVIEST = 100.0, 1e5  # m, kg
SPAWNED_MOST = 256
"""Things in both simulators together; as many as the page shows, and fewer than their message can hold."""


def name_fault(name: str) -> str:
    """Why nothing can have this name; empty = it may."""
    if not NAME.fullmatch(name) or name == SYSTEM:
        return f"{name[:60]!a} is no name: small letters, digits and _, a letter first, 40 at most"
    return ""


def crowd_fault(there: int) -> str:
    """Why nothing more can be put in beside ``there`` others; empty = it can."""
    return f"{there} things are there already, {SPAWNED_MOST} at most: remove some first" if there >= SPAWNED_MOST else ""


def pose_fault(pose: Pose) -> str:
    """Why nothing can be put at this pose; empty = it may."""
    numbers = (*array(pose.position), *wxyz(pose.orientation))
    if not all(math.isfinite(x) and abs(x) <= FARTHEST for x in numbers):
        return f"the pose must be of finite numbers, positions within {FARTHEST:g} m of the world's origin"
    if np.linalg.norm(wxyz(pose.orientation)) < 0.1:
        return "the pose's orientation must be a unit quaternion, or left out"
    return ""


def shape_fault(told: SimObject) -> str:
    """Why nothing has the shape that the message tells of; empty = it may."""
    if told.shape not in SIZES:
        return f"there is no shape {told.shape[:60]!a}; {nearest(told.shape, SIZES)}"
    if len(told.size) != SIZES[told.shape]:
        return f"a {told.shape} has {SIZES[told.shape]} measures [m], not {len(told.size)}"
    if not all(1e-3 <= side <= LARGEST for side in told.size):
        return f"the measures of a {told.shape} must be 0.001 to {LARGEST:g} m"
    return "" if 0.0 <= told.mass <= HEAVIEST else f"the mass must be 0 (it stands fast) to {HEAVIEST:g} kg"


def body_fault(told: SimObject) -> str:
    """Why nothing like it, whatever its name, can be in a simulation; empty = it can."""
    return pose_fault(told.pose) or ("" if told.model else shape_fault(told))


def object_fault(told: SimObject) -> str:
    """Why the object of the message cannot be in a simulation; empty = it can."""
    return name_fault(told.name) or body_fault(told)


def sound_objects(*lists: SimObjects | None) -> list[SimObject]:
    """Objects that can be in a simulation, of all that simulators tell of."""
    return [one for told in lists if told is not None for one in told.objects if not object_fault(one)]


def solid_of(told: SimObject) -> Solid:
    """Solid of an object that is no vehicle, where it stands in the world."""
    shape: Any = told.shape
    colour = (told.color.r, told.color.g, told.color.b) if told.HasField("color") else GREY
    return Solid(told.name, shape, tuple(told.size), array(told.pose.position), unit_wxyz(told.pose), colour)


def unit_wxyz(pose: Pose) -> NDArray[np.float64]:
    """Attitude of a pose as a unit quaternion wxyz (4,)."""
    q = wxyz(pose.orientation)
    return q / float(np.linalg.norm(q))
