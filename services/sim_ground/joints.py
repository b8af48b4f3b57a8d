"""Joints of a vehicle beside those of its wheels: drives that follow what they are told, and springs."""

from collections.abc import Mapping, Sequence

from services.sim_ground.engine import JointMotion
from uvf.control.drive_limits import approach
from uvf.models.vehicle.joints import MovedJoint, Spring


class JointDrives:
    """Go to where they are told as fast as they can, within their range; one that is told nothing stays where it is."""

    def __init__(self, joints: Sequence[int], drives: Mapping[str, MovedJoint]) -> None:
        """joints: their numbers, in the order of ``drives``."""
        self.joints = tuple(joints)
        self.efforts = [drive.effort for drive in drives.values()]
        self.positions = [0.0] * len(drives)
        """At which they are held [rad or m] if their efforts are enough."""
        self._drives = dict(drives)

    def lead(self, wanted: Mapping[str, float], dt: float) -> list[float]:
        """Positions to hold them at ``dt`` [s] later."""
        for i, (name, drive) in enumerate(self._drives.items()):
            target = drive.within(wanted.get(name, self.positions[i]))
            self.positions[i] = approach(self.positions[i], target, drive.speed * dt)
        return self.positions


class Springs:
    """Push their joints back; a joint's own range ends it."""

    def __init__(self, joints: Sequence[int], springs: Sequence[Spring]) -> None:
        self.joints = tuple(joints)
        self._springs = tuple(springs)

    def efforts(self, motions: Sequence[JointMotion], dt: float) -> list[float]:
        """N m or N of each, at where it will be ``dt`` [s] later."""
        return [
            spring.stiffness * (spring.rest - joint.angle - joint.speed * dt) - spring.damping * joint.speed
            for spring, joint in zip(self._springs, motions, strict=True)
        ]
