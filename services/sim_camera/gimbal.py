"""A gimbal of three joints that holds its camera's horizon level, or turns with the vehicle, as it is told; at its joints' own rate."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.messages import GimbalCommand
from uvf.maths.rotations import from_axis, from_euler, inverse, matrix, multiply, to_euler, wrap
from uvf.models.vehicle.sensors import Gimbal

Floats = NDArray[np.float64]

X = np.array((1.0, 0.0, 0.0))


class Joints(NamedTuple):
    """Gimbal joints, mount outwards [rad]: pan about z, left positive; roll about x, right down positive; tilt about y, down positive."""

    pan: float = 0.0
    roll: float = 0.0
    tilt: float = 0.0


class Aim:
    """Where the gimbal's camera looks; until it is commanded ahead, level."""

    def __init__(self, gimbal: Gimbal) -> None:
        self._gimbal = gimbal
        self._body_from_mount = from_euler(*gimbal.mount.rpy)
        self._told = GimbalCommand()
        self.joints = Joints()

    @property
    def body_from_camera(self) -> Floats:
        """Orientation (4,) wxyz of the camera in the body; x along the view, z up in the picture."""
        pan, roll, tilt = self.joints
        turned = multiply(multiply(from_euler(0.0, 0.0, pan), from_axis(X, roll)), from_euler(0.0, tilt, 0.0))
        return multiply(self._body_from_mount, turned)

    def tell(self, command: GimbalCommand) -> None:
        """Takes a command; one that is not finite, or of an unknown mode, is ignored."""
        if math.isfinite(command.pan) and math.isfinite(command.tilt) and command.mode in GimbalCommand.Mode.values():
            self._told = command

    def turn(self, world_from_body: Floats, dt: float) -> None:
        """Turns towards the commanded direction for ``dt`` [s], within the joints' limits and rate; world_from_body: (4,) wxyz."""
        g, wanted, most = self._gimbal, self._wanted(world_from_body), self._gimbal.slew * dt
        round_about = g.pan_max >= math.pi
        pan_left = wrap(wanted.pan - self.joints.pan) if round_about else _within(wanted.pan, g.pan_max) - self.joints.pan
        self.joints = Joints(
            wrap(self.joints.pan + _within(pan_left, most)),
            self.joints.roll + _within(_within(wanted.roll, g.roll_max) - self.joints.roll, most),
            self.joints.tilt + _within(float(np.clip(wanted.tilt, g.tilt_min, g.tilt_max)) - self.joints.tilt, most),
        )

    def _wanted(self, world_from_body: Floats) -> Joints:
        told = self._told
        if told.mode == GimbalCommand.BODY:
            return Joints(told.pan, 0.0, told.tilt)
        heading = to_euler(world_from_body)[2] if told.mode == GimbalCommand.FOLLOW else 0.0
        world_from_camera = from_euler(0.0, told.tilt, heading + told.pan)
        world_from_mount = multiply(world_from_body, self._body_from_mount)
        return joints_of(multiply(inverse(world_from_mount), world_from_camera))


def joints_of(mount_from_camera: Floats) -> Joints:
    """The joints [rad] that turn the camera to ``mount_from_camera`` (4,) wxyz: R = Rz(pan) Rx(roll) Ry(tilt), roll within pi/2."""
    r = matrix(mount_from_camera)
    return Joints(float(np.arctan2(-r[0, 1], r[1, 1])), float(np.arcsin(np.clip(r[2, 1], -1.0, 1.0))), float(np.arctan2(-r[2, 0], r[2, 2])))


def _within(value: float, most: float) -> float:
    return min(max(value, -most), most)
