"""Motion of a differential drive, or of one that goes sideways, too, with derivatives, for both filters.

A step has two parts. First what moves the speed: the accelerometer, whose offset follows the slope as ``inclination`` has it; the wheels'
speeds then correct it. Then the pose moves by that speed and by the gyroscope's turn rate less its bias, along an arc.
"""

import numpy as np
from numpy.typing import NDArray

from uvf.estimation.odometry.states import ACCEL_OFFSET, GNSS_X, GYRO_BIAS, HEADING, LEFT, RIGHT, SPEED, Noise, Step, X, Y
from uvf.maths.compiled import compiled

Floats = NDArray[np.float64]

FOLLOWING = 2.0  # m/s per square root of s: how fast the speed changes where no accelerometer tells it

Told = tuple[float, float, float, float, float, float, bool, bool, float]
"""dt, left and right way, turn rate, force, track; whether there is a gyroscope and an accelerometer; way to the left."""


def told(step: Step, track: float) -> Told:
    """The step and the track [m] as one tuple for the compiled functions."""
    rate, force = step.rate, step.force
    left, right, aside = step.travel
    return step.dt, left, right, rate or 0.0, force or 0.0, track, rate is not None, force is not None, aside


@compiled
def turn_rate(x: Floats, told: Told) -> float:
    """Turn rate [rad/s] at state ``x`` (n,); by the wheels where there is no gyroscope."""
    dt, left, right, rate, _, track, gyro, _, _ = told
    if gyro:
        return float(rate - x[GYRO_BIAS])
    return float((right * (1.0 + x[RIGHT]) - left * (1.0 + x[LEFT])) / (track * dt))


@compiled
def mean_speed(x: Floats, told: Told) -> float:
    """Mean forward speed [m/s] of the step at whose end the state ``x`` (n,) is."""
    return float(x[SPEED] - (0.5 * told[0] * (told[4] - x[ACCEL_OFFSET]) if told[7] else 0.0))


@compiled
def moved(x: Floats, told: Told) -> Floats:
    """State (n,) after the pose of ``x`` (n,) has moved along the arc's chord at the mean heading (as ``kinematics.move``)."""
    dt, turn = told[0], turn_rate(x, told) * told[0]
    arc = np.sinc(turn / (2 * np.pi))
    chord, aside = mean_speed(x, told) * dt * arc, told[8] * arc
    c, s = np.cos(x[HEADING] + turn / 2), np.sin(x[HEADING] + turn / 2)
    y = x.copy()
    y[X] += chord * c - aside * s
    y[Y] += chord * s + aside * c
    y[HEADING] += turn
    return y


@compiled
def moved_jacobian(x: Floats, told: Told) -> Floats:
    """Derivative (n, n) of ``moved`` at ``x`` (n,)."""
    dt, left, right, _, _, track, gyro, accel, _ = told
    turn = turn_rate(x, told) * dt
    arc = np.sinc(turn / (2 * np.pi))
    chord, aside = mean_speed(x, told) * dt * arc, told[8] * arc
    c, s = np.cos(x[HEADING] + turn / 2), np.sin(x[HEADING] + turn / 2)
    f = np.eye(x.shape[0])
    f[HEADING, GYRO_BIAS] = -dt if gyro else 0.0
    f[HEADING, LEFT], f[HEADING, RIGHT] = (0.0, 0.0) if gyro else (-left / track, right / track)
    for i, along, across in ((X, c, -s), (Y, s, c)):
        f[i, HEADING] = chord * across - aside * along
        f[i, SPEED] = dt * arc * along
        f[i, ACCEL_OFFSET] = 0.5 * dt * dt * arc * along if accel else 0.0
        for j in (GYRO_BIAS, LEFT, RIGHT):
            f[i, j] = 0.5 * (chord * across - aside * along) * f[HEADING, j]
    return f


def pose_noise(x: Floats, step: Step, noise: Noise, turn: float, track: float) -> Floats:
    """Process noise (n, n) of the pose's motion at ``x`` (n,), that of the heading [rad^2]; turn: [rad], track: [m].

    Without a gyroscope the heading is as uncertain as the wheels. Only the wheels tell the way to the side.
    """
    q = np.zeros((len(x), len(x)))
    across = np.array((-np.sin(x[HEADING]), np.cos(x[HEADING])))
    q[:HEADING, :HEADING] = np.outer(across, across) * (noise.distance**2 * abs(step.travel.aside) + (noise.skid * step.travel.aside) ** 2)
    q[HEADING, HEADING] = noise.turn**2 * abs(turn) + noise.gyro**2 * step.dt
    if step.rate is None:
        q[HEADING, HEADING] += sum(wheel_variance(x, step, noise, turn, track)) / track**2
    return q


def wheel_variance(x: Floats, step: Step, noise: Noise, turn: float, track: float) -> tuple[float, float]:
    """Variances [m^2] of the distances of left and right wheel in a step that turns by ``turn`` [rad], at ``x`` (n,); track: [m].

    By the distances that the state expects: by those that were told, the ones that noise has made short would count more.
    """
    skidding = (noise.skid * turn * track / 2) ** 2 + noise.resolution**2 / 6 + (noise.give * step.jolt) ** 2
    way, side = float(x[SPEED]) * step.dt, turn * track / 2
    return noise.distance**2 * abs(way - side) + skidding, noise.distance**2 * abs(way + side) + skidding


def driven(step: Step, size: int, slow: float) -> tuple[Floats, Floats]:
    """(F (n, n), shift (n,)) of a step's first part, in which x becomes F x + shift; ``size`` is n.

    slow: the part [-] of the satellites' slow error that a step leaves.
    """
    f, shift = np.eye(size), np.zeros(size)
    if step.force is not None:
        f[SPEED, ACCEL_OFFSET] = -step.dt
        shift[SPEED] = step.force * step.dt
        shift[ACCEL_OFFSET] = step.tilting * step.dt
    f[GNSS_X:, GNSS_X:] *= slow
    return f, shift


def drive_noise(step: Step, noise: Noise, size: int) -> Floats:
    """Process noise (n, n) of a step's first part, in the states' units squared; ``size`` is n."""
    q = np.zeros((size, size))
    accel = FOLLOWING if step.force is None else noise.accel
    q[SPEED, SPEED] = accel**2 * step.dt
    q[GYRO_BIAS, GYRO_BIAS] = noise.bias_walk**2 * step.dt
    q[ACCEL_OFFSET, ACCEL_OFFSET] = (noise.offset_walk**2 + step.tilting_noise**2) * step.dt
    q[LEFT, LEFT], q[RIGHT, RIGHT] = noise.scale_walk**2 * abs(step.left), noise.scale_walk**2 * abs(step.right)
    return q
