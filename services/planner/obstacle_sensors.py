"""All that one vehicle sees and feels obstacles with: its lidars, and others for what that does not see.

These are depth camera, sonars, bumpers, and range finders that look down.
"""

from collections import deque
from math import atan2
from typing import NamedTuple

import numpy as np

from schemas.messages import CameraCalibration, CompressedImage, Contact, Range
from services.planner.edge_sense import EdgeSense
from services.planner.scan_placing import PlacedScan, ScanPlacer
from uvf.maths.rotations import from_euler, rotate
from uvf.maths.se3 import Transform, apply, compose
from uvf.models.vehicle.sensors import Sensors
from uvf.models.yaml_data import BadInput
from uvf.planning.costmap.bumps import Bump, BumpSense
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.costmap.hidden_obstacles import HiddenObstacles, unexplained
from uvf.planning.costmap.range_sights import GroundSight, cone_sight, depth_sight
from uvf.runtime.messages.convert import seconds
from uvf.runtime.messages.readings.depth_pictures import depth_rays
from uvf.runtime.messages.sensor_frames import OPTICAL
from uvf.sensors.fitted import base_from_sensor

DEPTH_REACH = 3.0  # m, beyond which depths are too coarse to tell a step from the floor
SONAR_REACH = 2.0  # m, beyond which a cone is too wide to say where
PIXELS = 20_000  # of a depth picture that are looked at
PATIENCE = 1.0  # s that what was seen waits until it is known from where
WAITING_MOST = 32


class OtherReadings(NamedTuple):
    """What has come from sensors other than the lidars."""

    depth: list[CompressedImage]
    info: CameraCalibration | None
    sonar: list[Range]
    contact: list[Contact]
    range: list[Range]


class ObstacleSensors:
    """One vehicle's; poses, in one frame, come to its ``placer``."""

    def __init__(self, placer: ScanPlacer, footprint: RobotFootprint, sensors: Sensors, top: float) -> None:
        """top: height [m] of the vehicle, below which things are in its way."""
        self.placer = placer
        self.faults: list[str] = []
        """What was sent and could not be read, since the last step."""
        self.bump: Bump | None = None
        """What it has been touched by since the last step."""
        self._top = top
        camera = sensors.camera
        self._base_from_optical = None if camera is None else compose(base_from_sensor(camera.mount), base_from_sensor(OPTICAL))
        self._sonars = {sonar.frame: sonar for sonar in sensors.sonars}
        self._edges = EdgeSense(sensors.rangefinders)
        self._bumper = BumpSense(footprint, {b.name: (b.angle_min, b.angle_max) for b in sensors.bumpers})
        self._scans: dict[int, PlacedScan] = {}
        """The last one of each lidar."""
        self._waiting: deque[tuple[float, str, GroundSight]] = deque(maxlen=WAITING_MOST)

    def see(self, scan: PlacedScan) -> None:
        """What a lidar has seen explains what a sonar hears."""
        self._scans[scan.lidar] = scan

    def take(self, age: float, readings: OtherReadings, hidden: HiddenObstacles) -> None:
        """Puts what has been seen among the hidden obstacles, whose lifetime goes by ``age``."""
        self.faults, self.bump = [], None
        if readings.info is not None and self._base_from_optical is not None:
            for picture in readings.depth:
                self._look(picture, readings.info, self._base_from_optical)
        for reading in readings.sonar:
            self._hear(reading)
        for contact in readings.contact:
            if not contact.touching:
                self._bumper.feel_nothing(seconds(contact.timestamp))
            elif (newest := self.placer.newest) is not None:
                bump = self._bumper.feel(seconds(contact.timestamp), newest[1], self.placer.motion, list(contact.sectors))
                self.bump = self.bump or bump
        for reading in readings.range:
            edge = self._edges.look(reading)
            if edge is not None and (newest := self.placer.newest) is not None:
                self.bump = self.bump or Bump(newest[1], self.placer.motion, edge, "no floor ahead", "range finder")
        waiting, self._waiting = self._waiting, deque(maxlen=WAITING_MOST)
        for t, sensor, sight in waiting:
            if (pose := self.placer.at(t)) is not None:
                hidden.see(sensor, (t, age), pose, sight)
            elif self.placer.newest is None or t > self.placer.newest[0] - PATIENCE:
                self._waiting.append((t, sensor, sight))

    def _look(self, picture: CompressedImage, info: CameraCalibration, base_from_optical: Transform) -> None:
        try:
            rays, depths = depth_rays(picture, info)
        except BadInput as error:
            self.faults.append(str(error))
            return
        step = int(np.ceil(np.sqrt(len(depths) / PIXELS)))
        rows = np.arange(info.height)[::step, None] * info.width + np.arange(info.width)[::step]
        rays, depths = rays[rows.ravel()], depths[rows.ravel()]
        x, y, z = base_from_optical.translation.tolist()
        ends = apply(base_from_optical, (rays * depths[:, None])[depths > 0.0])
        sight = depth_sight((x, y, z), ends, self._top, DEPTH_REACH)
        self._waiting.append((seconds(picture.timestamp), "depth camera", sight))

    def _hear(self, reading: Range) -> None:
        sonar = self._sonars.get(reading.frame_id.rpartition("/")[2])
        if sonar is None or not np.isfinite(reading.range):
            return
        (x, y, _), (ahead, left, _) = sonar.mount.xyz, rotate(from_euler(*sonar.mount.rpy), np.eye(3)[0]).tolist()
        sight = cone_sight((x, y), atan2(left, ahead), sonar.fov, (reading.range, min(sonar.range_max, SONAR_REACH)))
        if self._scans:
            sight = unexplained(sight, np.concatenate([s.points[s.ranges > 0.0] for s in self._scans.values()]))
        self._waiting.append((seconds(reading.timestamp), sonar.frame, sight))
