"""Does the vehicle get on? Checks that do not cry wolf: turning counts as moving, and standing on purpose does not count at all."""

from dataclasses import dataclass
from math import hypot

from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2


@dataclass(frozen=True)
class ProgressSettings:
    """Nav2's SimpleProgressChecker and PoseProgressChecker, and the oscillation check of move_base."""

    required_movement_radius: float = 0.25  # m
    required_movement_angle: float = 0.6  # rad
    movement_time_allowance: float = 4.0  # s
    time_allowance_after_reset: float = 1.5  # s: what was forgotten helps at once or not at all
    oscillation_time: float = 15.0  # s in which the way to go must become shorter
    oscillation_distance: float = 0.4  # m by which it must


class ProgressChecker:
    """Tells when the vehicle has stood where it should move, and when it has moved for long without getting nearer."""

    def __init__(self, settings: ProgressSettings) -> None:
        self.settings = settings
        self._moved_at: float | None = None
        self._allowance = settings.movement_time_allowance
        self._place = Pose2(0.0, 0.0, 0.0)
        self._nearest = float("inf")
        self._nearer_at = 0.0

    def reset(self, t: float, pose: Pose2, allowance: float | None = None) -> None:
        """Begins to look at ``t`` [s]: after a new goal, a recovery, or a hold. allowance: time to move [s], None = the usual one."""
        self._moved_at, self._place = t, pose
        self._allowance = self.settings.movement_time_allowance if allowance is None else allowance
        self._nearest, self._nearer_at = float("inf"), t

    def look(self, t: float, pose: Pose2, way_to_go: float) -> None:
        """Takes where the vehicle is at ``t`` [s], and how far it has to go [m]."""
        s = self.settings
        if self._moved_at is None:
            self.reset(t, pose)
        moved = hypot(pose[0] - self._place[0], pose[1] - self._place[1]) >= s.required_movement_radius
        if moved or abs(wrap(pose[2] - self._place[2])) >= s.required_movement_angle:
            self._moved_at, self._place = t, pose
            self._allowance = s.movement_time_allowance
        if way_to_go <= self._nearest - s.oscillation_distance:
            self._nearest, self._nearer_at = way_to_go, t

    def new_way(self, t: float) -> None:
        """Another path leads to the goal, whose length cannot be compared with the old one's; it is given its time from ``t`` [s] on."""
        self._nearest, self._nearer_at = float("inf"), t

    def is_standing(self, t: float) -> bool:
        """Whether it has not moved for longer than allowed."""
        return self._moved_at is not None and t - self._moved_at > self._allowance

    def is_oscillating(self, t: float) -> bool:
        """Whether it has moved for longer than allowed without getting nearer."""
        return t - self._nearer_at > self.settings.oscillation_time
