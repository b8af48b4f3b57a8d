"""How far the odometry may be off after a motion."""

from dataclasses import dataclass
from math import hypot

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import Pose2

Floats = NDArray[np.float64]

LEAST, LEAST_TURN = 0.01, 0.005  # m, rad: what no motion at all may be off by


@dataclass(frozen=True)
class MotionModel:
    """1 sigma of the odometry in proportion to the motion, by the names of gmapping's parameters.

    srr: [m/m]; srt: [m/rad]; str_: [rad/m]; stt: [rad/rad].
    """

    srr: float
    srt: float
    str_: float
    stt: float

    def covariance(self, motion: Pose2) -> Floats:
        """Covariance (3, 3) of (x, y, yaw) [m, rad], the same in every frame: no direction is surer than another."""
        way, turn = hypot(motion.x, motion.y), abs(motion.yaw)
        position = LEAST + self.srr * way + self.srt * turn
        heading = LEAST_TURN + self.str_ * way + self.stt * turn
        return np.diag((position**2, position**2, heading**2))
