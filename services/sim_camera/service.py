"""All cameras of all vehicles as a service: true poses in, JPEG pictures and depth pictures out."""

from collections.abc import Mapping, Sequence
from typing import Protocol

from schemas import topics
from schemas.convert import array, wxyz
from schemas.messages import CameraCalibration, CompressedImage, NavState
from services.sim_camera.fitted import Fitted, Pictures
from services.sim_camera.picture import info_message
from services.sim_camera.renderer import Pose, Shot
from uvf.runtime.service import Outputs, Service, each_vehicle, optional
from uvf.runtime.vehicle_file import Camera


class Renderer(Protocol):
    """What draws."""

    def place(self, t: float, poses: Mapping[str, Pose]) -> None: ...

    def take(self, camera: Camera, body: Pose) -> Shot: ...

    def close(self) -> None: ...


class SimCamera(Service):
    """A picture carries the stamp of the pose it was taken from; a vehicle without a fresh pose gives none."""

    name = "sim_camera"
    hz = 5.0
    scope = "world"
    inputs = {"truth": each_vehicle(optional(topics.TRUTH))}
    outputs = {"image": topics.IMAGE, "depth": topics.DEPTH, "info": topics.CAMERA_INFO}

    def __init__(self, renderer: Renderer, cameras: Sequence[Fitted]) -> None:
        self._renderer = renderer
        self._cameras = cameras
        self._told = False

    def step(self, t: float, truth: dict[str, NavState]) -> Outputs:
        poses = {name: Pose(array(state.position), wxyz(state.orientation)) for name, state in truth.items()}
        self._renderer.place(t, poses)
        images: dict[str, CompressedImage] = {}
        depths: dict[str, CompressedImage] = {}
        for fitted in self._cameras:
            if (arrived := self._take(t, fitted, truth, poses)) is not None:
                images[fitted.vehicle] = arrived.image
                if arrived.depth is not None:
                    depths[fitted.vehicle] = arrived.depth
        return {"image": images, "depth": depths, "info": self._infos(t)}

    def _take(self, t: float, fitted: Fitted, truth: Mapping[str, NavState], poses: Mapping[str, Pose]) -> Pictures | None:
        name = fitted.vehicle
        if name not in poses:
            return None
        return fitted.step(t, truth[name].timestamp, lambda: self._renderer.take(fitted.camera, poses[name]))

    def _infos(self, t: float) -> dict[str, CameraCalibration]:
        """Told once, at the first step; that is not always step 1, for a process may join a running clock."""
        if self._told:
            return {}
        self._told = True
        return {fitted.vehicle: info_message(t, fitted.frame, fitted.camera) for fitted in self._cameras}

    def close(self) -> None:
        self._renderer.close()
