"""All cameras of all vehicles as a service: true poses in, JPEG pictures and depth pictures out."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

from schemas import topics
from schemas.convert import array, wxyz
from schemas.messages import CameraCalibration, CompressedImage, NavState, SimObject, SimObjects
from services.sim_camera.fitted import Fitted, Pictures
from services.sim_camera.picture import info_message
from services.sim_camera.renderer import Look, Pose, Shot
from uvf.runtime.service import Outputs, Service, each_vehicle, optional
from uvf.runtime.solid import Solid
from uvf.runtime.vehicle_file import Camera

GREY = (0.6, 0.6, 0.6)


class Renderer(Protocol):
    """What draws."""

    def place(self, t: float, poses: Mapping[str, Pose]) -> None: ...

    def show(self, guests: Mapping[str, Solid | Look]) -> None: ...

    def take(self, camera: Camera, body: Pose) -> Shot: ...

    def close(self) -> None: ...


class SimCamera(Service):
    """A picture carries the stamp of the pose it was taken from; a vehicle without a fresh pose gives none."""

    name = "sim_camera"
    hz = 5.0
    scope = "world"
    inputs = {"truth": each_vehicle(optional(topics.TRUTH)), "objects": optional(topics.OBJECTS)}
    outputs = {"image": topics.IMAGE, "depth": topics.DEPTH, "info": topics.CAMERA_INFO}

    def __init__(self, renderer: Renderer, cameras: Sequence[Fitted], look_of: Callable[[str], Look]) -> None:
        """look_of: what a vehicle model looks like that is put in while the simulation runs."""
        self._renderer = renderer
        self._look_of = look_of
        self._cameras = cameras
        self._told = False

    def step(self, t: float, truth: dict[str, NavState], objects: SimObjects | None) -> Outputs:
        self._renderer.show({o.name: self._look_of(o.model) if o.model else _solid(o) for o in objects.objects} if objects else {})
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


def _solid(object_: SimObject) -> Solid:
    shape: Any = object_.shape
    colour = (object_.color.r, object_.color.g, object_.color.b) if object_.HasField("color") else GREY
    return Solid(object_.name, shape, tuple(object_.size), array(object_.pose.position), wxyz(object_.pose.orientation), colour)
