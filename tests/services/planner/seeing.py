"""The sensors of a vehicle under test: a lidar, and what else a test gives it."""

from services.planner.obstacle_sensors import ObstacleSensors
from services.planner.scan_placing import PlacedLidar, ScanPlacer
from services.planner.tracker_service import FARTHEST
from uvf.maths.se3 import IDENTITY
from uvf.models.vehicle.sensors import Sensors
from uvf.sensors.sweeping import AT_ONCE

TOP = 0.3
"""m, height of the vehicle."""
NO_OTHERS = Sensors()
NOTHING_ELSE = {"depth": [], "info": None, "sonar": [], "contact": [], "range": []}


def sensors_of(footprint, base_from_lidar=IDENTITY, sweeping=AT_ONCE, sensors=NO_OTHERS):
    return ObstacleSensors(ScanPlacer({"": PlacedLidar(base_from_lidar, sweeping)}, FARTHEST), footprint, sensors, TOP)
