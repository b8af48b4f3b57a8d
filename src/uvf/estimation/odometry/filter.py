"""Pose and speed of a differential drive from wheels and inertial unit, with slip, standstill and an honest covariance.

Two of these make a vehicle's navigation, as robot_localization has it (Moore & Stouch 2014): one whose pose nothing corrects (it drifts and
never jumps: the frame ``odom``), and where there are satellites one that they do correct (the pose in the world).
"""

import numpy as np
from numpy.typing import NDArray

from uvf.estimation.kalman import FILTERS, Kalman, Kind, Measured, correct, misfit, move_linearly
from uvf.estimation.odometry import model
from uvf.estimation.odometry.slip import WheelWatch, wheel_cause
from uvf.estimation.odometry.states import (
    ACCEL_OFFSET,
    GNSS_X,
    GYRO_BIAS,
    LEFT,
    POSE,
    RIGHT,
    SPEED,
    STATES,
    STATES_WITH_GNSS,
    Noise,
    Step,
)
from uvf.maths.kinematics import Twist
from uvf.maths.rotations import wrap
from uvf.maths.se2 import Pose2
from uvf.models.vehicle.sensors import GnssSensor

Floats = NDArray[np.float64]

START_SPEED = 1.0  # m/s, 1 sigma: it may be moving when the filter begins
GAP = 0.1  # s, a longer step is one in which messages are missing
AT_REST = 0.2  # s without a tick after which the wheels count as standing: a change of direction is shorter
SLIDES_ON = 1.0  # s after which the wheels are right whatever the accelerometer says: no vehicle slides on faster than they roll that long
OUTRUNS = 0.05  # m/s by which it may seem to
STEEPEST = 6.0
"""m/s^2 of offset that an accelerometer has on a slope of 38 degrees, which no wheels climb: more is a vehicle that is spun about."""
REST_SPEED = 0.005  # m/s, 1 sigma
REST_GATE = 16.0
WHEEL_PERIOD = 0.02  # s, over which the turn rate that is told is a mean
SEEN_SPEED = 0.1  # m/s, 1 sigma of a speed by scans
SLIPPING = 0.03  # m/s per square root of s: what is added to the speed's noise while a wheel is not believed
JOLTED = 0.3  # m/s^2 of jolt, from which on tyres give and swing so much that the wheels tell nothing about their radii
UNSEEN = 50.0  # steps in which a way that the scans do not see may be all wrong
NOTHING = slice(0, 0)


class DriveFilter:
    """Odometry filter. States as in ``states``; ``track`` [m] and the wheels' radii may be changed while running."""

    def __init__(self, kind: Kind, noise: Noise, track: float, gnss: GnssSensor | None = None) -> None:
        """gnss: data sheet of a receiver, whose slow error is estimated too; the pose is then corrected, else it is held."""
        self.noise, self.track = noise, track
        self._gnss = gnss
        self._held = POSE if gnss is None else NOTHING
        variances = np.zeros(STATES if gnss is None else STATES_WITH_GNSS)
        variances[SPEED] = START_SPEED**2
        variances[[GYRO_BIAS, ACCEL_OFFSET]] = noise.bias_start**2, noise.offset_start**2
        variances[[LEFT, RIGHT]] = noise.scale_start**2
        if gnss is not None:
            variances[GNSS_X:] = gnss.horizontal_drift**2
        self.kalman: Kalman = FILTERS[kind](np.zeros(len(variances)), np.diag(variances))
        self._watches = {LEFT: WheelWatch(), RIGHT: WheelWatch()}
        self._still_for = self._doubted_for = 0.0
        self._turn_rate = self._aside = 0.0
        self.is_unseen = False
        """Set while the scans do not see the motion that the wheels tell."""
        self.doubt: str | None = None
        """Why a wheel was not believed in the last step, if so."""

    @property
    def pose(self) -> Pose2:
        """Pose parent_from_base (x [m], y [m], heading [rad])."""
        x, y, heading = self.kalman.x[POSE].tolist()
        return Pose2(x, y, wrap(heading))

    @property
    def bias(self) -> float:
        """Bias of the gyroscope [rad/s]."""
        return float(self.kalman.x[GYRO_BIAS])

    @property
    def turn_rate_variance(self) -> float:
        """Variance of the turn rate [(rad/s)^2]."""
        return float(self.kalman.P[GYRO_BIAS, GYRO_BIAS]) + self.noise.gyro**2 / WHEEL_PERIOD

    @property
    def velocity(self) -> Twist:
        """Of the last step."""
        return Twist(float(self.kalman.x[SPEED]), self._turn_rate, self._aside)

    @property
    def state(self) -> Floats:
        """Mean (n,) of the states, n = 8, or 10 with satellites."""
        return self.kalman.x

    @property
    def covariance(self) -> Floats:
        """Covariance (n, n) of the states."""
        return self.kalman.P

    @property
    def slip_ratio(self) -> float:
        """Test ratio [-] of the worse wheel: above 1 it is not believed."""
        return max(watch.ratio for watch in self._watches.values())

    def resume(self, pose: Pose2, covariance: Floats, bias: float) -> None:
        """Goes on from a former filter's pose, its covariance (3, 3) [m^2, rad^2], and the gyroscope's bias [rad/s]."""
        self.kalman.x[POSE] = pose
        self.kalman.P[POSE, POSE] = covariance
        self.kalman.x[GYRO_BIAS] = bias

    def place(self, pose: Pose2, sigmas: tuple[float, float]) -> None:
        """Sets the pose, with 1 sigma of position [m] and heading [rad]."""
        self.kalman.x[POSE] = pose
        self.kalman.P[POSE, :] = self.kalman.P[:, POSE] = 0.0
        self.kalman.P[POSE, POSE] = np.diag((sigmas[0] ** 2, sigmas[0] ** 2, sigmas[1] ** 2))

    def doubt_position(self, sigma: float) -> None:
        """Adds ``sigma`` [m] to the position's uncertainty: measurements have said for long that it is wrong."""
        self.kalman.P[[0, 1], [0, 1]] += sigma**2

    def believe_radii(self) -> None:
        """Sets the estimated errors of the wheel radii to zero: from now on the wheels' distances are told by other radii."""
        self.kalman.x[[LEFT, RIGHT]] = 0.0

    def correct(self, measured: Measured, gate: float = np.inf) -> float:
        """Corrects by a measurement unless its normalised innovation squared exceeds ``gate`` [-]; returns their ratio [-].

        A ratio of 1 or more means that the measurement was refused.
        """
        ratio = misfit(self.kalman, measured) / gate
        if ratio < 1.0:
            correct(self.kalman, measured, self._held)
        return ratio

    def see(self, speed: float) -> None:
        """Corrects the forward speed by that of the scans [m/s], for when the wheels are not believed."""
        self.correct(_linear(speed, len(self.kalman.x), {SPEED: 1.0}, SEEN_SPEED**2))

    def step(self, step: Step) -> None:
        """Predicts and corrects by the wheels and the inertial unit of one step."""
        self._drive(step)
        told = model.told(step, self.track)
        turn = model.turn_rate(self.kalman.x, told) * step.dt
        self.doubt = None
        rests = self._rests(step)
        if rests or step.rate is None:
            self._doubted_for = 0.0
        if not rests:
            self._roll(step, turn)
        told = model.told(step, self.track)
        x = self.kalman.x
        self._turn_rate, self._aside = model.turn_rate(x, told), step.travel.aside / step.dt
        noise = model.pose_noise(x, step, self.noise, self._turn_rate * step.dt, self.track)
        self.kalman.move(lambda point: model.moved(point, told), model.moved_jacobian(x, told), noise)
        if step.dt > GAP:
            self._doubt(SPEED, START_SPEED)  # what the wheels have told is its mean speed, not that of its end

    def _doubt(self, state: int, sigma: float) -> None:
        """Makes one of the states as unsure as ``sigma``, and independent of all others."""
        self.kalman.P[state, :] = self.kalman.P[:, state] = 0.0
        self.kalman.P[state, state] = sigma**2

    def _drive(self, step: Step) -> None:
        kalman, gnss = self.kalman, self._gnss
        kept = 1.0 if gnss is None else float(np.exp(-step.dt / gnss.drift_time))
        f, shift = model.driven(step, len(kalman.x), kept)
        q = model.drive_noise(step, self.noise, len(kalman.x))
        if self.slip_ratio > 1.0:
            q[SPEED, SPEED] += SLIPPING**2 * step.dt
        if self.is_unseen:
            q[SPEED, SPEED] += float(kalman.x[SPEED]) ** 2 * step.dt
        if gnss is not None:
            q[GNSS_X:, GNSS_X:] = np.eye(2) * gnss.horizontal_drift**2 * (1.0 - kept * kept)
        move_linearly(kalman, f, shift, q)

    def _rests(self, step: Step) -> bool:
        """Whether it stands; if so the speed is zero and the gyroscope tells its bias."""
        self._still_for = self._still_for + step.dt if not any(step.travel) else 0.0
        if self._still_for <= AT_REST:
            return False
        n, surely = len(self.kalman.x), self._still_for > SLIDES_ON
        standing = _linear(0.0, n, {SPEED: 1.0}, REST_SPEED**2)
        if step.rate is not None:
            silent = _linear(step.rate, n, {GYRO_BIAS: 1.0}, self.noise.rest**2 + self.noise.gyro**2 / step.dt)
            if misfit(self.kalman, silent) > REST_GATE:
                self.doubt = f"it turns by {step.rate - self.kalman.x[GYRO_BIAS]:.2f} rad/s while the wheels stand"
                return True
            correct(self.kalman, silent, self._held)
        self.correct(standing, np.inf if surely else REST_GATE)
        return True

    def _roll(self, step: Step, turn: float) -> None:
        variances = model.wheel_variance(self.kalman.x, step, self.noise, turn, self.track)
        if self.is_unseen:
            variances = variances[0] + UNSEEN * step.left**2, variances[1] + UNSEEN * step.right**2
        if step.rate is None:
            self._mean_of_wheels(step, variances)
            return
        for name, wheel, way, side, variance in (
            ("left", LEFT, step.left, -self.track / 2, variances[0]),
            ("right", RIGHT, step.right, self.track / 2, variances[1]),
        ):
            speed = way / step.dt
            expected = float(self.kalman.x[SPEED]) + side * turn / step.dt  # what was told, with its noise, would bias the scale
            radius = -expected if abs(step.jolt) < JOLTED else 0.0
            parts = {SPEED: 1.0, GYRO_BIAS: -side, wheel: radius} | self._half_step(step)
            half = 0.5 * step.dt * (step.force or 0.0)
            measured = _linear(speed + half - side * step.rate, len(self.kalman.x), parts, variance / step.dt**2)
            innovation, s = self._innovation(measured)
            if self._watches[wheel].believes(innovation, s, step.dt):
                correct(self.kalman, measured, self._held)
            else:
                self.doubt = wheel_cause(name, speed, speed - innovation)
        self._doubted_for = self._doubted_for + step.dt if self.doubt else 0.0
        side = self.track / 2 * turn
        self._hold_back((step.left + side) / step.dt, (step.right - side) / step.dt)

    def _hold_back(self, left: float, right: float) -> None:
        """Wheels that slip roll faster than the vehicle moves: what has outrun them for long is an error of the accelerometer.

        So is an offset that it cannot have. left, right: speed [m/s] of the vehicle by each wheel.
        """
        has_outrun = abs(float(self.kalman.x[SPEED])) > max(abs(left), abs(right)) + OUTRUNS
        is_spun = abs(float(self.kalman.x[ACCEL_OFFSET])) > STEEPEST
        if not is_spun and not (has_outrun and self._doubted_for > SLIDES_ON):
            return
        self.kalman.x[SPEED] = (left + right) / 2
        if is_spun:
            self.kalman.x[ACCEL_OFFSET] = 0.0
        self._doubt(SPEED, START_SPEED)
        self._doubt(ACCEL_OFFSET, self.noise.offset_start)
        self._watches = {LEFT: WheelWatch(), RIGHT: WheelWatch()}

    def _mean_of_wheels(self, step: Step, variances: tuple[float, float]) -> None:
        """Without a gyroscope there is nothing to compare each wheel with."""
        left, right = step.left / step.dt, step.right / step.dt
        expected = float(self.kalman.x[SPEED])
        parts = {SPEED: 1.0, LEFT: -expected / 2, RIGHT: -expected / 2} | self._half_step(step)
        half = 0.5 * step.dt * (step.force or 0.0)
        variance = (variances[0] + variances[1]) / 4 / step.dt**2
        correct(self.kalman, _linear((left + right) / 2 + half, len(self.kalman.x), parts, variance), self._held)

    def _half_step(self, step: Step) -> dict[int, float]:
        """The wheels tell the mean speed of the step, the state has that of its end."""
        return {} if step.force is None else {ACCEL_OFFSET: step.dt / 2}

    def _innovation(self, measured: Measured) -> tuple[float, float]:
        h = measured.jacobian[0]
        return float(measured.z[0] - h @ self.kalman.x), float(h @ self.kalman.P @ h + measured.noise[0, 0])


def _linear(z: float, size: int, parts: dict[int, float], variance: float) -> Measured:
    """One value that is a sum of ``parts`` of the state."""
    h = np.zeros((1, size))
    for state, part in parts.items():
        h[0, state] = part
    return Measured(np.array((z,)), lambda x: h @ x, h, np.array(((variance,),)))
