"""Planner and tracker for every ground vehicle of the mission."""

import numpy as np

from services.planner.obstacle_sensors import ObstacleSensors
from services.planner.params import PlannerParams
from services.planner.planned_vehicle import PlannedVehicle
from services.planner.planner_service import PlannerService
from services.planner.scan_placing import PlacedLidar, ScanPlacer
from services.planner.tracker_service import FARTHEST, TrackerParams, TrackerService
from uvf.maths.kinematics import Twist
from uvf.maths.se2 import Pose2
from uvf.models.scenario import MissionVehicle, Scenario
from uvf.models.urdf.model import load_urdf
from uvf.models.urdf.outline import highest, plan_outline
from uvf.models.urdf.robot import UrdfModel
from uvf.models.vehicle.file import GroundBody
from uvf.models.yaml_data import BadInput
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.inflation import Inflation
from uvf.planning.global_planner import GlobalPlanner, PlannedBody
from uvf.planning.local.controller import ControllerSettings, LocalController
from uvf.planning.local.mppi import Mppi, MppiSettings
from uvf.planning.local.planner import STOP, Limits
from uvf.planning.local.swept_stop import safe_share
from uvf.runtime.contract.instances import ServiceInstance
from uvf.sensors.fitted import base_from_sensor, sweeping_of

STEERS = ("mppi", "dwa", "trajectory_rollout")
"""Local planners that look only at what the vehicle can drive."""


def build(site: Scenario) -> list[ServiceInstance]:
    """The planner and tracker of each ground vehicle. Raises BadInput for a vehicle without lidar."""
    members = list(site.of_kind("ground"))
    if members:
        _warm_up()
    return [host for member in members for host in _hosts(member)]


def _hosts(member: MissionVehicle) -> list[ServiceInstance]:
    start, body, sensors = member.entry.start, member.file.ground, member.file.sensors
    if body is None or sensors.lidar is None:
        raise BadInput(f"{member.folder / 'vehicle.yaml'}: the planner needs 'ground:' and sensors: lidar")
    world_from_map = Pose2(start.x, start.y, start.yaw)
    model = load_urdf(member.folder / body.urdf)
    footprint, top = _footprint(model, body), max(highest(model), *(lidar.mount.xyz[2] for lidar in sensors.lidars))
    planner, tracker = member.params("planner", PlannerParams), member.params("tracker", TrackerParams)
    speed, tightest = min(tracker.speed, body.max_linear), body.drive.kinematics.turning_radius
    if tightest and tracker.local_planner not in STEERS:
        raise BadInput(
            f"{member.folder / 'vehicle.yaml'}: local planner {tracker.local_planner} turns on the spot, which a car cannot; "
            f"take {', '.join(STEERS)}"
        )

    def sensors_of() -> ObstacleSensors:
        lidars = {f"{member.name}/{each.frame}": PlacedLidar(base_from_sensor(each.mount), sweeping_of(each)) for each in sensors.lidars}
        placer = ScanPlacer(lidars, FARTHEST)
        return ObstacleSensors(placer, footprint, sensors, top)

    def planner_service() -> PlannerService:
        vehicle = PlannedVehicle(footprint, sensors_of(), speed, member.entry.job.explore, member.name, tightest)
        return PlannerService(world_from_map, vehicle, planner)

    def tracker_service() -> TrackerService:
        return TrackerService(member.name, (body, footprint), sensors_of(), tracker)

    return [ServiceInstance(PlannerService, planner_service, member.name), ServiceInstance(TrackerService, tracker_service, member.name)]


def _footprint(model: UrdfModel, body: GroundBody) -> RobotFootprint:
    """The outline of the URDF's collision shapes, or the circle of vehicle.yaml where it has none."""
    outline = plan_outline(model)
    return RobotFootprint.circle(body.radius) if outline is None else RobotFootprint.polygon(outline)


def _warm_up() -> None:
    """Compiles the kernels, or loads them from their cache, before the first step."""
    footprint = RobotFootprint.circle(0.1)
    planner = GlobalPlanner(PlannedBody(footprint, Inflation(0.3, 5.0)))
    planner.see(np.zeros((20, 20), dtype=np.int8), (0.05, (0.0, 0.0)))
    planner.plan((0.2, 0.2), (0.8, 0.8))
    planner.refusal((0.2, 0.2), (0.8, 0.8))
    limits, box = (
        Limits(-0.1, 0.2, 1.0, 1.0, 2.0, 1.0),
        RobotFootprint.polygon(np.array(((0.1, 0.1), (-0.1, 0.1), (-0.1, -0.1), (0.1, -0.1)))),
    )
    angles = np.linspace(-3.0, 3.0, 60)
    rays, ranges = np.column_stack((np.cos(angles), np.sin(angles))), np.ones(60)
    for outline in (footprint, box):
        controller = LocalController(outline, limits, Mppi(limits, outline, MppiSettings(samples=200)), ControllerSettings())
        for t in (0.0, 0.1):
            controller.see(t, Pose2(0.0, 0.0, 0.0), (0.0, 0.0), rays, ranges)
        controller.drive(Pose2(0.0, 0.0, 0.0), STOP, np.array(((0.0, 0.0), (0.5, 0.0))))
    safe_share(np.array(((0.2, 0.0),)), Twist(0.5, 0.1), box, 0.01, (0.3, 1.0, 1.0))
