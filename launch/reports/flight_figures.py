"""The figures of a flight: how far, how long, how near to the path, at what cost."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from launch.reports.history import FlownMotion, History
from schemas.messages import Event, Mode

Floats = NDArray[np.float64]

KILOMETRE = 1000.0
WATT_HOUR = 3600.0  # J
AIRBORNE = 5.0  # m/s through the air, where no status tells whether the aircraft has landed
NEAR = 50.0  # m from its path, beyond which an aircraft is on its way to it
SETTLED = 10.0  # s, from the beginning on, in which an estimate may still converge


@dataclass(frozen=True)
class Figure:
    """One line of the table."""

    name: str
    value: str


@dataclass(frozen=True)
class TrackingError:
    """Cross-track errors over time: arrays of one length (k,)."""

    t: Floats  # s
    cross_track: Floats  # m to the right, as the autopilot knows it
    height: Floats  # m above the wanted one, as the autopilot knows it
    wanted: Floats  # m, height
    true_cross_track: Floats | None  # m
    on_path: NDArray[np.bool_]  # in mode Mission, and near it


def deviation(history: History) -> TrackingError | None:
    """Cross-track errors of a flight; None without a status or an estimate.

    That of the truth is the autopilot's own figure plus the error of its estimate across its course.
    """
    rows, estimate, truth = history.rows("state/vehicle"), history.estimate, history.truth
    if len(rows) < 2 or estimate is None:
        return None
    t, across = rows[:, 0], rows[:, 3]
    now = estimate.at(t)
    true_across = None
    if truth is not None:
        off = truth.at(t).position - now.position
        speed = np.maximum(np.hypot(now.velocity[:, 0], now.velocity[:, 1]), 1e-3)
        true_across = across + (off[:, 0] * now.velocity[:, 1] - off[:, 1] * now.velocity[:, 0]) / speed
    on_path = (rows[:, 1] == Mode.MODE_MISSION) & (rows[:, 2] == 0) & (np.abs(across) < NEAR)
    return TrackingError(t, across, rows[:, 4], now.position[:, 2] - rows[:, 4], true_across, on_path)


def energy(history: History) -> Floats:
    """Electric power over time, (k, 3): t [s], power [W], energy drawn since the beginning [J]."""
    rows = history.rows("sensor/battery")
    if not len(rows):
        return np.zeros((0, 3))
    power = rows[:, 1] * rows[:, 2]
    drawn = np.concatenate(((0.0,), np.cumsum((power[1:] + power[:-1]) / 2 * np.diff(rows[:, 0]))))
    return np.column_stack((rows[:, 0], power, drawn))


def figures(history: History) -> list[Figure]:
    """The figures of a flight that the log has the messages for."""
    flown = history.truth or history.estimate
    found: list[Figure] = []
    if flown is not None:
        found += _way(flown, history)
        found += _energy(history, flown)
    found += _path(history)
    found += _surfaces(history)
    if history.truth is not None and history.estimate is not None:
        found += _estimation(history.estimate, history.truth)
    return [*found, *_happenings(history)]


def _way(flown: FlownMotion, history: History) -> Iterator[Figure]:
    airborne = _airborne(flown, history)
    pace = np.hypot(flown.velocity[:, 0], flown.velocity[:, 1])
    yield Figure("logged", f"{flown.t[0]:.1f} to {flown.t[-1]:.1f} s")
    yield Figure("in the air", f"{_time(flown.t, airborne):.0f} s")
    yield Figure("over ground", f"{np.trapezoid(pace * airborne, flown.t) / KILOMETRE:.2f} km")
    yield Figure("through the air", f"{np.trapezoid(flown.airspeed * airborne, flown.t) / KILOMETRE:.2f} km")
    if not airborne.any():
        return
    speed, height = flown.airspeed[airborne], flown.position[airborne, 2]
    yield Figure("airspeed", f"{speed.mean():.2f} m/s, sd {speed.std():.2f}, {speed.min():.1f} to {speed.max():.1f}")
    yield Figure("height", f"{height.min():.1f} to {height.max():.1f} m")
    yield Figure("largest bank, pitch", f"{_most(flown.roll[airborne]):.0f}, {_most(flown.pitch[airborne]):.0f} deg")


def _airborne(flown: FlownMotion, history: History) -> NDArray[np.bool_]:
    rows = history.rows("state/vehicle")
    if not len(rows):
        return flown.airspeed > AIRBORNE
    newest = np.clip(np.searchsorted(rows[:, 0], flown.t, side="right") - 1, 0, None)
    return np.asarray(rows[newest, 2] == 0)


def _path(history: History) -> Iterator[Figure]:
    off = deviation(history)
    if off is None or not off.on_path.any():
        return
    on = off.on_path
    if off.true_cross_track is not None:
        yield Figure("cross-track, truth", _spread(off.true_cross_track[on]))
    yield Figure("cross-track, as known", _spread(off.cross_track[on]))
    yield Figure("height off the wanted", _spread(off.height[on]))


def _energy(history: History, flown: FlownMotion) -> Iterator[Figure]:
    rows, used = history.rows("sensor/battery"), energy(history)
    if len(rows) < 2:
        return
    drawn = used[-1, 2]
    yield Figure("energy", f"{drawn / WATT_HOUR:.1f} Wh, {drawn / (used[-1, 0] - used[0, 0]):.0f} W on average")
    pace = np.hypot(flown.velocity[:, 0], flown.velocity[:, 1])
    kilometres = float(np.trapezoid(pace, flown.t)) / KILOMETRE
    if kilometres > 0.1:
        yield Figure("energy per km", f"{drawn / WATT_HOUR / kilometres:.2f} Wh")
    yield Figure("battery", f"{100 * rows[0, 3]:.1f} to {100 * rows[-1, 3]:.1f} %")


def _surfaces(history: History) -> Iterator[Figure]:
    rows = history.rows("actuator/surfaces")
    if len(rows) < 2:
        return
    way = np.degrees(np.abs(np.diff(rows[:, 1:4], axis=0)).sum(axis=0)) / (rows[-1, 0] - rows[0, 0])
    yield Figure("way of aileron, elevator, rudder", f"{way[0]:.1f}, {way[1]:.1f}, {way[2]:.1f} deg/s")


def _estimation(estimate: FlownMotion, truth: FlownMotion) -> Iterator[Figure]:
    settled = estimate.t >= estimate.t[0] + SETTLED
    if not settled.any():
        return
    true = truth.at(estimate.t)
    off = (estimate.position - true.position)[settled]
    angles = [a - b for a, b in ((estimate.roll, true.roll), (estimate.pitch, true.pitch), (estimate.heading, true.heading))]
    roll, pitch, heading = (np.degrees(_rms(np.angle(np.exp(1j * a[settled])))) for a in angles)
    yield Figure("estimate: horizontal, height", f"{_rms(np.hypot(off[:, 0], off[:, 1])):.2f}, {_rms(off[:, 2]):.2f} m RMS")
    yield Figure("estimate: roll, pitch, heading", f"{roll:.2f}, {pitch:.2f}, {heading:.2f} deg RMS")
    wind = (estimate.wind - true.wind)[settled]
    speed = (estimate.airspeed - true.airspeed)[settled]
    yield Figure("estimate: airspeed, wind", f"{_rms(speed):.2f}, {_rms(np.hypot(wind[:, 0], wind[:, 1])):.2f} m/s RMS")


def _happenings(history: History) -> Iterator[Figure]:
    rows = history.rows("mission/progress")
    if len(rows):
        reached = rows[:, 1]
        yield Figure("mission items reached", f"{np.count_nonzero((np.diff(reached) != 0) & (reached[1:] >= 0))}")
    grave = sum(event.severity >= Event.WARNING for _, event in history.events)
    yield Figure("events, warnings and worse", f"{len(history.events)}, {grave}")


def _spread(values: Floats) -> str:
    size = np.abs(values)
    return f"RMS {_rms(values):.2f}, 95 % {np.percentile(size, 95):.2f}, max {size.max():.2f} m"


def _time(t: Floats, where: NDArray[np.bool_]) -> float:
    return float(np.trapezoid(where.astype(float), t))


def _rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def _most(angles: Floats) -> float:
    return float(np.degrees(np.abs(angles).max()))
