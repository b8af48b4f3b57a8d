"""The course on which flight accuracy is judged: twelve legs with turns both ways, a climb and a descent, then two circles.

Lengths are those flown at 22 m/s; for another cruise speed V all of them grow with (V / 22 m/s)^2, as radii of turns do.
"""

from dataclasses import dataclass
from math import cos, pi, radians, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

DESIGN_SPEED = 22.0  # m/s
LOW, HIGH = 100.0, 150.0  # m
FIRST = (900.0, 0.0)  # m north and east: where the first leg begins
LEGS = (  # deg heading, m length, m height at its end
    (60, 500, LOW),
    (150, 450, LOW),
    (100, 400, LOW),
    (220, 600, HIGH),
    (180, 500, HIGH),
    (270, 500, HIGH),
    (330, 450, LOW),
    (240, 400, LOW),
    (300, 550, LOW),
    (30, 600, LOW),
    (345, 450, LOW),
    (75, 500, LOW),
)
CIRCLES = ((1241.2, -49.4, 80.0), (891.2, -49.4, -80.0))  # m north, east, radius: positive clockwise
TURNS = 3
ENTRY, EXIT = 150.0, 100.0  # m of a leg that belong to its turns


@dataclass(frozen=True)
class Course:
    """For one cruise speed. North, east, height in m.

    rise: of the legs that climb, where the aircraft cannot climb as steeply as the design's; glide: slope down of all of it, for one
    without an engine.
    """

    speed: float  # m/s
    rise: float | None = None  # m
    glide: float = 0.0  # rad

    @property
    def scale(self) -> float:
        """Lengths of the course over those flown at DESIGN_SPEED."""
        return (self.speed / DESIGN_SPEED) ** 2

    @property
    def corners(self) -> Floats:
        """(13, 3): the first leg's begin and the end of each."""
        points, far, rise = [(*FIRST, LOW)], FIRST[0], HIGH - LOW if self.rise is None else self.rise / self.scale
        for heading, length, height in LEGS:
            (north, east, _), far = points[-1], far + length
            above = LOW + rise * (height - LOW) / (HIGH - LOW) - self.glide * far
            points.append((north + length * cos(radians(heading)), east + length * sin(radians(heading)), above))
        return self.scale * np.array(points) + (0.0, 0.0, self.spare)

    @property
    def spare(self) -> float:
        """Height [m] that is glided down from."""
        return 2.0 * self.glide * self.scale * (FIRST[0] + sum(length for _, length, _ in LEGS) + 2 * TURNS * 2 * pi * CIRCLES[0][2])

    @property
    def circles(self) -> Floats:
        """(2, 3): north and east of the centre, radius."""
        return self.scale * np.array(CIRCLES)

    def mission(self) -> dict[str, Any]:
        """start and job of a vehicle in a mission file: in level flight to the north, on the line to the first leg."""
        low = float(self.corners[-1, 2])
        items: list[dict[str, Any]] = [{"x": e, "y": n, "z": h} for n, e, h in self.corners.tolist()]
        items += [{"kind": "orbit", "x": e, "y": n, "z": low, "radius": r, "turns": TURNS} for n, e, r in self.circles.tolist()]
        start = {"x": 0.0, "y": 0.0, "z": float(self.corners[0, 2]), "yaw": np.pi / 2, "speed": self.speed}
        return {"start": start, "job": {"mission": items}}
