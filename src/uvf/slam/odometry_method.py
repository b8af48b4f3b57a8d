"""The odometry as it is, in the shape of a SLAM method: the row that every other one is compared with."""

from math import hypot

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import wrap
from uvf.maths.se2 import IDENTITY, Pose2, compose, inverse
from uvf.models.params import Params
from uvf.slam.incremental import IncrementalMethod
from uvf.slam.method import Keyframe, SlamEstimate
from uvf.slam.reading import Reading

Floats = NDArray[np.float64]

SPACING, TURN = 0.25, 0.25
"""m and rad between readings that the map is drawn from."""
DRIFT = (0.05, 0.02, 0.1)
"""1 sigma of a small vehicle on wheels: m per m^1/2 driven, rad per m^1/2 driven, rad per rad^1/2 turned."""


class OdometryMethodParams(Params, frozen=True):
    """Parameters of ``OdometryMethod``: it has none."""


class OdometryMethod(IncrementalMethod):
    """The odometry's pose as a SLAM method; its uncertainty grows with the way, its quality is 0, for nothing is checked."""

    def __init__(self, params: OdometryMethodParams) -> None:
        super().__init__()
        self._base_from_odom: Pose2 = IDENTITY
        self._driven = self._turned = 0.0

    def add(self, reading: Reading) -> SlamEstimate:
        """Takes over the odometry's pose, relative to that of the first reading."""
        if not self._poses:
            self._base_from_odom = inverse(reading.odom_from_base)
        pose = compose(self._base_from_odom, reading.odom_from_base)
        if self._poses:
            before = self._poses[-1]
            self._driven += hypot(pose.x - before.x, pose.y - before.y)
            self._turned += abs(wrap(pose.yaw - before.yaw))
        self._poses.append(pose)
        if self._has_moved(SPACING, TURN):
            self._keyframes.append(Keyframe(pose, reading))
        return SlamEstimate(pose, self._covariance(), 0.0)

    def _covariance(self) -> Floats:
        along, heading = DRIFT[0] ** 2 * self._driven, DRIFT[1] ** 2 * self._driven + DRIFT[2] ** 2 * self._turned
        across = along + heading * self._driven**2 / 3.0
        return np.diag((across, across, heading))
