"""Where the vehicle is in the world: through the map's correction, or by a second filter that satellites and map correct."""

import numpy as np
from numpy.typing import NDArray

from uvf.estimation.kalman import Measured
from uvf.estimation.odometry.filter import DriveFilter
from uvf.estimation.odometry.satellites import Antenna, SatelliteFix, Satellites
from uvf.estimation.odometry.slip import sigma
from uvf.estimation.odometry.states import HEADING, POSE
from uvf.maths.geodesy import LocalTangent
from uvf.maths.rotations import wrap
from uvf.maths.se2 import IDENTITY, Pose2, compose, interpolate, inverse
from uvf.models.vehicle.sensors import GnssSensor

Floats = NDArray[np.float64]

MATCHED = 1e-6  # m or rad by which a correction must change to come from a new match
MAP_PERIOD = 1.0  # s between two corrections that count against satellites: those between tell the same
MAP_HEADING = 0.02  # rad, 1 sigma
MAP_GATE = 16.3  # chi-square of three degrees of freedom, 99.9 %
UNKNOWN = 0.25  # m, by which sigma may grow without a match
JUMP = 2.0  # m, from which on the pose shown jumps instead of creeping


class MapPose:
    """Pose of the odometry in map and world, by the map's newest correction."""

    def __init__(self, world_from_map: Pose2) -> None:
        self.world_from_map = world_from_map
        self.map_from_odom: Pose2 = IDENTITY
        self._variance_then = 0.0

    def correct(self, newest: Pose2, covariance: Floats) -> bool:
        """Takes a correction map_from_odom; whether it comes from a new match.

        covariance: (n, n) of the odometry's state, the position [m^2] first.
        """
        x, y, yaw = self.map_from_odom
        change = max(abs(newest.x - x), abs(newest.y - y), abs(wrap(newest.yaw - yaw)))
        self.map_from_odom = newest
        if change > MATCHED:
            self._variance_then = _worse(covariance)
        return change > MATCHED

    def map_from(self, odom_from_base: Pose2) -> Pose2:
        """Pose map_from_base of an ``odom_from_base``."""
        return compose(self.map_from_odom, odom_from_base)

    def world_from(self, odom_from_base: Pose2) -> Pose2:
        """Pose world_from_base of an ``odom_from_base``."""
        return compose(self.world_from_map, self.map_from(odom_from_base))

    def is_known(self, covariance: Floats) -> bool:
        """Whether scans have been matched before the odometry could drift far; the start counts as a match.

        covariance: (n, n) of the odometry's state, the position [m^2] first.
        """
        return _worse(covariance) - self._variance_then < UNKNOWN**2

    def sigma(self, covariance: Floats, of_map: float) -> float:
        """1 sigma [m] of the position: ``of_map`` [m] of a pose just corrected, and what the odometry has drifted since.

        covariance: (n, n) of the odometry's state, the position [m^2] first.
        """
        return float(np.sqrt(of_map**2 + max(_worse(covariance) - self._variance_then, 0.0)))


class SatellitePose:
    """A filter of its own with its pose in the world; the pose that is shown follows it slowly, as controllers want it."""

    def __init__(self, drive: DriveFilter, gnss: GnssSensor, tangent: LocalTangent, start: tuple[Pose2, float, float]) -> None:
        """start: pose in the world, and 1 sigma of its position [m] and heading [rad]."""
        self.drive = drive
        drive.place(start[0], start[1:])
        self._satellites = Satellites(tangent, Antenna((gnss.mount.xyz[0], gnss.mount.xyz[1]), gnss.horizontal_drift), start[2])
        self._world_from_odom: Pose2 | None = None
        self._mapped = -np.inf

    def note(self, t: float, odom_from_base: Pose2) -> None:
        """Stores the odometry's pose after the filter's last step, at ``t`` [s]."""
        self._satellites.note(t, odom_from_base)

    def take(self, fixes: list[SatelliteFix], odom_from_base: Pose2) -> None:
        """Corrects by satellite fixes; after the first, if it is used, the pose shown jumps to the filter's."""
        for fix in fixes:
            first = not self._satellites.placed
            if self._satellites.take(fix, self.drive, odom_from_base) and first:
                self._world_from_odom = None

    def mapped(self, t: float, world_from_base: Pose2, sigma: float) -> None:
        """Corrects by a pose on the map at ``t`` [s], a map that may have drifted by ``sigma`` [m]."""
        if not self._satellites.placed or t - self._mapped < MAP_PERIOD:
            return
        self._mapped = t
        x = self.drive.state
        heading = x[HEADING] + wrap(world_from_base.yaw - x[HEADING])
        h = np.eye(3, len(x))
        noise = np.diag((sigma**2, sigma**2, MAP_HEADING**2))
        self.drive.correct(Measured(np.array((world_from_base.x, world_from_base.y, heading)), lambda p: p[POSE], h, noise), MAP_GATE)

    def shown(self, odom_then: Pose2, odom_from_base: Pose2, reach: float) -> Pose2:
        """Pose world_from_base to publish for ``odom_from_base``; ``odom_then`` is the odometry's pose at the filter's last step.

        It moves towards the filter's pose by at most ``reach`` [m], or jumps where they are ``JUMP`` apart.
        """
        wanted = compose(compose(self.drive.pose, inverse(odom_then)), odom_from_base)
        if self._world_from_odom is not None:
            now = compose(self._world_from_odom, odom_from_base)
            apart = float(np.hypot(wanted.x - now.x, wanted.y - now.y)) + abs(wrap(wanted.yaw - now.yaw))
            if apart < JUMP:
                wanted = interpolate(now, wanted, min(1.0, reach / max(apart, 1e-12)))
        self._world_from_odom = compose(wanted, inverse(odom_from_base))
        return wanted

    @property
    def sigma(self) -> float:
        """1 sigma [m] of the position, of the worse axis."""
        return sigma(_worse(self.drive.covariance))

    @property
    def ratio(self) -> float:
        """Test ratio [-] of the newest fix: above 1 it was refused."""
        return self._satellites.ratio

    def is_known(self, t: float) -> bool:
        """Whether at ``t`` [s] a fix has been used within the last ``LOST`` seconds."""
        return not self._satellites.is_lost(t)


def _worse(covariance: Floats) -> float:
    """m^2, along the worse direction."""
    return float(np.linalg.eigvalsh(covariance[:2, :2])[1])
