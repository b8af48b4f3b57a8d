"""Satellite positions into the pose in the world: lever arm, delay, gate, loss."""

from dataclasses import dataclass
from math import isfinite
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.estimation.kalman import Measured, misfit
from uvf.estimation.odometry.filter import DriveFilter
from uvf.estimation.odometry.states import GNSS_X, HEADING, POSE, SPEED
from uvf.maths.geodesy import LocalTangent
from uvf.maths.kinematics import Twist, twist_between
from uvf.maths.se2 import Pose2, PoseHistory, compose, inverse, transform

Floats = NDArray[np.float64]

GATE = 13.8  # chi-square of two degrees of freedom, 99.9 %
LEAST_POSITION, LEAST_SPEED = 0.05, 0.05  # m, m/s: no fix is better
HISTORY = 100  # poses kept to look up where a fix was taken
PATIENCE = 10.0  # s of fixes that are all refused, after which the filter doubts itself
MOMENT = 0.04  # s, over which the motion at a fix is taken
LOST = 2.0  # s without a fix
ANYWHERE = 1000.0  # m, 1 sigma of a place that was wrong


class SatelliteFix(NamedTuple):
    """A receiver's fix, valid for ``t``; ``known`` is False without a position in three dimensions."""

    t: float  # s
    known: bool
    latitude: float  # rad
    longitude: float  # rad
    altitude: float  # m AMSL
    velocity: tuple[float, float]  # m/s, east and north
    horizontal_accuracy: float  # m, 1 sigma
    speed_accuracy: float  # m/s, 1 sigma


@dataclass(frozen=True)
class Antenna:
    """arm: [m], of the receiver in the base frame (forward, left); drift: [m], 1 sigma of the slow part of its errors."""

    arm: tuple[float, float]
    drift: float


class Satellites:
    """Corrects a filter by satellite fixes; the filter's pose is in the world frame."""

    def __init__(self, tangent: LocalTangent, antenna: Antenna, heading_sigma: float) -> None:
        """heading_sigma: rad, of the heading at the start, which a single fix does not tell."""
        self._tangent, self._antenna, self._heading_sigma = tangent, antenna, heading_sigma
        self._history = PoseHistory(HISTORY)
        self._newest = -np.inf
        self._taken = -np.inf
        self.placed = False
        self.ratio = 0.0
        """Of the newest fix to its gate: above 1 it was refused."""

    def is_lost(self, t: float) -> bool:
        """Whether at ``t`` [s] no fix has been used for ``LOST`` seconds."""
        return t - self._taken > LOST

    def note(self, t: float, odom_from_base: Pose2) -> None:
        """Stores the odometry's pose at ``t`` [s], for fixes that come late."""
        self._history.add(t, odom_from_base)

    def take(self, fix: SatelliteFix, world: DriveFilter, odom_from_base: Pose2) -> bool:
        """Corrects the filter ``world``, whose pose belongs to ``odom_from_base``, by a fix; whether it was used."""
        t = fix.t
        told = (fix.latitude, fix.longitude, fix.altitude, fix.horizontal_accuracy)
        known = fix.known and all(map(isfinite, told)) and fix.horizontal_accuracy > 0.0
        then = self._history.at(t)
        if t <= self._newest or not known or then is None:
            return False
        self._newest = t
        base_from_then = compose(inverse(odom_from_base), then)
        place = self._tangent.enu(fix.latitude, fix.longitude, fix.altitude)[:2]
        variance = max(fix.horizontal_accuracy**2 - self._antenna.drift**2, LEAST_POSITION**2)
        if not self.placed:
            self._place(place, transform(base_from_then, np.array((self._antenna.arm,)))[0], variance, world)
        self._correct(fix, place, variance, world, base_from_then, t)
        if self.ratio < 1.0:
            self._taken = t
        return self.ratio < 1.0

    def _place(self, place: Floats, arm: Floats, variance: float, world: DriveFilter) -> None:
        """Where the first fix and the start do not go together the fix counts; the heading stays that of the start."""
        self.placed = True
        if misfit(world.kalman, position(world.state, place, arm, variance)) > GATE:
            world.place(Pose2(float(place[0]), float(place[1]), world.pose.yaw), (ANYWHERE, self._heading_sigma))

    def _correct(self, fix: SatelliteFix, place: Floats, variance: float, world: DriveFilter, base_from_then: Pose2, t: float) -> None:
        arm = transform(base_from_then, np.array((self._antenna.arm,)))[0]
        self.ratio = world.correct(position(world.state, place, arm, variance), GATE)
        if self.ratio >= 1.0:
            if t - self._taken > PATIENCE:
                world.doubt_position(float(np.sqrt(self.ratio * variance)))
                self._taken = t
            return
        then = self._motion(t)
        if then is not None:
            told, changed = fix.velocity, Changed(base_from_then.yaw, then.linear - world.velocity.linear, then.angular, then.lateral)
            world.correct(velocity(world.state, told, changed, self._antenna.arm, max(fix.speed_accuracy, LEAST_SPEED) ** 2), GATE)

    def _motion(self, t: float) -> Twist | None:
        """Velocity of the odometry at ``t`` [s]."""
        before, after = self._history.at(t - MOMENT), self._history.at(t)
        return twist_between(before, after, MOMENT) if before is not None and after is not None else None


def position(x: Floats, place: Floats, arm: Floats, variance: float) -> Measured:
    """Measurement of the antenna's position ``place`` (2,) [m], world frame (ENU), at state ``x`` (n,); variance: [m^2].

    arm: (2,) [m], of where the antenna was at the fix, in the present base frame. The slow error of satellites adds to it.
    """

    def expected(point: Floats) -> Floats:
        antenna: Floats = transform(Pose2(*point[POSE].tolist()), arm[None])[0] + point[GNSS_X : GNSS_X + 2]
        return antenna

    c, s = np.cos(x[HEADING]), np.sin(x[HEADING])
    h = np.zeros((2, len(x)))
    h[:, :2] = h[:, GNSS_X : GNSS_X + 2] = np.eye(2)
    h[:, HEADING] = -s * arm[0] - c * arm[1], c * arm[0] - s * arm[1]
    return Measured(place, expected, h, np.eye(2) * variance)


class Changed(NamedTuple):
    """State at a fix against the present one: heading and speed then less those of now, and turn rate and speed sideways then."""

    heading: float  # rad
    speed: float  # m/s
    rate: float  # rad/s
    aside: float = 0.0  # m/s


def velocity(x: Floats, told: tuple[float, float], then: Changed, arm: tuple[float, float], variance: float) -> Measured:
    """Measurement of the antenna's velocity ``told`` (east, north) [m/s] at state ``x`` (n,); variance: [(m/s)^2].

    arm: [m], of the antenna in the base frame.
    """
    across, along = then.rate * arm[0] + then.aside, then.speed - then.rate * arm[1]

    def expected(point: Floats) -> Floats:
        c, s = np.cos(point[HEADING] + then.heading), np.sin(point[HEADING] + then.heading)
        forward = point[SPEED] + along
        return np.array((forward * c - across * s, forward * s + across * c))

    c, s = np.cos(x[HEADING] + then.heading), np.sin(x[HEADING] + then.heading)
    forward = x[SPEED] + along
    h = np.zeros((2, len(x)))
    h[:, SPEED] = c, s
    h[:, HEADING] = -forward * s - across * c, forward * c - across * s
    return Measured(np.array(told), expected, h, np.eye(2) * variance)
