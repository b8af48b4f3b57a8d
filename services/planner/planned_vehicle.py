"""What the planner has to know of its vehicle."""

from dataclasses import dataclass

from services.planner.scan_placing import ScanPlacer
from uvf.planning.costmap.footprint import RobotFootprint


@dataclass(frozen=True)
class PlannedVehicle:
    """Outline, lidar, speed on straight parts [m/s], and whether it explores."""

    footprint: RobotFootprint
    placer: ScanPlacer
    speed: float
    explores: bool
