"""All cameras of all vehicles as a service: true poses in, JPEG pictures and depth pictures out."""

from collections.abc import Callable, Mapping, Sequence
from typing import Protocol

from schemas import topics
from schemas.messages import CameraCalibration, CompressedImage, FrameTransform, GimbalCommand, JointStates, NavState, SimObjects
from services.sim_camera.fitted import FittedCamera, Pictures
from services.sim_camera.picture import info_message, joints_message
from services.sim_camera.renderer import Look, Pose, Shot
from uvf.models.shapes.solid import Solid
from uvf.models.vehicle.sensors import Camera
from uvf.runtime.contract.declaration import Reads, Writes, each_vehicle, optional, topic
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import array, seconds, wxyz
from uvf.runtime.messages.joints import positions_of
from uvf.runtime.messages.sensor_frames import mounted
from uvf.runtime.messages.spawned import solid_of, sound_objects

INFO = {"image": "info", "chase": "chase_info", "gimbal": "gimbal_info"}
"""The output that tells of the camera whose pictures go out by this one."""


class Renderer(Protocol):
    """What renders the pictures."""

    def place(self, t: float, poses: Mapping[str, Pose]) -> None:
        """Places vehicles at their true poses, and scripted solids where they are at ``t`` [s]."""
        ...

    def turn(self, positions: Mapping[str, Mapping[str, float]]) -> None:
        """Turns joints of vehicles to these positions [rad or m]."""
        ...

    def show(self, guests: Mapping[str, Solid | Look]) -> None:
        """Shows what has been spawned."""
        ...

    def take(self, camera: Camera, body: Pose) -> Shot:
        """The picture that a camera of a vehicle takes with its body at this pose."""
        ...

    def close(self) -> None:
        """Releases the renderer."""
        ...


class SimCamera(Service):
    """All cameras. A picture carries the stamp of its pose, as do a gimbal's joints and frame; without a fresh pose there is none."""

    name = "sim_camera"
    hz = 5.0
    scope = "world"

    class Inputs(Reads):
        """True poses, joints, spawned objects, and gimbal commands."""

        truth: dict[str, NavState] = each_vehicle(optional(topics.TRUTH))
        joints: dict[str, JointStates] = each_vehicle(optional(topics.JOINTS))
        objects: SimObjects | None = optional(topics.OBJECTS)
        aircraft: SimObjects | None = optional(topics.AIR_OBJECTS)
        gimbals: dict[str, GimbalCommand] = each_vehicle(optional(topics.GIMBAL.by("*")))

    class Outputs(Writes):
        """Pictures, calibrations, and gimbal states."""

        image: dict[str, CompressedImage] | None = topic(topics.IMAGE)
        depth: dict[str, CompressedImage] | None = topic(topics.DEPTH)
        info: dict[str, CameraCalibration] | None = topic(topics.CAMERA_INFO)
        chase: dict[str, CompressedImage] | None = topic(topics.VIEW.by("chase"))
        chase_info: dict[str, CameraCalibration] | None = topic(topics.VIEW_INFO.by("chase"))
        gimbal: dict[str, CompressedImage] | None = topic(topics.VIEW.by("gimbal"))
        gimbal_info: dict[str, CameraCalibration] | None = topic(topics.VIEW_INFO.by("gimbal"))
        gimbal_frame: dict[str, FrameTransform] | None = topic(topics.TF_GIMBAL)
        gimbal_joints: dict[str, JointStates] | None = topic(topics.GIMBAL_JOINTS)

    def __init__(self, renderer: Renderer, cameras: Sequence[FittedCamera], look_of: Callable[[str], Look | None]) -> None:
        """look_of: what a vehicle model looks like that is put in while the simulation runs; None where this host has no such model."""
        self._renderer = renderer
        self._look_of = look_of
        self._cameras = cameras
        self._told = False

    def step(self, t: float, now: Inputs) -> Outputs:
        """Takes the pictures due at ``t`` [s, simulation]. objects, aircraft: what has been spawned."""
        looks = {o.name: self._look_of(o.model) if o.model else solid_of(o) for o in sound_objects(now.objects, now.aircraft)}
        self._renderer.show({name: look for name, look in looks.items() if look is not None})
        poses = {name: Pose(array(state.position), wxyz(state.orientation)) for name, state in now.truth.items()}
        self._renderer.place(t, poses)
        joints = {name: positions_of(states) for name, states in now.joints.items()}
        self._renderer.turn(joints)
        out = self.Outputs()
        for fitted in self._cameras:
            if fitted.aim is not None and (name := fitted.vehicle) in poses:
                if name in now.gimbals:
                    fitted.aim.tell(now.gimbals[name])
                fitted.aim.turn(poses[name].world_from_body, 1 / self.hz)
                taken = now.truth[name].timestamp
                out.add("gimbal_frame", name, mounted(name, fitted.camera, fitted.aim.body_from_camera, seconds(taken)))
                out.add("gimbal_joints", name, joints_message(taken, fitted.aim.joints))
            if (arrived := self._take(t, fitted, now.truth, poses, joints)) is not None:
                out.add(fitted.output, fitted.vehicle, arrived.image)
                if arrived.depth is not None:
                    out.add("depth", fitted.vehicle, arrived.depth)
        if not self._told:  # once, at the first step; that is not always step 1, for a process may join a running clock
            self._told = True
            for fitted in self._cameras:
                out.add(INFO[fitted.output], fitted.vehicle, info_message(t, fitted.frame, fitted.camera))
        return out

    def _take(
        self,
        t: float,
        fitted: FittedCamera,
        truth: Mapping[str, NavState],
        poses: Mapping[str, Pose],
        joints: Mapping[str, Mapping[str, float]],
    ) -> Pictures | None:
        name = fitted.vehicle
        if name not in poses:
            return None
        return fitted.step(t, truth[name].timestamp, lambda: self._renderer.take(*fitted.looking(poses[name], joints.get(name, {}))))

    def close(self) -> None:
        """Releases the renderer."""
        self._renderer.close()
