"""A rover whose lidar of 5 Hz takes 0.2 s for a sweep, on figures of eight: errors with de-skewing and without.

One run in lockstep, in a room of the house. Its log is mapped by the default method thrice: de-skewed, as ``uvf slam`` reads it; with
all beams taken at the stamp, the first beam's; and at the middle of the sweep, the best that one moment can do. ``points off``: from
what the beams of all sweeps hit, seen from the true pose of that moment, to the nearest true surface, so that nothing but the sweep
counts; ``map off``: the same of the final keyframes from the poses of the method; RMSE: of its final poses. ``live`` is the fix of
the mapping service in the run itself. ``cost``: CPU time of a sweep in parts of that of a scan at once, in the simulator's model.
"""

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
import yaml
from numpy.typing import NDArray

from benchmarks.measuring.timing import stopwatch
from launch.attachments import attachments
from launch.commands.bench import Figures
from launch.commands.slam import DEFAULT_METHOD
from launch.scoring.truth import true_poses
from schemas import topics
from schemas.messages import MapFix, WheelCommand
from services.sim_ground.body import BodyState
from services.sim_ground.build import build as simulator
from services.slam.build import build as slam
from uvf.maths.kinematics import DifferentialDrive, Twist, WheelSpeeds
from uvf.maths.rotations import from_euler
from uvf.maths.se2 import Pose2
from uvf.maths.se2_arrays import composed, interpolated, inverted, wrapped
from uvf.models.scenario import ROOT, Scenario, load_scenario
from uvf.models.shapes.scene import scene
from uvf.models.vehicle.sensors import Lidar
from uvf.models.world.geometry import floor_segments, solids
from uvf.runtime.contract.declaration import Reads, Writes, topic
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service import Service
from uvf.runtime.log.laser_log import read_mcap
from uvf.runtime.log.reading import read_log
from uvf.runtime.log.recording import Recorder
from uvf.runtime.messages.convert import seconds, stamp
from uvf.runtime.time.lockstep import Lockstep
from uvf.sensors.range_sensors import LidarModel
from uvf.slam.evaluation.run import run_over
from uvf.slam.logs.laser_log import LaserLog
from uvf.slam.methods import make_method, method_params
from uvf.slam.reading import Reading

Floats = NDArray[np.float64]

VEHICLE, WORLD = "rover", "house"
START = {"x": 9.5, "y": 7.0, "yaw": 0.0}  # in the guest room, with 1.25 m about it
SWEEP = 0.2  # s
PACES = {"fast": Twist(0.5, 1.5), "slow": Twist(0.25, 0.75)}  # m/s, rad/s: of the same loops
SECONDS = 40.0
SCANS = 200
ROW_POINTS = 20_000  # at most, of which distances are worked out


class Eights(Service):
    """Stands for a second, then a loop to the left, one to the right, and so on."""

    name, hz = "driver", 50.0

    class Outputs(Writes):
        wheels: WheelCommand = topic(topics.WHEEL_COMMAND)

    def __init__(self, drive: DifferentialDrive, pace: Twist) -> None:
        self._drive = drive
        self._pace = pace

    def step(self, t: float, now: Reads) -> Outputs:
        """Stands for a second, then drives turns to the left and to the right."""
        side = 1.0 if (t - 1.0) * self._pace.angular // (2 * np.pi) % 2 == 0 else -1.0
        left, right = self._drive.wheels(Twist(self._pace.linear, side * self._pace.angular) if t > 1.0 else Twist(0.0, 0.0))
        return self.Outputs(wheels=WheelCommand(timestamp=stamp(t), left=left, right=right))


def slow_site(folder: Path, clockwise: bool = False) -> Scenario:
    """The burger, whose lidar takes its time, in the house; its files are below ``folder``."""
    for name in ("missions", "vehicles/slow"):
        (folder / name).mkdir(parents=True)
    (folder / "worlds").symlink_to(ROOT / "worlds")
    (folder / "vehicles" / "burger").symlink_to(ROOT / "vehicles" / "burger")
    sensors = {"lidar": {"sweep_time": SWEEP, "clockwise": clockwise}}
    vehicle = {"variant_of": "burger", "about": "A burger with a slow lidar.", "sensors": sensors}
    (folder / "vehicles/slow/vehicle.yaml").write_text(yaml.safe_dump(vehicle))
    entry = {"model": "slow", "system_id": 1, "start": START}
    mission = {"about": "Eights.", "world": WORLD, "seed": 1, "vehicles": {VEHICLE: entry}}
    (folder / "missions/slow.yaml").write_text(yaml.safe_dump(mission))
    return load_scenario(folder / "missions/slow.yaml", folder)


def driven(site: Scenario, pace: Twist, duration: float, log: Path) -> None:
    """Drives for ``duration`` [s] in lockstep with mapping, and leaves the log."""
    ground = site.members[VEHICLE].file.ground
    assert ground is not None
    drive = ground.drive.kinematics
    lockstep = Lockstep([*simulator(site), *slam(site), ServiceInstance(Eights, lambda: Eights(drive, pace), VEHICLE)])
    with Recorder(log, attachments(site)) as recorder:
        recorder.follow(lockstep.bus)
        lockstep.run(duration)
    lockstep.close()


def without_files(log: Path) -> Path:
    """The same messages, from which nobody can tell how long a sweep takes."""
    bare = log.with_name(f"bare-{log.name}")
    with Recorder(bare) as recorder:
        for sample in read_log(log):
            recorder.write(sample)
    return bare


def at_the_middle(log: LaserLog) -> LaserLog:
    """All beams taken to be measured half a sweep after the stamp."""
    assert log.odometry is not None
    (x, y, yaw), stamps = log.odometry.odom_from_base.T, log.stamps + SWEEP / 2
    poses = interpolated(np.column_stack((log.odometry.t, x, y, np.unwrap(yaw))), stamps)
    readings = [
        Reading(s, r.ranges, r.beams, Pose2(*pose)) for s, r, pose in zip(stamps.tolist(), log.readings, poses.tolist(), strict=True)
    ]
    return replace(log, readings=readings, stamps=stamps)


@dataclass(frozen=True)
class Truth:
    """track: (n, 4) t, x, y, yaw without leaps; walls: (m, 2, 2) [m, world], at the lidar's height."""

    track: Floats
    walls: Floats

    def at(self, stamps: Floats) -> Floats:
        """(k, 3) x, y [m], yaw [rad] at stamps [s]."""
        return interpolated(self.track, stamps)

    def off(self, readings: Sequence[Reading], world_from_base: Floats) -> tuple[float, float]:
        """m, mean and 95th percentile: from what was hit to the nearest surface."""
        found = []
        for reading, pose in zip(readings, world_from_base, strict=True):
            hit = reading.beams.directions[reading.returned] * reading.ranges[reading.returned, None] + np.array(reading.beams.origin)
            found.append(composed(pose, np.column_stack((hit, np.zeros(len(hit)))))[:, :2])
        points = np.concatenate(found)
        distances = _to_segments(points[:: -(-len(points) // ROW_POINTS)], self.walls)
        return float(distances.mean()), float(np.quantile(distances, 0.95))


def _to_segments(points: Floats, walls: Floats) -> Floats:
    """(n,) m from points (n, 2) to the nearest of (m, 2, 2)."""
    nearest = np.full(len(points), np.inf)
    for a, b in walls:
        way = b - a
        share = np.clip((points - a) @ way / max(float(way @ way), 1e-12), 0.0, 1.0)
        nearest = np.minimum(nearest, np.hypot(*(points - a - share[:, None] * way).T))
    return nearest


def truth_of(log: Path, site: Scenario) -> Truth:
    """The true way of a log, and the floor's true walls at the height of the lidar."""
    return Truth(true_poses(read_log(log), VEHICLE), floor_segments(site.world, lidar_of(site).mount.xyz[2]))


def lidar_of(site: Scenario) -> Lidar:
    """The rover's."""
    lidar = site.members[VEHICLE].file.sensors.lidar
    assert lidar is not None
    return lidar


def row_of(log: LaserLog, truth: Truth) -> dict[str, float]:
    """Distances of points and map from the true walls, and RMSE of the poses [m, deg], of a log mapped anew."""
    true = truth.at(log.stamps)
    run = run_over(log, make_method(DEFAULT_METHOD, method_params(DEFAULT_METHOD, {}, "defaults")))
    frames = np.array([k.map_from_base for k in run.keyframes])
    points, drawn = truth.off(log.readings, true), truth.off([k.reading for k in run.keyframes], composed(true[0], frames))
    figures = {"points off m": points[0], "points off 95 % m": points[1], "map off m": drawn[0], "map off 95 % m": drawn[1]}
    return figures | _rmse(composed(inverted(true[0]), true), run.final)


def _rmse(true: Floats, told: Floats) -> dict[str, float]:
    off = told - true
    metres, turn = float(np.sqrt((off[:, :2] ** 2).sum(axis=1).mean())), float(np.sqrt((wrapped(off[:, 2]) ** 2).mean()))
    return {"RMSE m": metres, "RMSE deg": float(np.degrees(turn))}


def live_row(log: Path, truth: Truth) -> dict[str, float]:
    """Of each fix as it was told; the map begins at the start pose."""
    fixes = [MapFix.FromString(s.payload) for s in read_log(log) if s.key == topics.MAP_POSE.at(VEHICLE)]
    true = truth.at(np.array([seconds(f.timestamp) for f in fixes]))
    start = np.array((START["x"], START["y"], START["yaw"]))
    return _rmse(composed(inverted(start), true), np.array([(f.x, f.y, f.yaw) for f in fixes]))


def errors(name: str, data: Path | None = None, duration: float = SECONDS) -> Figures:
    """A row each for the log de-skewed, at the middle, at the stamp, and for the live fix, at one pace."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        site, log = slow_site(folder), folder / "run.mcap"
        driven(site, PACES[name], duration, log)
        truth, skewed = truth_of(log, site), read_mcap(without_files(log))
        logs = {"de-skewed": read_mcap(log), "at the middle": at_the_middle(skewed), "at the stamp": skewed}
        rows = {way: row_of(each, truth) for way, each in logs.items()} | {"live": live_row(log, truth)}
        return {f"{name}, {way}": row for way, row in rows.items()}


def cost(data: Path | None = None) -> Figures:
    """Turning on the spot in the house; scans and sweeps one after the other."""
    with tempfile.TemporaryDirectory() as name:
        site = slow_site(Path(name))
    model = LidarModel(lidar_of(site), scene(solids(site.world)), np.random.default_rng(1))
    still, place = np.zeros(3), np.array((START["x"], START["y"], 0.0))
    taken = {"scan": 0.0, "sweep": 0.0}
    for k in range(1, 20 * SCANS + 1):
        t = 0.01 * k
        body = BodyState(place, from_euler(0.0, 0.0, PACES["fast"].angular * t), still, still, (0.0, 0.0), WheelSpeeds(0.0, 0.0))
        with stopwatch() as kept:
            model.track.add(t, body)
        taken["sweep"] += kept[0] * (k > 20)
        if k % 20 == 0:
            with stopwatch() as swept:
                model.sweep(t, [])
            with stopwatch() as scanned:
                model.scan(body, [])
            taken["sweep"] += swept[0] * (k > 20)  # what is compiled is compiled
            taken["scan"] += scanned[0] * (k > 20)
    each = {f"{name} ms": 1e3 * total / (SCANS - 1) for name, total in taken.items()}
    return {"cost": each | {"sweep / scan": taken["sweep"] / taken["scan"]}}


CASES = {**{name: partial(errors, name) for name in PACES}, "cost": cost}
