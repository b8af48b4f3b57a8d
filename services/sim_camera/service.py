"""All cameras of all vehicles as a service: true poses in, JPEG pictures out."""

from collections.abc import Mapping
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from schemas import topics
from schemas.convert import array, wxyz
from schemas.messages import CameraCalibration, CompressedImage, NavState
from services.sim_camera.picture import image_message, info_message
from services.sim_camera.renderer import Pose
from uvf.runtime.service import Outputs, Service, each_vehicle, optional
from uvf.runtime.vehicle_file import Camera


class Renderer(Protocol):
    """What draws."""

    def place(self, poses: Mapping[str, Pose]) -> None: ...

    def picture(self, camera: Camera, body: Pose) -> NDArray[np.uint8]: ...

    def close(self) -> None: ...


class SimCamera(Service):
    """A picture carries the stamp of the pose it was taken from; a vehicle without a fresh pose gives none."""

    name = "sim_camera"
    hz = 5.0
    scope = "world"
    inputs = {"truth": each_vehicle(optional(topics.TRUTH))}
    outputs = {"image": topics.IMAGE, "info": topics.CAMERA_INFO}

    def __init__(self, renderer: Renderer, cameras: Mapping[str, Camera]) -> None:
        self._renderer = renderer
        self._cameras = cameras
        self._told = False

    def step(self, t: float, truth: dict[str, NavState]) -> Outputs:
        n = round(t * self.hz)
        poses = {name: Pose(array(state.position), wxyz(state.orientation)) for name, state in truth.items()}
        self._renderer.place(poses)
        images: dict[str, CompressedImage] = {}
        for name, camera in self._cameras.items():
            if name in poses and n % round(self.hz / camera.hz) == 0:
                picture = self._renderer.picture(camera, poses[name])
                images[name] = image_message(truth[name].timestamp, optical_frame(name, camera), picture)
        return {"image": images, "info": self._infos(t)}

    def _infos(self, t: float) -> dict[str, CameraCalibration]:
        """Told once, at the first step; that is not always step 1, for a process may join a running clock."""
        if self._told:
            return {}
        self._told = True
        return {name: info_message(t, optical_frame(name, camera), camera) for name, camera in self._cameras.items()}

    def close(self) -> None:
        self._renderer.close()


def optical_frame(vehicle: str, camera: Camera) -> str:
    """Frame of the picture: x right, y down, z along the view."""
    return f"{vehicle}/{camera.frame}_optical"
