"""One vehicle's camera: what its pictures are called, their noise, and how they get out."""

from collections.abc import Callable, Mapping
from typing import NamedTuple

import msgspec
import numpy as np
from google.protobuf.timestamp_pb2 import Timestamp

from schemas.messages import CompressedImage
from services.sim_camera.gimbal import Aim
from services.sim_camera.picture import depth_message, image_message
from services.sim_camera.renderer import Pose, Shot
from uvf.maths.rotations import multiply, rotate
from uvf.models.vehicle.sensors import Camera, Gimbal, Mount
from uvf.sensors.carrier import Carrier
from uvf.sensors.fitted import line_of
from uvf.sensors.sampling import DelayLine


class Pictures(NamedTuple):
    """The pictures of one shot as messages."""

    image: CompressedImage
    depth: CompressedImage | None


class FittedCamera:
    """A camera of a vehicle: its timing, and its gimbal if it has one."""

    def __init__(
        self, vehicle: str, camera: Camera, rng: np.random.Generator, output: str = "image", carrier: Carrier | None = None
    ) -> None:
        """output: the name under which its pictures go out; carrier: what it sits on, if that moves."""
        delivery, self._rng = rng.spawn(2)
        self.output = output
        self.aim = Aim(camera) if isinstance(camera, Gimbal) else None
        self.vehicle = vehicle
        self._carrier = carrier
        self.camera = camera
        self.frame = f"{vehicle}/{camera.frame}_optical"
        """Of the pictures: x right, y down, z along the view."""
        self._line: DelayLine[Pictures] = line_of(camera, delivery)

    def looking(self, body: Pose, joints: Mapping[str, float]) -> tuple[Camera, Pose]:
        """The camera and the pose to render from; with a gimbal its own pose as it is turned now. joints: positions [rad or m]."""
        if self._carrier is not None:
            moved = self._carrier.moved(joints)
            eye = body.position + rotate(body.world_from_body, moved.translation)
            body = Pose(eye, multiply(body.world_from_body, moved.rotation))
        if self.aim is None:
            return self.camera, body
        eye = body.position + rotate(body.world_from_body, np.array(self.camera.mount.xyz))
        return msgspec.structs.replace(self.camera, mount=Mount()), Pose(eye, multiply(body.world_from_body, self.aim.body_from_camera))

    def step(self, t: float, taken: Timestamp, shoot: Callable[[], Shot]) -> Pictures | None:
        """The pictures that arrive at ``t`` [s], if any; ``taken`` is the stamp of the pose that a shot would be taken from now."""
        return self._line.step(t, lambda: self._messages(taken, shoot()))

    def _messages(self, taken: Timestamp, shot: Shot) -> Pictures:
        image = image_message(taken, self.frame, shot.picture)
        if shot.depth is None:
            return Pictures(image, None)
        depth = np.where(shot.depth <= self.camera.far, shot.depth, 0.0)
        if self.camera.depth_noise:  # grows with the square of the depth, as disparity does (Khoshelham & Elberink 2012, eq. 9)
            depth += self.camera.depth_noise * depth**2 * self._rng.standard_normal(depth.shape)
        return Pictures(image, depth_message(taken, self.frame, depth))
