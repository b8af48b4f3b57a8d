"""Odometry and mapping for every ground vehicle of the mission."""

import numpy as np

from services.slam.correlative import search
from services.slam.mapper import Mapper, Scan
from services.slam.mapping_service import MappingParams, MappingService
from services.slam.odometry_service import OdometryParams, OdometryService
from uvf.maths.planar import IDENTITY, Pose2
from uvf.runtime.params import BadInput
from uvf.runtime.site import Host, Member, Site


def build(site: Site) -> list[Host]:
    """Raises BadInput for a vehicle without lidar or wheel encoders."""
    members = list(site.of_kind("ground"))
    if members:
        _warm_up()
    return [host for member in members for host in _hosts(member)]


def _hosts(member: Member) -> list[Host]:
    start, sensors = member.entry.start, member.file.sensors
    lidar = sensors.lidar
    if lidar is None or sensors.encoders is None:
        path, missing = member.folder / "vehicle.yaml", "lidar" if lidar is None else "encoders"
        raise BadInput(f"{path}: sensors: no {missing}: SLAM needs lidar and encoders; 'uvf vehicle check {member.entry.model}' shows how")
    world_from_map = Pose2(start.x, start.y, start.yaw)
    odometry = member.params("odometry", OdometryParams)
    mapping = member.params("mapping", MappingParams)
    return [
        Host(OdometryService, lambda: OdometryService(member.name, member.file, world_from_map, odometry), member.name),
        Host(MappingService, lambda: MappingService(member.name, lidar, world_from_map, mapping), member.name),
    ]


def _warm_up() -> None:
    """Compiles the kernels, or loads them from their cache, before the first scan."""
    mapper = Mapper(0.05, 0.0, 0.0)
    angles = np.linspace(-np.pi, np.pi, 60)
    hits = np.column_stack((np.cos(angles), np.sin(angles)))
    for _ in range(2):
        mapper.add(IDENTITY, Scan(hits, 2.0 * hits[:2], (0.0, 0.0)))
    search(mapper.occupancy, IDENTITY, hits)
