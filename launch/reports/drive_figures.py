"""The figures of a drive: how far, how fast, how well localized, what the planner had to do."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from launch.reports.flight_figures import Figure
from launch.reports.history import FlownMotion, History
from schemas.messages import Event, NavStatus
from uvf.maths.rotations import wrap

Floats = NDArray[np.float64]

MOVING = 0.02  # m/s, from which on a rover drives
SMOOTHED = 5  # samples: accelerations are those of speeds averaged over so many


def forward_speed(motion: FlownMotion) -> Floats:
    """Speed (k,) [m/s] along the vehicle's own nose; negative backwards."""
    east, north = np.sin(motion.heading), np.cos(motion.heading)
    speed: Floats = motion.velocity[:, 0] * east + motion.velocity[:, 1] * north
    return speed


def turn_rate(motion: FlownMotion) -> Floats:
    """Turn rate (k,) [rad/s], left positive."""
    rate: Floats = -np.gradient(np.unwrap(motion.heading), motion.t)
    return rate


def accelerations(motion: FlownMotion) -> tuple[Floats, Floats]:
    """Accelerations (k,) [m/s^2] of the smoothed speed: along the nose, and to the left, that of the turn."""
    window = np.ones(SMOOTHED) / SMOOTHED
    speed, rate = (np.convolve(np.pad(v, SMOOTHED // 2, "edge"), window, "valid") for v in (forward_speed(motion), turn_rate(motion)))
    return np.gradient(speed, motion.t), speed * rate


def pose_errors(history: History) -> tuple[Floats, Floats, Floats]:
    """t (k,) [s], horizontal error (k,) [m] and yaw error (k,) [rad] of the estimated poses; empty without truth or estimate."""
    rows, truth = history.rows("nav/pose"), history.truth
    if truth is None or not len(rows):
        return np.zeros(0), np.zeros(0), np.zeros(0)
    rows = rows[(rows[:, 0] >= truth.t[0]) & (rows[:, 0] <= truth.t[-1])]  # beyond them the truth is not known
    true = truth.at(rows[:, 0])
    off = np.hypot(rows[:, 1] - true.position[:, 0], rows[:, 2] - true.position[:, 1])
    yaw = np.array([wrap(angle) for angle in rows[:, 3] - (np.pi / 2 - true.heading)])
    return rows[:, 0], off, yaw


def touches(history: History) -> Floats:
    """Times (n,) [s] at which the vehicle began to touch something."""
    rows = history.rows("sensor/contact")
    began: Floats = rows[np.diff(rows[:, 1], prepend=0.0) > 0.5, 0] if len(rows) else np.zeros(0)
    return began


def drive_figures(history: History) -> list[Figure]:
    """The figures of a drive that the log has the messages for."""
    return [*_way(history), *_localization(history), *_planner(history), *_happenings(history)]


def _way(history: History) -> Iterator[Figure]:
    truth = history.truth
    if truth is None:
        return
    speed = forward_speed(truth)
    along, across = accelerations(truth)
    moving = np.abs(speed) > MOVING
    yield Figure("logged", f"{truth.t[0]:.1f} to {truth.t[-1]:.1f} s")
    yield Figure("driven", f"{np.trapezoid(np.hypot(*truth.velocity[:, :2].T), truth.t):.2f} m")
    yield Figure("in motion", f"{np.trapezoid(moving.astype(float), truth.t):.0f} s")
    if not moving.any():
        return
    yield Figure("speed in motion", f"{np.abs(speed[moving]).mean():.2f} m/s, largest {np.abs(speed).max():.2f}")
    yield Figure("driven backwards", f"{np.trapezoid(np.maximum(-speed, 0.0), truth.t):.2f} m")
    yield Figure("acceleration along, across", f"95 % below {_tail(along):.2f}, {_tail(across):.2f} m/s^2")


def _localization(history: History) -> Iterator[Figure]:
    _, off, yaw = pose_errors(history)
    if len(off):
        yield Figure("pose error", f"RMS {_rms(off):.3f}, largest {off.max():.3f}, at the end {off[-1]:.3f} m")
        yield Figure("yaw error", f"RMS {np.degrees(_rms(yaw)):.2f}, largest {np.degrees(np.abs(yaw).max()):.2f} deg")


def _planner(history: History) -> Iterator[Figure]:
    rows = history.rows("nav/status")
    if not len(rows):
        return
    reached, given_up = (_times(rows[:, 1] == state) for state in (NavStatus.REACHED, NavStatus.BLOCKED))
    yield Figure("goals reached, given up", f"{reached}, {given_up}")
    yield Figure("recoveries", f"{np.maximum(np.diff(rows[:, 4], prepend=0.0), 0.0).sum():.0f}")
    if rows[-1, 3] > 0.0:
        yield Figure("explored", f"{100 * rows[-1, 3]:.0f} %")


def _happenings(history: History) -> Iterator[Figure]:
    battery = history.rows("sensor/battery")
    if len(battery):
        yield Figure("battery", f"{100 * battery[0, 3]:.1f} to {100 * battery[-1, 3]:.1f} %")
    yield Figure("contacts", f"{len(touches(history))}")
    grave = sum(event.severity >= Event.WARNING for _, event in history.events)
    yield Figure("events, warnings and worse", f"{len(history.events)}, {grave}")


def _times(holds: NDArray[np.bool_]) -> int:
    """How often something began to hold."""
    return int(np.count_nonzero(np.diff(holds, prepend=False) & holds))


def _rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def _tail(values: Floats) -> float:
    return float(np.percentile(np.abs(values), 95))
