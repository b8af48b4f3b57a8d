"""When the camera is triggered on a mission: once, or each time a distance has been flown."""

import math

from uvf.guidance.flight_plan import ItemKind, PlanItem
from uvf.guidance.vector_field import Point


class CameraTrigger:
    """Counts the pictures to take; ``last`` is the place of the latest, north and east [m]."""

    def __init__(self) -> None:
        self.pictures = 0
        self.last: Point | None = None
        self._distance = 0.0  # m, 0 = only when told
        self._due = False

    def obey(self, item: PlanItem) -> None:
        """Takes an item of the mission that triggers the camera; the picture is taken with the next step."""
        self._due = True
        if item.kind is ItemKind.TRIGGER_DISTANCE:
            self._distance = item.distance
            self._due = item.distance > 0

    def stop(self) -> None:
        """Ends triggering by distance, and drops a picture that is due."""
        self._distance, self._due = 0.0, False

    def step(self, position: Point) -> None:
        """Takes a picture at ``position`` (north, east [m]) if one is due or the distance from the latest one is reached."""
        far = self.last is not None and 0 < self._distance <= math.dist(position, self.last)
        if self._due or far:
            self._due = False
            self.pictures += 1
            self.last = position
