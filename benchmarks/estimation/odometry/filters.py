"""Odometry beside the truth: extended and unscented filter and bare wheels, over simulated drives of a minute with what spoils them.

``drift %`` is the distance between the ends over the way, ``heading deg`` the error at the end (both RMS over the seeds). NEES is the
squared error over its covariance per state, at the end: 1 = as wrong as foretold. ``ms per s`` is time on the processor for a second of
driving. ``slip`` spins both wheels for 3 s and one for 4 s; ``wrong`` has radii of +3 and -2 % and a track of +5 %, ``calibrated`` the
same after a drive of 3 minutes beside scans of 1 cm and 0.3 deg. ``python -m benchmarks.estimation.odometry.filters docs/images`` draws it.
"""

import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple, Protocol

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from benchmarks.estimation.odometry.drive import DT, TRACK, Moment, World, drive
from launch.commands.bench import Figures
from uvf.estimation.kalman import Kind
from uvf.estimation.odometry.calibration import Scales, SegmentMaker, WheelCalibration
from uvf.estimation.odometry.filter import DriveFilter
from uvf.estimation.odometry.states import Noise, Step
from uvf.maths.kinematics import Twist, WheelTravel, move
from uvf.maths.rotations import wrap
from uvf.maths.se2 import IDENTITY, Pose2

Floats = NDArray[np.float64]

SEEDS = range(1, 21)
SECONDS = 60.0
LEARNING = 180.0  # s of driving beside scans before the calibrated drives
PLACE, TURN = 0.01, np.radians(0.3)  # m and rad, 1 sigma of a scan's pose
SCANNED = 5  # steps between two scans
WRONG = World(seconds=SECONDS, left=1.03, right=0.98, track=1.05, radius=0.0)
WORLDS = {
    "plain": World(seconds=SECONDS, radius=0.01),
    "slip": World(seconds=SECONDS, radius=0.01, slips=((20.0, 23.0, 0.3, 0.3), (40.0, 44.0, 0.0, 0.4))),
    "wrong": WRONG,
    "calibrated": WRONG,
}


class Odometer(Protocol):
    """What is compared: filters, and bare wheels."""

    def step(self, step: Step) -> None:
        """One reading of wheels and gyroscope."""

    @property
    def pose(self) -> Pose2:
        """Where odometry has the vehicle: m, m, rad."""


class Wheels:
    """What the wheels say and nothing else."""

    def __init__(self) -> None:
        self.pose: Pose2 = IDENTITY

    def step(self, step: Step) -> None:
        """Adds the arc that both wheels have rolled."""
        self.pose = move(self.pose, Twist((step.left + step.right) / 2, (step.right - step.left) / TRACK), 1.0)


def learnt(world: World, seed: int) -> list[tuple[float, WheelCalibration]]:
    """Calibrations after each ten seconds of a drive beside scans, with the way until then [m]."""
    rng = np.random.default_rng(seed)
    calibration = WheelCalibration(TRACK)
    maker, way, found = SegmentMaker(calibration), 0.0, []
    drive_filter = DriveFilter("ekf", Noise(), TRACK)
    for k, moment in enumerate(drive(replace(world, seconds=LEARNING), 1000 + seed), 1):
        drive_filter.step(moment.step)
        way += abs(moment.twist.linear) * DT
        maker.roll(moment.step.left, moment.step.right, drive_filter.pose.yaw, drive_filter.doubt is not None)
        if k % SCANNED == 0:
            x, y, yaw = np.array(moment.pose) + rng.standard_normal(3) * (PLACE, PLACE, TURN)
            maker.match(Pose2(float(x), float(y), float(yaw)))
        if k % 500 == 0:
            found.append((way, _copy(calibration)))
    return found


def _copy(calibration: WheelCalibration) -> WheelCalibration:
    twin = WheelCalibration(TRACK)
    twin.__dict__ |= calibration.__dict__
    return twin


def begun(kind: Kind, scales: Scales) -> DriveFilter:
    """A filter that starts with these scales of wheels and track."""
    noise = Noise() if scales == Scales() else Noise(scale_start=0.004)
    return DriveFilter(kind, noise, TRACK * scales.track)


def _scaled(step: Step, scales: Scales) -> Step:
    return step._replace(travel=WheelTravel(step.left * scales.left, step.right * scales.right, step.travel.aside))


def off(odometer: Odometer, true: Pose2) -> Floats:
    """(3,) m, m, rad."""
    pose = odometer.pose
    return np.array((pose.x - true.x, pose.y - true.y, wrap(pose.yaw - true.yaw)))


class Ended(NamedTuple):
    """error: (3,) m, m, rad; nees: of position and heading; way: m; seconds: on the processor."""

    error: Floats
    nees: tuple[float, float]
    way: float
    seconds: float


def driven(odometer: Odometer, moments: Sequence[Moment], scales: Scales) -> Ended:
    """What odometry has become at the end of a drive."""
    began = time.process_time()
    for moment in moments:
        odometer.step(_scaled(moment.step, scales))
    taken = time.process_time() - began
    e, nees = off(odometer, moments[-1].pose), (0.0, 0.0)
    if isinstance(odometer, DriveFilter):
        p = odometer.covariance
        nees = float(e[:2] @ np.linalg.solve(p[:2, :2], e[:2])) / 2, float(e[2] ** 2 / p[2, 2])
    return Ended(e, nees, sum(abs(m.twist.linear) for m in moments) * DT, taken)


def figures(name: str) -> Figures:
    """By method, over the seeds."""
    makers: dict[str, Callable[[Scales], Odometer]] = {
        "ekf": lambda scales: begun("ekf", scales),
        "ukf": lambda scales: begun("ukf", scales),
        "wheels": lambda scales: Wheels(),
    }
    ends: dict[str, list[Ended]] = {method: [] for method in makers}
    for seed in SEEDS:
        moments = drive(WORLDS[name], seed)
        scales = learnt(WORLDS[name], seed)[-1][1].scales if name == "calibrated" else Scales()
        for method, make in makers.items():
            ends[method].append(driven(make(scales), moments, scales))
    return {f"{name}, {method}": _row(found, method != "wheels") for method, found in ends.items()}


def _row(ends: Sequence[Ended], foretells: bool) -> dict[str, float]:
    errors = np.array([end.error for end in ends])
    way = float(np.mean([end.way for end in ends]))
    row = {
        "drift %": 100 * float(np.sqrt(np.mean(np.sum(errors[:, :2] ** 2, axis=1)))) / way,
        "heading deg": float(np.degrees(np.sqrt(np.mean(errors[:, 2] ** 2)))),
    }
    if foretells:
        position, heading = np.mean([end.nees for end in ends], axis=0)
        row |= {"NEES position": float(position), "NEES heading": float(heading)}
    return row | {"ms per s": 1000 * float(np.mean([end.seconds for end in ends])) / SECONDS}


def _case(name: str) -> Callable[[Path | None], Figures]:
    return lambda data: figures(name)


CASES = {name: _case(name) for name in WORLDS}


def draw(path: Path) -> None:
    """A drive with slip, its errors between three sigmas, and the calibration on its way."""
    figure = Figure(figsize=(12.0, 8.0), layout="constrained")
    (road, position), (heading, scale) = figure.subplots(2, 2)
    moments = drive(WORLDS["slip"], 9)
    one, wheels, rows, rolled = begun("ekf", Scales()), Wheels(), [], []
    for moment in moments:
        one.step(moment.step)
        wheels.step(moment.step)
        p = one.covariance
        rows.append((moment.t, *one.pose[:2], *off(one, moment.pose), *np.sqrt(np.diag(p)[:3])))
        rolled.append(wheels.pose[:2])
    told, true = np.array(rows), np.array([m.pose[:2] for m in moments])
    for name, track in (("true", true), ("ekf", told[:, 1:3]), ("wheels", np.array(rolled))):
        road.plot(*track.T, label=name, linewidth=1.2)
    road.set(title="a minute with two slips", xlabel="m", ylabel="m", aspect="equal")
    _bounded(position, told[:, 0], told[:, 3], told[:, 6])
    position.set(title="x, m", xlabel="s")
    _bounded(heading, told[:, 0], np.degrees(told[:, 5]), np.degrees(told[:, 8]))
    heading.set(title="heading, deg", xlabel="s")
    for axes in (position, heading):
        for begin, end, *_ in WORLDS["slip"].slips:
            axes.axvspan(begin, end, color="tab:orange", alpha=0.2)
    _learning(scale)
    for axes in (road, position, heading, scale):
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)
    figure.savefig(path, dpi=80)


def _bounded(axes: Axes, t: Floats, error: Floats, sigma: Floats) -> None:
    axes.fill_between(t, -3 * sigma, 3 * sigma, color="0.88", label="3 sigma")
    axes.plot(t, error, linewidth=1.0, label="ekf less truth")


def _learning(axes: Axes) -> None:
    found = learnt(WRONG, 2)
    way = [w for w, _ in found]
    for i, (name, true) in enumerate(zip(Scales._fields, (WRONG.left, WRONG.right, WRONG.track), strict=True)):
        value, sigma = (np.array([getattr(c, a)[i] for _, c in found]) for a in ("scales", "sigmas"))
        axes.errorbar(way, value, yerr=sigma, label=name, capsize=2, color=f"C{i}")
        axes.axhline(true, color=f"C{i}", linestyle=":")
    axes.set(title="scales found beside scans, and the true ones", xlabel="m driven")


if __name__ == "__main__":
    draw(Path(sys.argv[1]) / "odometry.png")
