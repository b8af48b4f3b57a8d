"""``docs/reference/service-parameters.md``: the parameters of every service and SLAM method."""

from collections.abc import Iterator

from launch.docs.tables import table
from services.autopilot.ground.params import GroundAutopilotParams
from services.detector.detector_service import DetectorParams
from services.planner.params import PlannerParams
from services.planner.tracker_service import TrackerParams
from services.slam.elevation.elevation_service import ElevationParams
from services.slam.mapping_service import MappingParams
from services.slam.octree.octree_service import OctreeParams
from uvf.estimation.odometry.params import OdometryParams
from uvf.models.params import Params
from uvf.models.vehicle.flight_params import AirParams
from uvf.slam.localization.params import FilterParams
from uvf.slam.methods import METHODS

HEAD = """# Parameters of services

Generated from the `Params` of each service by `python -m launch.docs.pages`; do not edit.

A vehicle's file sets them by service, `params: {planner: {patience: 12.0}}`; what is left out has its default. A running service answers
`srv/params`; ground stations see those of the autopilots under [PX4's names](mavlink-parameters.md) as well.
"""
SERVICES: dict[str, tuple[type[Params], str]] = {
    "odometry": (OdometryParams, "Pose of a ground vehicle from wheels, gyroscope, accelerometer and satellites."),
    "mapping": (MappingParams, "Map of a ground vehicle, and its pose in it; the method's own parameters stand under its name."),
    "localization": (FilterParams, "Pose of a ground vehicle on a known map."),
    "octree": (OctreeParams, "3-D map; a vehicle that has this block gets one."),
    "elevation": (ElevationParams, "Heights of the ground below an aircraft; one that has this block maps them."),
    "detector": (DetectorParams, "Coloured markers in the pictures of a vehicle's camera; one that has this block looks for them."),
    "planner": (PlannerParams, "Exploration and paths of a ground vehicle."),
    "tracker": (TrackerParams, "Follows the path."),
    "autopilot_ground": (GroundAutopilotParams, "Modes and failsafes of a ground vehicle."),
    "autopilot_air": (AirParams, "Estimation, control, guidance, modes and failsafes of an aircraft."),
    **{name: (kind.params, f"SLAM method `{name}`; also `./uvf slam --set`.") for name, kind in METHODS.items() if name != "odometry"},
}


def render() -> str:
    """Renders the whole page."""
    return "\n".join((HEAD, *_sections())) + "\n"


def _sections() -> Iterator[str]:
    for name, (params, about) in SERVICES.items():
        if params.__struct_fields__:
            yield from (f"## `{name}` {{#{name}}}", "", about, "", *table(params, {}), "")
