"""A map of heights for every aircraft whose file, or mission, has ``params: elevation:``."""

import numpy as np

from services.slam.elevation.elevation_service import ElevationParams, ElevationService
from services.slam.octree.octree_service import OctreeService
from uvf.models.scenario import MissionVehicle, Scenario
from uvf.models.yaml_data import BadInput
from uvf.runtime.contract.instances import ServiceInstance
from uvf.slam.elevation.elevation_map import ElevationMap


def build(site: Scenario) -> list[ServiceInstance]:
    """The elevation map of each aircraft that asks for one. Raises BadInput for a vehicle that cannot draw one."""
    members = [member for member in site.members.values() if ElevationService.name in member.file.params]
    if members:
        ElevationMap(0.25, 0.5).insert(np.zeros((1, 3)))  # compiles the kernel, or loads it from its cache
    return [_host(member) for member in members]


def _host(member: MissionVehicle) -> ServiceInstance:
    place, lidar = f"{member.folder / 'vehicle.yaml'}: params: elevation", member.file.sensors.lidar
    if member.file.kind != "fixed_wing":
        raise BadInput(f"{place}: a map of heights is drawn from the air; a ground vehicle may have an octree")
    if lidar is None:
        raise BadInput(f"{place}: no sensor to map with; fit a lidar that looks down")
    if OctreeService.name in member.file.params:
        raise BadInput(f"{place}: an octree tells heights, too; leave one of the two out")
    params = member.params(ElevationService.name, ElevationParams)
    return ServiceInstance(ElevationService, lambda: ElevationService(lidar, params), member.name)
