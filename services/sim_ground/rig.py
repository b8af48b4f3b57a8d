"""One ground vehicle's sensors: which of them are due at a step, and what they say."""

from collections.abc import Mapping

import numpy as np
from google.protobuf.message import Message
from numpy.typing import NDArray

from schemas.messages import FrameTransforms
from services.sim_ground import readings
from services.sim_ground.body import BodyState
from services.sim_ground.imu import ImuModel
from services.sim_ground.lidar import LidarModel
from uvf.maths.planar import Pose2
from uvf.maths.rotations import to_euler
from uvf.runtime.link_frames import Links
from uvf.runtime.site import Member, Site
from uvf.runtime.vehicle_file import GroundBody
from uvf.runtime.world_geometry import slice_at

Floats = NDArray[np.float64]

STEP_HZ = 100.0
TRUTH_HZ, STATE_HZ = 50.0, 20.0  # as in the table of topics


def planar(body: BodyState) -> Pose2:
    return Pose2(float(body.position[0]), float(body.position[1]), to_euler(body.world_from_body)[2])


class Rig:
    """Built once a vehicle; each sensor draws from a generator of its own, so that none disturbs another."""

    def __init__(self, site: Site, member: Member, ground: GroundBody) -> None:
        self._links = Links(member.folder / ground.urdf, (ground.left_joint, ground.right_joint))
        sensors = member.file.sensors
        self.ground = ground
        self._name = member.name
        self._sensors = sensors
        self._lidar: LidarModel | None = None
        self._imu: ImuModel | None = None
        self._touched: str | None = None
        if sensors.lidar is not None:
            outlines = slice_at(site.world, sensors.lidar.mount.xyz[2])
            self._lidar = LidarModel(sensors.lidar, outlines, site.rng(member.name, "lidar"))
        if sensors.imu is not None:
            self._imu = ImuModel(sensors.imu, np.array(site.world.magnetic_field), site.rng(member.name, "imu"))

    def frames(self, t: float) -> FrameTransforms:
        """What does not move on the vehicle, stamped ``t`` [s]."""
        return self._links.resting(self._name, self._sensors, t)

    def read(self, n: int, body: BodyState, others: Floats, touched: str | None) -> Mapping[str, Message]:
        """Messages by output name at step ``n``; others: (k, 3) x, y, radius [m] of the other vehicles.

        A touch counts until it has been told, so that a short one between two messages is not lost.
        """
        t = n / STEP_HZ
        self._touched = self._touched or touched
        found: dict[str, Message] = {}
        sensors = self._sensors
        if sensors.imu is not None and self._imu is not None and is_due(n, sensors.imu.hz):
            reading = self._imu.read(body, 1 / sensors.imu.hz)
            found["imu"] = readings.imu_message(t, f"{self._name}/{sensors.imu.frame}", reading)
        if sensors.lidar is not None and self._lidar is not None and is_due(n, sensors.lidar.hz):
            ranges = self._lidar.scan(planar(body), others)
            found["scan"] = readings.scan_message(t, f"{self._name}/{sensors.lidar.frame}", sensors.lidar, ranges)
        if sensors.encoders is not None and is_due(n, sensors.encoders.hz):
            found["wheels"] = readings.wheels_message(t, sensors.encoders, body)
        if is_due(n, TRUTH_HZ):
            found["truth"] = readings.truth_message(t, body)
        if is_due(n, STATE_HZ):
            found["contact"] = readings.contact_message(t, self._touched)
            self._touched = None
            found["joints"] = joints = readings.joints_message(t, self.ground, body)
            found["joint_frames"] = self._links.turned(self._name, joints)
        return found


def is_due(n: int, hz: float) -> bool:
    """Whether step ``n`` of ``STEP_HZ`` is one of a sensor that runs at ``hz``, a divisor of it."""
    return n % round(STEP_HZ / hz) == 0
