"""A SLAM method fed with the odometry of the moment at which each sweep was really taken."""

from collections import deque
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from uvf.estimation.odometry.time_skew import Skew, TimeSkew
from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2
from uvf.slam.logs.laser_log import OdometryTrack
from uvf.slam.method import Keyframe, SlamEstimate, SlamMethod
from uvf.slam.reading import Reading

Floats = NDArray[np.float64]

CERTAIN = 4.0
"""Sigmas from zero at which a skew is believed."""
WORTH = 0.03  # s, a smaller one is not worth the interpolation
FITS = 0.5  # least quality of an estimate whose turn is compared with the odometry's
TURNING = 0.01  # rad between two sweeps from which on a turn tells the two odometries apart
LEAST_TURNS, KEPT = 30, 200
BETTER = 0.9
"""What the median error of the shifted odometry's turns may be of the own one's: a log whose stamps are wrong is better left alone."""


class Synchronised:
    """Learns the skew between the stamps of sweeps and odometry while the method runs, and takes it off.

    track: the odometry by its own stamps, as far as it is known.
    """

    def __init__(self, method: SlamMethod, track: OdometryTrack) -> None:
        self.method = method
        self._t = track.t
        self._poses = np.column_stack((track.odom_from_base[:, :2], np.unwrap(track.odom_from_base[:, 2])))
        self._fed = 0
        self._skew = TimeSkew()
        self._last: tuple[Reading, float] | None = None
        self._errors: deque[tuple[float, float]] = deque(maxlen=KEPT)
        self._shifts = False

    @property
    def shifts(self) -> bool:
        """Whether the skew is taken off."""
        return self._shifts

    @property
    def skew(self) -> Skew:
        """Skew between sweeps and odometry as estimated so far."""
        return self._skew.estimate()

    def add(self, reading: Reading) -> SlamEstimate:
        """Feeds the method with a reading whose odometry is that of the sweep's true time, and learns the skew."""
        end = int(np.searchsorted(self._t, reading.t, side="right"))
        for t, (_, _, heading) in zip(self._t[self._fed : end].tolist(), self._poses[self._fed : end].tolist(), strict=True):
            self._skew.add_odometry(t, heading)
        self._fed = max(self._fed, end)
        estimate = self.method.add(self._corrected(reading))
        self._learn(reading, estimate)
        return estimate

    def trajectory(self) -> Floats:
        """Poses map_from_base (readings, 3) [m, m, rad], as the method has them."""
        return self.method.trajectory()

    def keyframes(self) -> Iterator[Keyframe]:
        """The method's keyframes."""
        return self.method.keyframes()

    def keyframe_count(self) -> int:
        """Number of the method's keyframes."""
        return self.method.keyframe_count()

    def finish(self) -> None:
        """Lets the method do the work that it had put off."""
        self.method.finish()

    def _corrected(self, reading: Reading) -> Reading:
        """Beyond the ends of the track the sweep's own odometry has to do."""
        taken = reading.t + self.skew.seconds
        if not (self._shifts and self._t[0] <= taken <= self._t[-1]):
            return reading
        x, y, yaw = (float(np.interp(taken, self._t, column)) for column in self._poses.T)
        return replace(reading, odom_from_base=Pose2(x, y, yaw))

    def _learn(self, reading: Reading, estimate: SlamEstimate) -> None:
        """From the turn since the last sweep, if both have fitted."""
        last, self._last = self._last, None
        if estimate.quality < FITS:
            return
        yaw = estimate.map_from_base.yaw
        if last is not None:
            self._compare(last[0], reading, wrap(yaw - last[1]))
        self._last = (reading, yaw)

    def _compare(self, before: Reading, after: Reading, turn: float) -> None:
        self._skew.add_turn(before.t, after.t, turn)
        skew = self.skew
        certain = abs(skew.seconds) > max(WORTH, CERTAIN * skew.sigma)
        if certain and abs(turn) > TURNING:
            shifted = np.diff(np.interp((before.t + skew.seconds, after.t + skew.seconds), self._t, self._poses[:, 2]))
            own = after.odom_from_base.yaw - before.odom_from_base.yaw
            self._errors.append((abs(wrap(turn - float(shifted[0]))), abs(wrap(turn - own))))
        if len(self._errors) >= LEAST_TURNS:
            by_shifted, by_own = np.median(self._errors, axis=0)
            self._shifts = certain and bool(by_shifted < BETTER * by_own)
