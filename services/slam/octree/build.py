"""A map in space for every vehicle whose file has ``params: octree:``."""

from functools import partial

import numpy as np

from services.slam.octree.octree_service import OctreeParams, OctreeService
from uvf.models.scenario import MissionVehicle, Scenario
from uvf.models.whole_file import write_whole
from uvf.models.yaml_data import BadInput
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.state.state_folder import state_folder
from uvf.slam.octree.columns import columns_of
from uvf.slam.octree.files import read_octree, to_bt
from uvf.slam.octree.leaves import leaves_of
from uvf.slam.octree.octree import Octree


def build(site: Scenario) -> list[ServiceInstance]:
    """The octree service of each vehicle that asks for a map. Raises BadInput for one without a suitable sensor."""
    members = [member for member in site.members.values() if OctreeService.name in member.file.params]
    if members:
        _warm_up()
    return [_host(member) for member in members]


def _host(member: MissionVehicle) -> ServiceInstance:
    sensors = member.file.sensors
    if sensors.lidar is None and (sensors.camera is None or not sensors.camera.depth):
        path = member.folder / "vehicle.yaml"
        raise BadInput(f"{path}: params: octree: no sensor to map with; fit a lidar, or a camera with 'depth: true'")
    params = member.params(OctreeService.name, OctreeParams)
    return ServiceInstance(OctreeService, lambda: OctreeService(sensors, partial(_keep, member.name), params), member.name)


def _keep(vehicle: str, name: str, content: bytes) -> str:
    path = state_folder() / "maps" / f"{vehicle}-{name}.bt"
    write_whole(path, content)
    return str(path)


def _warm_up() -> None:
    """Compiles the kernels, or loads them from their cache, before the first picture."""
    octree = Octree(0.1)
    octree.insert(np.zeros(3), np.eye(3), 0.5)
    octree.insert(np.zeros(3), np.eye(3))
    octree.cast(np.zeros((1, 3)), np.eye(3)[:1])
    read_octree(to_bt(leaves_of(octree), octree.resolution), "")
    columns_of(octree, 0.0, 1.0, 1000)
