"""Which of the engine's contacts a vehicle feels: what bears it is none."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.sim_ground.body import Motion, Three, Touch
from uvf.maths.rotations import inverse, rotate
from uvf.models.world.file import TERRAIN

Floats = NDArray[np.float64]

FLOOR = "floor"
GROUND = (FLOOR, TERRAIN)  # names of what one drives on
GAP = 5e-4  # m, at which two bodies touch; the engine leaves a little air
SOLE = 5e-3  # m above the floor, up to which a part is one that the vehicle stands on, and an edge is one of the floor
BEARS = 0.7  # upward share of a contact's normal: steps up to 0.3 of a wheel's radius are driven over


class EngineContact(NamedTuple):
    """A contact of a vehicle. other: the body touched; link: the vehicle's; place (3,) [m, world], normal towards the vehicle.

    gap [m]; load: along the normal in the last step [N].
    """

    other: int
    link: int
    place: Three
    normal: Three
    gap: float
    load: float


class Bodies:
    """The engine's bodies: their names, and which of them never move."""

    def __init__(self) -> None:
        self.names: dict[int, str] = {}
        self.fixed: set[int] = set()

    def remove(self, index: int) -> None:
        """Forgets a body."""
        del self.names[index]
        self.fixed.discard(index)

    def felt(self, contacts: Iterable[EngineContact], soles: frozenset[int], motion: Motion, has_fallen: bool) -> list[Touch]:
        """Everything that a vehicle touches; what it stands on only if it has fallen over. soles: the links with which it stands."""
        near = [c for c in contacts if c.gap <= GAP and (has_fallen or self.names[c.other] not in GROUND)]
        places = [_in_body(motion, c.place) for c in near]
        return [
            Touch(self.names[c.other], float(np.arctan2(p[1], p[0])))
            for c, p in zip(near, places, strict=True)
            if has_fallen or not self._bears(c, soles, p[2])
        ]

    def _bears(self, contact: EngineContact, soles: frozenset[int], height: float) -> bool:
        """Whether a wheel or castor stands on it: a ramp, a platform, the floor of a building, the edge of a carpet."""
        return contact.other in self.fixed and contact.link in soles and (contact.normal[2] >= BEARS or height <= SOLE)


def _in_body(motion: Motion, place: Three) -> Floats:
    """(3,) m, body frame."""
    position, world_from_body, *_ = motion
    return rotate(inverse(world_from_body), np.array(place) - position)
