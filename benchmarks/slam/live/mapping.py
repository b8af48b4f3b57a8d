"""A rover maps a world live: every service in its own process, over Zenoh, at real time. Its map and pose against the truth.

It explores house, and drives through all rooms of watkins by waypoints, where a pallet is lower than its lidar.
Walls are those that a lidar at its height meets, and the map lies where the start pose of the mission has it: nothing is aligned.
``floor %``: of the floor that the rover can reach, how much the map knows. Errors are those of ``nav/pose`` against the true pose.
``slam core %``: CPU time of the process of odometry and mapping, with all that it hears and says, in parts of simulated time;
``odometry core %`` and ``mapping core %``: the steps of each alone, fed from the log of the same run. ``x real time`` below 0.98: the
machine had too little to spare; late steps may then have been skipped. Pictures are put into ``runs/slam_live``.
"""

import tempfile
import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np
import yaml
from numpy.typing import NDArray

from benchmarks.measuring.timing import stopwatch
from benchmarks.slam.live.picture import Shown, draw
from launch import catalogue, settings
from launch.apart import apart
from launch.commands.bench import Figures
from launch.scoring.truth import true_poses, within
from schemas import topics
from schemas.messages import PoseInFrame
from services.slam.map_server import in_world
from uvf.client import Client
from uvf.maths.se2 import IDENTITY
from uvf.maths.se2_arrays import interpolated, wrapped
from uvf.models.scenario import Scenario, load_scenario
from uvf.models.world.geometry import floor_plan, floor_segments, reachable_floor, section
from uvf.models.world.map_file import GridMap
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.interface import LocalBus, Sample
from uvf.runtime.contract.service_runner import ServiceRunner
from uvf.runtime.log.laser_log import samples_of
from uvf.runtime.log.replay import hand_over, play
from uvf.runtime.messages.convert import seconds, yaw_of
from uvf.runtime.messages.maps.grids import as_map
from uvf.slam.maps.quality import score

Floats = NDArray[np.float64]
Row = dict[str, float]

VEHICLE, SLAM = "rover", "slam"
STARTS = {"house": (2.2, 1.3, 0.5), "watkins": (1.0, 1.2, 0.0)}
TOUR = (
    *((4.0, 1.3), (4.0, 3.4), (8.3, 3.5), (8.3, 8.6), (4.5, 8.6), (0.9, 8.6), (0.9, 13.4), (4.5, 13.4), (8.2, 13.2), (8.3, 8.8)),
    *((10.2, 8.8), (12.3, 9.4), (14.7, 9.2), (14.7, 11.5), (16.4, 11.5), (16.4, 10.2), (18.4, 9.9), (16.4, 10.6), (16.4, 11.5)),
    *((14.7, 11.5), (14.6, 8.6), (14.4, 6.0), (12.9, 3.9), (12.2, 1.3), (17.8, 1.4), (17.8, 4.2), (17.4, 6.8), (17.8, 1.4)),
    *((10.0, 1.0), (1.5, 1.2)),
)
"""m, through all rooms of watkins, past a pallet that its lidar looks over."""
JOBS: dict[str, dict[str, object]] = {"house": {"explore": True}, "watkins": {"mission": [{"x": x, "y": y} for x, y in TOUR]}}
DURATIONS = {"house": 240.0, "watkins": 265.0}  # s: all rooms have been seen
BEGUN = 5.0  # s, from which on CPU time counts
PLAN_CELL = 0.02  # m
PATIENCE = 4.0  # times as long as a run should take


def live(world: str, data: Path | None) -> Figures:
    """Drives one world live and judges the run; its picture is put into ``runs/slam_live``."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        site = load_scenario(mission(world, folder))
        with apart(site.mission_path, folder) as client:
            costs = driven(client, DURATIONS[world])
        run = Run(list(samples_of((folder / "latest").resolve())))
    row = run.errors() | run.of_map(site) | costs | run.steps(site)
    pictures = settings.runs_folder() / "slam_live"
    pictures.mkdir(parents=True, exist_ok=True)
    draw(Shown(run.grid(), floor_segments(site.world, lidar_height(site)), run.truth, run.poses), world, pictures / f"{world}.png")
    return {world: row}


def mission(world: str, folder: Path) -> Path:
    """Writes the mission of one rover into the folder."""
    x, y, yaw = STARTS[world]
    rover = {"model": "burger", "system_id": 1, "start": {"x": x, "y": y, "yaw": yaw}, "job": JOBS[world]}
    path = folder / f"{world}.yaml"
    path.write_text(yaml.safe_dump({"about": "A rover maps.", "world": world, "seed": 1, "vehicles": {VEHICLE: rover}}))
    return path


def driven(client: Client, duration: float) -> Row:
    """Waits for the end; what that has cost."""
    health = topics.HEALTH.by(SLAM)
    client.wait(lambda: client.time > BEGUN, PATIENCE * BEGUN, "time stands")
    begun, first, wall = client.time, client.read(topics.SYSTEM, health), time.monotonic()
    client.wait(lambda: client.time > duration, PATIENCE * duration, "time stands")
    last = client.read(topics.SYSTEM, health)
    core = (last.cpu_time - first.cpu_time) / (seconds(last.timestamp) - seconds(first.timestamp))
    return {
        "slam core %": 100.0 * core,
        "x real time": (client.time - begun) / (time.monotonic() - wall),
        "skipped": float(last.skipped - first.skipped),
    }


class Run:
    """What the log of a run tells. Only what judges it may read the truth."""

    def __init__(self, samples: Sequence[Sample]) -> None:
        self._samples = samples
        self.truth = true_poses(samples, VEHICLE)
        self.poses = np.array([_row(message) for message in self._all(topics.POSE)]).reshape(-1, 4)
        """(n, 4) t [s], x, y [m], yaw [rad] in the world frame, as ``truth``."""

    def _all(self, topic: topics.Topic[topics.M]) -> list[topics.M]:
        return [topic.message.FromString(s.payload) for s in self._samples if s.key == topic.at(VEHICLE)]

    def grid(self) -> GridMap:
        """The last one, in the world frame. Raises BadInput without any."""
        maps, places = self._all(topics.MAP), self._all(topics.TF_WORLD)
        if not maps or not places:
            raise BadInput(f"the log of the run holds no map of '{VEHICLE}', or not where it lies")
        return in_world(as_map(maps[-1]), places[-1])

    def errors(self) -> Row:
        """Of the poses that were told while the truth is known. Raises BadInput without any."""
        if not len(self.poses) or not len(self.truth):
            raise BadInput(f"the log of the run holds no poses of '{VEHICLE}', or not the true ones")
        told = self.poses[within(self.truth, self.poses[:, 0])]
        off = told[:, 1:] - interpolated(self.truth, told[:, 0])
        distances, turns = np.hypot(off[:, 0], off[:, 1]), wrapped(off[:, 2])
        return {
            "RMSE m": float(np.sqrt((distances**2).mean())),
            "RMSE deg": float(np.degrees(np.sqrt((turns**2).mean()))),
            "max m": float(distances.max()),
            "driven m": float(np.hypot(*np.diff(self.truth[:, 1:3], axis=0).T).sum()),
        }

    def of_map(self, site: Scenario) -> Row:
        """Walls and floor of the last map against the world: detections, distances [m], shares [%]."""
        start, member = site.members[VEHICLE].entry.start, site.members[VEHICLE]
        radius = member.file.ground.radius if member.file.ground else 0.0
        floor = reachable_floor(floor_plan(site.world, PLAN_CELL), start.x, start.y, radius)
        seen = score(self.grid(), section(site.world, PLAN_CELL, lidar_height(site)), IDENTITY, floor)
        fine, coarse = seen.walls.detections
        return {
            "F1 5 cm": fine.f1,
            "F1 10 cm": coarse.f1,
            "walls off 95 % m": seen.walls.to_true[1],
            "double walls": float(seen.double_walls),
            "floor %": 100.0 * (1.0 - seen.unknown),
        }

    def steps(self, site: Scenario) -> Row:
        """CPU of the services' steps alone."""
        end, row = max(s.stamp_ns for s in self._samples), {}
        for host in catalogue.hosts(site, [catalogue.kind(SLAM)]):
            bus = LocalBus()
            shell = ServiceRunner(host, bus)
            read = {declared.topic.at(owner) for _, declared, owner in shell.reads()}
            feed = [s for s in self._samples if s.key in read]
            with stopwatch() as taken:
                for _ in play(shell, feed, partial(hand_over, bus)):
                    pass
            row[f"{host.service.name} core %"] = 100.0 * taken[0] / (end / 1e9)
        return row


def lidar_height(site: Scenario) -> float:
    """m above the floor."""
    lidar = site.members[VEHICLE].file.sensors.lidar
    return lidar.mount.xyz[2] if lidar is not None else 0.0


def _row(message: PoseInFrame) -> tuple[float, float, float, float]:
    pose = message.pose
    return seconds(message.timestamp), pose.position.x, pose.position.y, yaw_of(pose.orientation)


CASES = {world: partial(live, world) for world in STARTS}
