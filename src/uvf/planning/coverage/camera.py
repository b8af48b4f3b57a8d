"""How far apart swaths and pictures of an aerial survey lie: the footprint of a camera that looks straight down on level ground.

Footprint = height * sensor size / focal length, spacing = footprint * (1 - overlap): Kraus, "Photogrammetry", 2nd ed., 2007, section 3.
"""

import math
from dataclasses import dataclass

MOST_OVERLAP = 0.95


@dataclass(frozen=True)
class SurveyCamera:
    """Field of view of a camera that looks straight down: ``across`` and ``along`` the swath [rad], whole angles."""

    across: float
    along: float

    def __post_init__(self) -> None:
        """Raises ValueError for angles that are none of a camera."""
        for name, angle in (("across", self.across), ("along", self.along)):
            if not 0.0 < angle < math.pi:
                raise ValueError(f"a field of view {name} the swath of {angle:g} rad; give more than 0 and less than pi")

    @classmethod
    def from_sensor(cls, width: float, height: float, focal_length: float) -> "SurveyCamera":
        """From a sensor's ``width``, which lies across the swath, and ``height``, and the focal length, all in one unit."""
        for name, value in (("sensor width", width), ("sensor height", height), ("focal length", focal_length)):
            if not 0.0 < value < math.inf:
                raise ValueError(f"a {name} of {value:g}; give a positive number, in mm as the others")
        return cls(2 * math.atan(width / (2 * focal_length)), 2 * math.atan(height / (2 * focal_length)))

    def footprint(self, height: float) -> tuple[float, float]:
        """Size [m] of the picture on the ground, across and along the swath, from ``height`` [m] above it. Raises ValueError."""
        if not 0.0 < height < math.inf:
            raise ValueError(f"a height of {height:g} m above the ground; give a positive one")
        return 2 * height * math.tan(self.across / 2), 2 * height * math.tan(self.along / 2)

    def spacing(self, height: float, sidelap: float) -> float:
        """Distance [m] between swaths whose pictures overlap by ``sidelap`` [0..0.95]. Raises ValueError."""
        return self.footprint(height)[0] * (1.0 - _overlap(sidelap, "sidelap"))

    def trigger_distance(self, height: float, frontlap: float) -> float:
        """Distance [m] over ground between pictures that overlap by ``frontlap`` [0..0.95]. Raises ValueError."""
        return self.footprint(height)[1] * (1.0 - _overlap(frontlap, "frontlap"))


def _overlap(value: float, name: str) -> float:
    if not 0.0 <= value <= MOST_OVERLAP:
        raise ValueError(f"a {name} of {value:g}; give a share of the picture from 0 to {MOST_OVERLAP:g}, such as 0.7")
    return value
