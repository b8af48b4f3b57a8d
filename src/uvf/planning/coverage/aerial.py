"""A field surveyed from the air: the plan, how it is flown, and its mission items, from what the aircraft and its camera can."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from uvf.guidance.corners import CornerLimits
from uvf.models.mission.file import Waypoint
from uvf.models.vehicle.file import VehicleFile
from uvf.models.vehicle.flight_params import AirParams
from uvf.models.world.file import WorldFile
from uvf.models.world.terrain import relief
from uvf.planning.coverage.camera import SurveyCamera
from uvf.planning.coverage.field import CoverageField
from uvf.planning.coverage.ground_speed import GroundSpeed
from uvf.planning.coverage.mission import SurveyFlight, survey_mission
from uvf.planning.coverage.plan import CoveragePlan
from uvf.planning.coverage.planner import plan_coverage
from uvf.planning.coverage.task import CoverageTask
from uvf.planning.coverage.vehicles import SurveyAircraft

SETTLING = 1.5  # s, level on the swath's line before it begins
LEAVING = 0.2  # s, straight on behind it
GRID = 200  # places a side at which terrain is looked at


@dataclass(frozen=True)
class AerialTask:
    """What is to be flown. height: of the flight [m, world]; width: between swaths [m]; trigger: between pictures [m].

    airspeed: m/s, 0: the aircraft's cruise; wind: [m/s] to the east and north; direction: of the swaths [rad from east], None: the best.
    """

    height: float
    width: float
    trigger: float
    airspeed: float = 0.0
    wind: tuple[float, float] = (0.0, 0.0)
    direction: float | None = None
    seed: int = 1


class AerialSurvey(NamedTuple):
    """A planned survey."""

    plan: CoveragePlan
    flight: SurveyFlight
    items: list[Waypoint]


def plan_aerial(field: CoverageField, task: AerialTask, params: AirParams) -> AerialSurvey:
    """The survey of a field. Raises ValueError, also where nothing of the field is worth a swath."""
    airspeed = task.airspeed or params.trim_airspeed
    turns = CornerLimits(airspeed, (task.wind[1], task.wind[0]), params.turn_bank, params.roll_in)
    fastest = airspeed + math.hypot(*task.wind)
    leads = SETTLING * fastest, LEAVING * fastest
    aircraft = SurveyAircraft(GroundSpeed(airspeed, task.wind), turns.radius, leads[0] + turns.ramp / 2, leads[1] + turns.ramp / 2)
    plan = plan_coverage(CoverageTask(field, task.width, direction=task.direction, seed=task.seed), aircraft)
    if len(plan.swaths) == 0:
        raise ValueError(f"nothing of it is worth a swath {task.width:.1f} m wide; give a smaller spacing")
    flight = SurveyFlight(task.height, task.trigger, task.airspeed, *leads)
    return AerialSurvey(plan, flight, survey_mission(plan, flight))


def own_camera(file: VehicleFile) -> SurveyCamera | None:
    """The vehicle's gimbal or camera, taken as looking straight down; None where it has neither."""
    found = file.sensors.gimbal or file.sensors.camera
    if found is None:
        return None
    return SurveyCamera(found.fov, 2 * math.atan(math.tan(found.fov / 2) * found.height / found.width))


def highest_ground(world: WorldFile, low: tuple[float, float], high: tuple[float, float]) -> float:
    """The highest ground [m, world frame] in the rectangle from ``low`` to ``high`` [m], looked at on a grid; 0 on flat ground."""
    terrain = relief(world)
    if terrain is None:
        return 0.0
    heights, _ = terrain.at(*np.meshgrid(np.linspace(low[0], high[0], GRID), np.linspace(low[1], high[1], GRID)))
    return float(heights.max())
