"""Planner and tracker for every ground vehicle of the mission."""

from math import hypot

import numpy as np

from services.planner.planner_service import PlannerParams, PlannerService
from services.planner.tracker_service import TrackerParams, TrackerService
from uvf.maths.rotations import from_euler
from uvf.maths.se2 import Pose2
from uvf.maths.se3 import Transform
from uvf.models.scenario import MissionVehicle, Scenario
from uvf.models.yaml_data import BadInput
from uvf.planning.collision_check import safe_share
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import Inflation
from uvf.planning.global_planner import GlobalPlanner, PlannedBody
from uvf.runtime.contract.instances import ServiceInstance
from uvf.sensors.fitted import sweeping_of


def build(site: Scenario) -> list[ServiceInstance]:
    """The planner and tracker of each ground vehicle. Raises BadInput for a vehicle without lidar."""
    members = list(site.of_kind("ground"))
    if members:
        _warm_up()
    return [host for member in members for host in _hosts(member)]


def _hosts(member: MissionVehicle) -> list[ServiceInstance]:
    start, body, lidar = member.entry.start, member.file.ground, member.file.sensors.lidar
    if body is None or lidar is None:
        raise BadInput(f"{member.folder / 'vehicle.yaml'}: the planner needs 'ground:' and sensors: lidar")
    world_from_map = Pose2(start.x, start.y, start.yaw)
    base_from_lidar = Transform(from_euler(*lidar.mount.rpy), np.array(lidar.mount.xyz))
    planner = member.params("planner", PlannerParams)
    tracker = member.params("tracker", TrackerParams)
    return [
        ServiceInstance(
            PlannerService,
            lambda: PlannerService(world_from_map, body.radius, member.entry.job.explore, planner, hypot(*lidar.mount.xyz[:2])),
            member.name,
        ),
        ServiceInstance(TrackerService, lambda: TrackerService(body, base_from_lidar, tracker, sweeping_of(lidar)), member.name),
    ]


def _warm_up() -> None:
    """Compiles the kernels, or loads them from their cache, before the first step."""
    navigator = GlobalPlanner(PlannedBody(RobotFootprint.circle(0.1), Inflation(0.3, 5.0)))
    navigator.see(np.zeros((20, 20), dtype=np.int8), (0.05, (0.0, 0.0)))
    navigator.plan((0.2, 0.2), (0.8, 0.8))
    navigator.refusal((0.2, 0.2), (0.8, 0.8))
    safe_share(np.ones((1, 2)), (0.1, 0.1), 0.1, (0.1, 1.0))
