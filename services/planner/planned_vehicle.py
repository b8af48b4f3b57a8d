"""What the planner has to know of its vehicle."""

from dataclasses import dataclass

from services.planner.obstacle_sensors import ObstacleSensors
from uvf.planning.costmap.footprint import RobotFootprint


@dataclass(frozen=True)
class PlannedVehicle:
    """Outline, sensors, speed on straight parts [m/s], and whether it explores.

    turning_radius: of its tightest circle [m], 0: it turns on the spot.
    """

    footprint: RobotFootprint
    sensors: ObstacleSensors
    speed: float
    explores: bool
    name: str
    turning_radius: float = 0.0
