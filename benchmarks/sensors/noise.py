"""Noise of each sensor against its stated parameters: still vehicles, the sensors' own models.

``python -m benchmarks.sensors.noise allan.png`` draws the Allan deviation of the IMU.
"""

import sys
from collections.abc import Callable
from pathlib import Path

import msgspec
import numpy as np
from numpy.typing import ArrayLike, NDArray

from services.sim_air.engine.states import Air, AircraftMotion
from services.sim_air.sensors import Imu, PressureSensors
from services.sim_camera.renderer import BulletRenderer, Pose
from services.sim_ground.body import BodyState
from services.sim_ground.encoders import ticks
from services.sim_ground.imu import ImuModel
from uvf.maths.bvh import build
from uvf.maths.geodesy import GRAVITY, LocalTangent
from uvf.maths.kinematics import WheelSpeeds
from uvf.maths.raycast import Scene
from uvf.maths.rotations import IDENTITY
from uvf.maths.solids import box
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle
from uvf.models.vehicle.sensor_presets import PRESETS
from uvf.models.vehicle.sensors import AirDataSensor, Camera, Encoders, GnssSensor, ImuSensor, Lidar, Mount, RangeFinder, Sensors, Sonar
from uvf.models.world.file import Origin, WorldFile
from uvf.sensors.allan import allan_deviation, expected, octaves
from uvf.sensors.errors import Errors
from uvf.sensors.fitted import accelerometer_errors, gyro_errors, line_of, receiver
from uvf.sensors.range_sensors import LidarModel, RangeModel
from uvf.sensors.sampling import DelayLine

Floats = NDArray[np.float64]
Figures = dict[str, dict[str, float]]
STILL = BodyState(np.zeros(3), IDENTITY, np.zeros(3), np.zeros(3), (0.0, 0.0), WheelSpeeds(0.0, 0.0))
ROOM = Scene(build(box((4.0, 4.0, 4.0), np.zeros(3))))  # seen from its middle, 2 m away
UP = np.array((0.0, 0.0, GRAVITY))  # m/s^2
FIELD = np.array((2e-6, 25e-6, -39e-6))  # T, ENU
TANGENT = LocalTangent.from_degrees(40.77, 14.79, 300.0)
HOURS = 1.0


def _sensors(vehicle: str) -> Sensors:
    return load_vehicle(ROOT / "vehicles", vehicle).sensors


def _rng(seed: int = 1) -> np.random.Generator:
    return np.random.default_rng(seed)


def _row(errors: ArrayLike, stated: float) -> dict[str, float]:
    """errors: (samples, components) of one sensor at rest."""
    errors = np.asarray(errors)
    sigma = float(np.sqrt(errors.var(axis=0).mean()))
    return {"samples": errors.shape[0], "mean": float(errors.mean()), "sigma stated": stated, "sigma": sigma, "ratio": sigma / stated}


def _spread(draw: Callable[[np.random.Generator], ArrayLike], stated: float, count: int = 2000) -> dict[str, float]:
    """Of what is drawn once for each sensor, over many of them."""
    return _row(np.array([draw(_rng(seed)) for seed in range(count)]).reshape(-1, 1), stated)


def noise(data: Path | None) -> Figures:
    """White noise and constant biases: rad/s, m/s^2, T, m, m/s, Pa."""
    ground = {**_inertial(_sensors("burger").imu), **_ranges(), **_satellite()}
    return {**ground, **_in_flight(), **_pressures(), **_range_finder(), **_depth(), **_delivery()}


def _inertial(imu: ImuSensor | None) -> Figures:
    assert imu is not None
    steady = msgspec.structs.replace(
        imu, gyro_bias=0.0, accel_bias=0.0, gyro_instability=0.0, accel_instability=0.0, gyro_random_walk=0.0, accel_random_walk=0.0
    )
    model = ImuModel(msgspec.structs.replace(steady, mag_hz=None), FIELD, _rng())
    read = [model.read(n / imu.hz, STILL) for n in range(1, 20_001)]
    return {
        "burger gyro": _row([r.angular_velocity for r in read], imu.gyro_noise),
        "burger accel": _row([r.specific_force - UP for r in read], imu.accel_noise),
        "burger mag": _row([r.magnetic_field - FIELD for r in read], imu.mag_noise),
        "gyro turn-on bias": _spread(lambda rng: _first(msgspec.structs.replace(imu, gyro_noise=0.0), rng)[0], imu.gyro_bias),
        "accel turn-on bias": _spread(lambda rng: _first(msgspec.structs.replace(imu, accel_noise=0.0), rng)[1], imu.accel_bias),
    }


def _first(imu: ImuSensor, rng: np.random.Generator) -> tuple[Floats, Floats]:
    """rad/s and m/s^2, errors of the first reading, not rounded."""
    fine = msgspec.structs.replace(imu, gyro_resolution=0.0, accel_resolution=0.0)
    read = ImuModel(fine, FIELD, rng).read(1 / imu.hz, STILL)
    return read.angular_velocity, read.specific_force - UP


def _ranges() -> Figures:
    figures: Figures = {}
    for name, preset in PRESETS["lidar"].items():
        lidar = msgspec.convert({"mount": {}, **preset}, Lidar)
        model, truth = LidarModel(lidar, ROOM, _rng()), LidarModel(msgspec.structs.replace(lidar, noise=0.0), ROOM, _rng())
        figures[f"lidar {name}"] = _row([model.scan(STILL, []) - truth.scan(STILL, []) for _ in range(200)], lidar.noise)
    sonar = Sonar(mount=Mount(), hz=10.0, fov=0.5, range_min=0.02, range_max=4.0, noise=0.02)
    echo = RangeModel(sonar, ROOM, _rng())
    figures["sonar"] = _row([[echo.range(STILL, []) - 2.0] for _ in range(5000)], sonar.noise)
    encoders = _sensors("burger").encoders
    assert encoders is not None
    return {**figures, "encoders, part of a tick": _quantisation(encoders)}


def _quantisation(encoders: Encoders) -> dict[str, float]:
    angles = _rng().uniform(-100, 100, 20_000)
    per_turn = encoders.ticks_per_turn / (2 * np.pi)
    return _row([[ticks(encoders, (a, a))[0] - a * per_turn + 0.5] for a in angles], 1 / np.sqrt(12))


def _satellite() -> Figures:
    good, book = (msgspec.convert(PRESETS["gnss"][name], GnssSensor) for name in ("good", "book"))
    fixes = _fixes(good, 10_000)
    velocities = [fix.velocity for fix in fixes]
    enu = np.array([TANGENT.enu(fix.latitude, fix.longitude, fix.altitude) for fix in fixes])
    drift = np.array([TANGENT.enu(f.latitude, f.longitude, f.altitude) for f in _fixes(msgspec.structs.replace(book, hz=1.0), 20_000)])
    return {
        "gnss good, horizontal": _row(enu[:, :2], good.horizontal_noise),
        "gnss good, vertical": _row(enu[:, 2:], good.vertical_noise),
        "gnss good, speed": _row(velocities, good.speed_noise),
        "gnss book, horizontal a second": _row(np.diff(drift[:, :2], axis=0), 0.21),
        "gnss book, vertical a second": _row(np.diff(drift[:, 2:], axis=0), 0.40),
        "gnss book, horizontal at turn-on": _spread(lambda rng: _east(book, rng), book.horizontal_drift),
        "gnss book, horizontal after 1100 s": _spread(lambda rng: _east(book, rng, 1100), book.horizontal_drift),
    }


def _fixes(gnss: GnssSensor, count: int) -> list:  # type: ignore[type-arg]
    made = receiver(gnss, TANGENT, _rng())
    return [made.read(n / gnss.hz, np.zeros(3), np.zeros(3)) for n in range(1, count + 1)]


def _east(gnss: GnssSensor, rng: np.random.Generator, t: float = 1.0) -> float:
    fix = receiver(gnss, TANGENT, rng).read(t, np.zeros(3), np.zeros(3))
    return float(TANGENT.enu(fix.latitude, fix.longitude, fix.altitude)[0])


def _in_flight() -> Figures:
    """An aircraft's IMU in a steady turn, as fitted and as in the book: the sensors' errors, their biases left out."""
    fitted, book = _sensors("milvus").imu, msgspec.convert({"mount": {}, **PRESETS["imu"]["book"]}, ImuSensor)
    assert fitted is not None
    rates, force = np.array((0.1, -0.2, 0.3)), np.array((1.0, -2.0, 11.0))
    turning = AircraftMotion(np.zeros(3), np.zeros(3), IDENTITY, rates, force, 25.0)
    figures: Figures = {}
    for name, imu in (("milvus", fitted), ("book", book)):
        model = Imu(msgspec.structs.replace(imu, gyro_bias=0.0, accel_bias=0.0), FIELD, _rng())
        read = [r for n in range(1, 20_001) if (r := model.read(n / imu.hz, turning)) is not None]
        figures[f"{name} gyro"] = _row([r.angular_velocity - rates for r in read], imu.gyro_noise)
        figures[f"{name} accel"] = _row([r.specific_force - force for r in read], imu.accel_noise)
        figures[f"{name} mag"] = _row([r.magnetic_field - FIELD for r in read], imu.mag_noise)
    return figures


def _pressures() -> Figures:
    fitted, book = _sensors("milvus").air_data, msgspec.convert(PRESETS["air_data"]["book"], AirDataSensor)
    assert fitted is not None
    air = Air(97_000.0, 370.0, 285.0)
    figures: Figures = {}
    for name, sensor in (("milvus", fitted), ("book", book)):
        model = PressureSensors(msgspec.structs.replace(sensor, static_bias=0.0, differential_bias=0.0), _rng())
        read = [s.air for n in range(1, 20_001) if (s := model.read(n / sensor.hz, lambda: air))]
        static, differential = np.array([(a.static_pressure, a.differential_pressure) for a in read]).T
        figures[f"{name} static pressure"] = _row((static - air.static_pressure)[:, None], sensor.static_noise)
        figures[f"{name} differential pressure"] = _row((differential - air.differential_pressure)[:, None], sensor.differential_noise)
    static_bias = _spread(lambda rng: _first_pressure(book, rng) - air.static_pressure, book.static_bias)
    return figures | {"book static pressure at turn-on": static_bias}


def _first_pressure(sensor: AirDataSensor, rng: np.random.Generator) -> float:
    model = PressureSensors(msgspec.structs.replace(sensor, static_noise=0.0), rng)
    sample = model.read(1 / sensor.hz, lambda: Air(97_000.0, 370.0, 285.0))
    assert sample is not None
    return sample.air.static_pressure


def _range_finder() -> Figures:
    finder = RangeFinder(mount=Mount(), hz=20.0, range_min=0.1, range_max=50.0, noise=0.03)
    model = RangeModel(finder, ROOM, _rng())
    return {"range finder": _row([[model.range(STILL, []) - 2.0] for _ in range(5000)], finder.noise)}


def _depth() -> Figures:
    """The renderer's depth of the ground from 10 m straight above: no noise stated, so the row is its error in millimetres over 1."""
    camera = Camera(mount=Mount(), hz=5.0, width=160, height=120, fov=1.2, depth=True)
    renderer = BulletRenderer(WorldFile(about="plane", origin=Origin(0.0, 0.0), floor=(0.0, 0.0, 1.0, 1.0)), [], {})
    down = np.array((np.cos(np.pi / 4), 0.0, np.sin(np.pi / 4), 0.0))
    depth = renderer.take(camera, Pose(np.array((0.0, 0.0, 10.0)), down)).depth
    renderer.close()
    assert depth is not None
    return {
        "depth of the ground, mm": {"samples": depth.size, "mean": float((depth - 10.0).mean() * 1e3), "sigma": float(depth.std() * 1e3)}
    }


def _delivery() -> Figures:
    """Share of readings lost, and how late the others are [s]."""
    sensor = GnssSensor(10.0, dropout=0.02, burst=5, latency=0.12)
    line: DelayLine[float] = line_of(sensor, _rng())
    came = [t - taken for t in (n / 100 for n in range(1, 1_000_001)) if (taken := line.step(t, lambda t=t: t)) is not None]  # type: ignore[misc]
    lost, stated = 1 - (len(came) + 1) / 100_000, 0.1 / (0.1 + 0.98)
    return {
        "drop-outs, share": {"samples": 100_000, "sigma stated": stated, "sigma": lost, "ratio": lost / stated},
        "latency, s": {"samples": len(came), "mean": float(np.mean(came)), "sigma stated": 0.12, "sigma": float(np.max(came))},
    }


def allan(data: Path | None) -> Figures:
    """Overlapping Allan deviation of the burger's IMU over an hour at rest, against that of its stated errors."""
    figures: Figures = {}
    for name, errors, samples in _hour():
        hz = 100.0
        for tau in (0.1, 1.0, 10.0, 100.0):
            measured = [allan_deviation(axis, hz, [round(tau * hz)])[1][0] for axis in samples.T]
            sigma, stated = float(np.sqrt(np.mean(np.square(measured)))), float(expected(errors, hz, [tau])[0])
            figures[f"{name} Allan {tau:g} s"] = {"samples": len(samples), "sigma stated": stated, "sigma": sigma, "ratio": sigma / stated}
    return figures


def _hour() -> list[tuple[str, Errors, Floats]]:
    imu = _sensors("burger").imu
    assert imu is not None
    model = ImuModel(imu, FIELD, _rng())
    read = [model.read(n / imu.hz, STILL) for n in range(1, round(HOURS * 3600 * imu.hz) + 1)]
    rates, forces = np.array([r.angular_velocity for r in read]), np.array([r.specific_force for r in read])
    return [("gyro", gyro_errors(imu), rates), ("accel", accelerometer_errors(imu), forces)]


def plot(path: Path) -> None:
    """Measured deviation of each axis beside the stated one."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10, 4.5), layout="constrained")
    for axes, (name, errors, samples), unit in zip(figure.subplots(1, 2), _hour(), ("rad/s", "m/s²"), strict=True):
        for axis, label in zip(samples.T, "xyz", strict=True):
            taus, deviation = allan_deviation(axis, 100.0, octaves(len(axis)))
            axes.loglog(taus, deviation, ".-", linewidth=0.8, label=f"{name} {label}")
        axes.loglog(taus, expected(errors, 100.0, taus), "k--", label="stated")
        axes.set(xlabel="averaging time [s]", ylabel=f"Allan deviation [{unit}]", title=f"burger, {name}, {HOURS:g} h at rest")
        axes.grid(True, which="both", alpha=0.3)
        axes.legend()
    figure.savefig(path, dpi=110)


CASES = {"noise": noise, "allan": allan}

if __name__ == "__main__":
    plot(Path(sys.argv[1]))
