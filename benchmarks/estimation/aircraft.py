"""Estimators beside the truth: flights of the accuracy course in JSBSim, the sensors of each taken by both estimators.

The aircraft is flown by its own estimator; what that was given is given to the others too, so that all see the same noise. RMS errors
from 30 s on (angles in deg, lengths in m, speeds in m/s; wind is that about the aircraft, gusts included), and NEES, the squared error
over its covariance per state: 1 = as wrong as foretold. ``outage`` takes the fixes away from 60 to 90 s: drift is the error of position
then, sigma what the filter says. ``bias`` adds 0.02 rad/s to each gyroscope: settled is when all errors of bias stay below 0.002 rad/s.
``python -m benchmarks.estimation.aircraft docs/images`` draws docs/images/estimator.png.
"""

import copy
import sys
import tempfile
from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from benchmarks.autopilot.accuracy.flight import Case, Probe, course_site
from benchmarks.autopilot.accuracy.kept import several
from launch import catalogue
from launch.commands.bench import Figures
from uvf.estimation.ekf.estimator import FullEstimator
from uvf.estimation.estimators import Estimator, Instruments, estimator
from uvf.estimation.sensor_inputs import Sensed
from uvf.estimation.state import Estimate
from uvf.maths import rotations
from uvf.models.vehicle.flight_params import AirParams
from uvf.runtime.time.lockstep import Lockstep

Floats = NDArray[np.float64]
Kind = Literal["full", "book"]
Change = Callable[[float, Sensed], Sensed]

SECONDS, SETTLED = 120.0, 30.0  # s
SEEDS = range(1, 21)
OUTAGE = (60.0, 90.0)  # s
BIAS, FOUND = 0.02, 0.002  # rad/s
COLUMNS = ("roll", "pitch", "yaw", "position", "height", "velocity", "airspeed", "wind")
AIR = {"calm": Case(), "10 from E, moderate": Case((0.0, -10.0), "moderate")}


class Recorded(NamedTuple):
    """A flight: per cycle what was sensed, the time since the cycle before, and (12,) the truth in the order of ``_row``."""

    cycles: list[tuple[float, Sensed, float]]
    truth: Floats
    instruments: Instruments
    params: AirParams

    def part(self, begin: float, end: float) -> "Recorded":
        """From ``begin`` to ``end`` [s]."""
        first, last = (int(k) for k in np.searchsorted([t for t, _, _ in self.cycles], (begin, end)))
        return self._replace(cycles=self.cycles[first:last], truth=self.truth[first:last])


class Tap:
    """Stands before an estimator and writes down what it is given."""

    def __init__(self, inner: Estimator) -> None:
        self._inner = inner
        self.given: tuple[Sensed, float] | None = None

    @property
    def gnss_age(self) -> float:
        """s, of the estimator behind."""
        return self._inner.gnss_age

    @property
    def started(self) -> bool:
        """Of the estimator behind."""
        return self._inner.started

    def begin_at(self, roll: float, pitch: float, yaw: float) -> None:
        """Handed on; angles [rad]."""
        self._inner.begin_at(roll, pitch, yaw)

    def step(self, sensed: Sensed, params: AirParams, dt: float) -> Estimate:
        """Handed on; keeps in ``given`` what was sensed and the time since the step before [s]."""
        self.given = sensed, dt
        return self._inner.step(sensed, params, dt)


def record(case: Case) -> Recorded:
    """One flight with the satellites ``good``."""
    with tempfile.TemporaryDirectory() as folder:
        site, _ = course_site("milvus", case, "good", Path(folder))
    lockstep = Lockstep(catalogue.hosts(site, [catalogue.kind("sim_air"), catalogue.kind("autopilot")]))
    cycles: list[tuple[float, Sensed, float]] = []
    truth: list[tuple[float, ...]] = []
    with closing(lockstep):
        probe = Probe(lockstep, site)
        tap = Tap(probe.autopilot._sensing._estimator)
        probe.autopilot._sensing._estimator = tap

        def look(t: float) -> bool:
            if tap.given is not None:
                cycles.append((t, *tap.given))
                tap.given = None
                motion, wind = probe.craft.motion, probe.craft.wind
                angles = rotations.to_euler(rotations.enu_flu_from_ned_frd(motion.world_from_body))
                (e, n, u), (ve, vn, vu) = motion.position.tolist(), motion.velocity.tolist()
                truth.append((n, e, u, vn, ve, vu, *angles, motion.airspeed, wind[1], wind[0]))
            return True

        lockstep.run(SECONDS, look)
        return Recorded(cycles, np.array(truth), probe.autopilot._config.instruments, probe.autopilot.params)


def _row(now: Estimate) -> tuple[float, ...]:
    vn, ve = now.ground_speed * np.cos(now.course), now.ground_speed * np.sin(now.course)
    air = (now.airspeed, now.wind_north, now.wind_east)
    return (now.north, now.east, now.height, float(vn), float(ve), now.climb, now.roll, now.pitch, now.yaw, *air)


class Run(NamedTuple):
    """t: (n,) s; errors: (n, 12) by ``_row``; sigmas: (n, 4) m position, rad tilt and yaw, m/s wind; bias: (n, 3) rad/s estimated."""

    t: Floats
    errors: Floats
    sigmas: Floats
    bias: Floats


def begun(kind: Kind, flight: Recorded) -> Estimator:
    """An estimator of this kind with the instruments of the flight."""
    return estimator(kind, flight.instruments)


def _as_it_is(_: float, sensed: Sensed) -> Sensed:
    return sensed


def replay(one: Estimator, flight: Recorded, change: Change = _as_it_is) -> Run:
    """An estimator over the sensors of a flight, changed on the way."""
    t, errors, sigmas, bias = [], [], [], []
    for (at, given, dt), true in zip(flight.cycles, flight.truth, strict=True):
        now = one.step(change(at, given), flight.params, dt)
        error = np.array(_row(now)) - true
        error[6:9] = np.remainder(error[6:9] + np.pi, 2 * np.pi) - np.pi
        t.append(at)
        errors.append(error)
        sigmas.append((now.position_sigma, now.tilt_sigma, now.yaw_sigma, now.wind_sigma))
        bias.append(one.gyro_bias if isinstance(one, FullEstimator) else np.zeros(3))
    return Run(np.array(t), np.array(errors), np.array(sigmas), np.array(bias))


def _rms(x: Floats) -> float:
    return float(np.sqrt(np.mean(np.square(x))))


def scores(run: Run) -> dict[str, float]:
    """RMS errors [deg, m, m/s] after SETTLED, and NEES per state where the estimator tells its covariance."""
    k = run.t > SETTLED
    e = run.errors[k]
    roll, pitch, yaw = (np.degrees(_rms(e[:, i])) for i in (6, 7, 8))
    rest = (_rms(e[:, :2]), _rms(e[:, 2]), _rms(e[:, 3:6]), _rms(e[:, 9]), _rms(e[:, 10:12]))
    found = dict(zip(COLUMNS, (roll, pitch, yaw, *rest), strict=True))
    sigma = run.sigmas[k]
    if sigma[:, 1].all():
        found["NEES position"] = float(np.mean(e[:, :2] ** 2 / sigma[:, :1] ** 2))
        found["NEES tilt"] = float(np.mean(e[:, 6:8] ** 2 / sigma[:, 1:2] ** 2))
        found["NEES yaw"] = float(np.mean(e[:, 8] ** 2 / sigma[:, 2] ** 2))
        found["NEES wind"] = float(np.mean(e[:, 10:12] ** 2 / sigma[:, 3:4] ** 2))
    return found


def _without_fixes(_: float, sensed: Sensed) -> Sensed:
    return replace(sensed, fix=None)


def _biased(_: float, sensed: Sensed) -> Sensed:
    turned = [replace(s, rates=(s.rates[0] + BIAS, s.rates[1] - BIAS, s.rates[2] + BIAS)) for s in sensed.samples]
    return replace(sensed, samples=turned)


def settled(run: Run, plain: Run) -> float:
    """s, from where on the bias found is that found without the added one and the added one."""
    off = np.abs(run.bias - plain.bias[-1] - np.array((BIAS, -BIAS, BIAS))).max(axis=1) > FOUND
    return float(run.t[np.flatnonzero(off)[-1]]) if off.any() else 0.0


def with_outage(kind: Kind, flight: Recorded) -> tuple[Run, Run]:
    """The whole flight, and the outage as it would have been."""
    one, outage = begun(kind, flight), flight.part(*OUTAGE)
    before = replay(one, flight.part(0.0, OUTAGE[0]))
    without = replay(copy.deepcopy(one), outage, _without_fixes)
    after = replay(one, flight.part(OUTAGE[0], SECONDS + 1))
    return Run(*(np.concatenate(both) for both in zip(before, after, strict=True))), without


def judged(kind: Kind, flight: Recorded) -> dict[str, float]:
    """A row of one estimator: its scores, drift and sigma [m] of the outage, and the time [s] to find a bias."""
    run, without = with_outage(kind, flight)
    row = scores(run) | {"drift": float(np.hypot(*without.errors[-1, :2])), "sigma": float(without.sigmas[-1, 0])}
    if kind == "full":
        row["bias s"] = settled(replay(begun(kind, flight), flight.part(0.0, OUTAGE[0]), _biased), run)
    return row


def flown(case: Case) -> dict[str, dict[str, float]]:
    """By estimator."""
    flight = record(case)
    return {"full": judged("full", flight), "book": judged("book", flight)}


def figures(name: str) -> Figures:
    """By estimator, the mean over the seeds."""
    rows = list(several(flown, [(replace(AIR[name], seed=seed),) for seed in SEEDS]))
    return {
        f"{name}, {kind}": {metric: float(np.mean([row[kind][metric] for row in rows])) for metric in rows[0][kind]}
        for kind in ("full", "book")
    }


def draw(path: Path) -> None:
    """Errors of one flight in wind and turbulence between their bounds of three sigmas, and of its outage."""
    run, without = with_outage("full", record(AIR["10 from E, moderate"]))
    figure = Figure(figsize=(12.0, 8.0), layout="constrained")
    angle, metre = 180 / np.pi, 1.0
    shown = {"roll, deg": (6, 1, angle), "pitch, deg": (7, 1, angle), "yaw, deg": (8, 2, angle)}
    shown |= {"north, m": (0, 0, metre), "wind to the north, m/s": (10, 3, metre), "north without fixes, m": (0, 0, metre)}
    for axes, (title, (state, sigma, unit)) in zip(figure.subplots(2, 3).flat, shown.items(), strict=True):
        one = without if "without" in title else run
        _bounded(axes, one.t, unit * one.errors[:, state], unit * one.sigmas[:, sigma])
        axes.set(title=title, xlabel="s")
    figure.savefig(path, dpi=80)


def _bounded(axes: Axes, t: Floats, error: Floats, sigma: Floats) -> None:
    axes.fill_between(t, -3 * sigma, 3 * sigma, color="0.88", label="3 sigma")
    axes.plot(t, error, linewidth=0.8, label="estimate less truth")
    reach = 1.3 * max(float(np.abs(error[len(error) // 8 :]).max()), 3 * float(np.median(sigma)))
    axes.set_ylim(-reach, reach)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=8)


def _case(name: str) -> Callable[[Path | None], Figures]:
    return lambda data: figures(name)


CASES = {"calm": _case("calm"), "moderate": _case("10 from E, moderate")}

if __name__ == "__main__":
    draw(Path(sys.argv[1]) / "estimator.png")
