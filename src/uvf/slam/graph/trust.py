"""What the odometry of this vehicle is usually off by: learnt from sweeps that fit well, to be held to where they do not."""

from dataclasses import dataclass, field, replace
from math import exp, hypot, log1p, sqrt

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2
from uvf.slam.graph.motion import ALLOWANCE, MotionNoise, OdometryMotion

Floats = NDArray[np.float64]

LEARNT = 0.02
"""How far each step moves what is usual to its own."""
STRAIGHT = 0.05  # rad: steps that turn by less tell how far the odometry is off when it goes straight on
LEAST_TRUST, MOST_SIGMAS = 0.2, 3.0
"""What a usual error is at least, and what a single one counts for at most."""

PRIOR = np.diag(np.array((0.02, 0.05)) ** -2.0)
"""(2, 2) information: rad per m and rad per rad that odometry is known to veer by, 1 sigma."""
REMEMBERED = 10.0
"""m (or rad) of motion after which what has been learnt of the veering counts for 1/e."""


@dataclass
class Veering:
    """Heading drift of the odometry per m driven and per rad turned; it changes slowly, with the floor and the tyres.

    Weighted least squares with a zero-mean prior, in which older steps fade.
    """

    _normal: Floats = field(default_factory=lambda: np.zeros((2, 2)))
    _right: Floats = field(default_factory=lambda: np.zeros(2))

    def straightened(self, step: Pose2, share: float = 1.0) -> Pose2:
        """The step without the heading drift that is expected of it; share: of what is usual, that this odometry veers by at most [-]."""
        return Pose2(step[0], step[1], step[2] + float(_ways(step) @ np.linalg.solve(PRIOR / share**2 + self._normal, self._right)))

    def learn(self, step: Pose2, off: float, sigma: float) -> None:
        """Learns from a step whose heading was off by ``off`` [rad], known to ``sigma`` [rad]."""
        ways = _ways(step)
        fading = exp(-float(np.abs(ways).sum()) / REMEMBERED)
        self._normal = fading * self._normal + np.outer(ways, ways) / sigma**2
        self._right = fading * self._right + ways * off / sigma**2


def _ways(step: Pose2) -> Floats:
    """(2,) m driven and rad turned."""
    return np.array((hypot(step[0], step[1]), step[2]))


@dataclass
class Trust:
    """How far this vehicle's odometry usually is off, in sigmas of its noise [-]: learnt from sweeps that fit well."""

    position: float = 1.0
    heading: float = 1.0
    heading_drift: Veering = field(default_factory=Veering)

    def straightened(self, motion: OdometryMotion) -> OdometryMotion:
        """The motion without the heading drift that is expected of it."""
        return replace(motion, step=self.heading_drift.straightened(motion.step, _veers(motion))) if motion.told else motion

    def learn(self, step: Pose2, motion: OdometryMotion, found: Pose2) -> None:
        """Learns from a matched pose ``found``. step: as the odometry told it; motion: as it was assumed."""
        sigma, known = motion.sigmas[1], motion.step[2] - step[2]
        off = wrap(found[2] - motion.guess[2]) + known
        self.heading_drift.learn(step, min(max(off, -MOST_SIGMAS * sigma), MOST_SIGMAS * sigma), sigma)
        if abs(step[2]) < STRAIGHT:
            position, heading = _off(motion, found) / np.array(motion.sigmas)
            self.position, self.heading = _followed(self.position, position), _followed(self.heading, heading)

    def information(self, motion: OdometryMotion) -> Floats:
        """Information (3, 3) of (x, y, yaw) of a motion [1/m^2, 1/rad^2], by how far off this odometry usually is, or says it is.

        Of a motion that the odometry has not told, as it is.
        """
        return self.usual(motion.noise).information(motion.step, motion.claimed) if motion.told else motion.information

    def sigmas_off(self, motion: OdometryMotion, found: Pose2) -> float:
        """How far the pose ``found`` is from where the motion leads, in sigmas of ``information`` [-]."""
        guess = motion.guess
        off = np.array((found[0] - guess[0], found[1] - guess[1], wrap(found[2] - guess[2])))
        return sqrt(float(off @ self.information(motion) @ off))

    def surprise(self, motion: OdometryMotion, found: Pose2) -> float:
        """How unlikely the pose ``found`` is after the motion [-]: log(1 + d^2) of its distance d in sigmas.

        It grows slowly far out, for wheels slip and vehicles are bumped into.
        """
        return log1p(float(np.sum((_off(motion, found) / np.array(self.usual(motion.noise).sigmas(motion.step))) ** 2)))

    def usual(self, noise: MotionNoise) -> MotionNoise:
        """The noise by how far off this odometry usually is; what a turn adds is left as it is."""
        (p, q, r), (s, t, u) = noise.position, noise.heading
        return MotionNoise((self.position * p, self.position * q, r), (self.heading * s, self.heading * t, u))


def _veers(motion: OdometryMotion) -> float:
    """Share of the usual drift [-] that can be expected of an odometry: one with a gyro says how well it knows its turns."""
    if motion.claimed is None:
        return 1.0
    return min(1.0, ALLOWANCE * motion.claimed[1] / motion.sigmas[1])


def _off(motion: OdometryMotion, found: Pose2) -> Floats:
    """m, rad: how far from where the odometry has it."""
    guess = motion.guess
    return np.array((hypot(found[0] - guess[0], found[1] - guess[1]), abs(wrap(found[2] - guess[2]))))


def _followed(usual: float, sigmas: float) -> float:
    return max(sqrt(usual**2 + LEARNT * (min(sigmas, MOST_SIGMAS) ** 2 - usual**2)), LEAST_TRUST)
