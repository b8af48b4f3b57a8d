"""Drawing back from what has been touched."""

from math import copysign, hypot

from uvf.maths.kinematics import Twist
from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2
from uvf.planning.costmap.bumps import Bump

SPEED, TURN_RATE = 0.15, 0.8  # m/s, rad/s
FAR_ENOUGH, TURNED_ENOUGH = 0.12, 0.4  # m, rad
LONGEST = 3.0  # s


class Retreat:
    """From one bump. What was touched is not remembered before it is over: the vehicle stands against it, and could not move."""

    def __init__(self, t: float, pose: Pose2, bump: Bump, turns_on_the_spot: bool = True) -> None:
        self.bump = bump
        self._until, self._from = t + LONGEST, pose
        speed, turn_rate = bump.motion
        self._turns = turns_on_the_spot and abs(turn_rate) * FAR_ENOUGH > abs(speed) * TURNED_ENOUGH
        self._way = -copysign(1.0, turn_rate if self._turns else float(bump.points[:, 0].mean()))

    def wanted(self) -> Twist:
        """Velocity."""
        return Twist(0.0, self._way * TURN_RATE) if self._turns else Twist(self._way * SPEED, 0.0)

    def is_over(self, t: float, pose: Pose2) -> bool:
        """Whether the vehicle is off, or cannot get off."""
        moved = hypot(pose[0] - self._from[0], pose[1] - self._from[1])
        return t >= self._until or moved >= FAR_ENOUGH or (self._turns and abs(wrap(pose[2] - self._from[2])) >= TURNED_ENOUGH)
