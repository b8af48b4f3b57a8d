"""A foreign body while it is rebuilt: what is there, and what became of it."""

from dataclasses import dataclass

from uvf.maths.se3 import Transform
from uvf.models.importing.driving.drive_wheels import DriveWheels
from uvf.models.importing.inertia_guess import mended
from uvf.models.importing.robot import Foreign
from uvf.models.urdf.robot import Inertial, Joint, Link, UrdfModel
from uvf.models.urdf.rules import RESERVED, inertial_faults

BASE = "base_link"
LIGHT = 0.01  # kg, of a moving part that weighs nothing in the file


@dataclass
class Parts:
    """The model in base_link: base_from_link of every link, and what became of them."""

    model: UrdfModel
    wheels: DriveWheels
    poses: dict[str, Transform]
    links: dict[str, Link]
    joints: dict[str, Joint]

    def fast_on(self, link: str) -> list[Joint]:
        """The joints with which others hang fast on a link of the rebuilt model."""
        return [joint for joint in self.joints.values() if joint.parent == link and joint.kind == "fixed"]


def sound_inertial(link: Link, foreign: Foreign) -> Inertial | None:
    """What a link tells of its mass, its inertia replaced where that is impossible; None where it tells nothing."""
    told = link.inertial
    if told is None or told.mass <= 0:
        return None
    return mended(link, True, foreign.notes).inertial if any(inertial_faults(told)) else told


def new_name(name: str, parts: Parts) -> str:
    """What a link is called in the rebuilt model: letters that all take, and no name twice."""
    clean = "".join(c if c.isalnum() or c in "_.-" else "_" for c in name).strip("_") or "link"
    return clean if clean not in (*parts.links, *RESERVED) else f"{clean}_{len(parts.links)}"
