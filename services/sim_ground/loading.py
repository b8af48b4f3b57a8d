"""How a vehicle comes into the engine: its wheels, treads, steering and other joints."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from services.sim_ground.engine import PhysicsEngine
from services.sim_ground.joints import JointDrives, Springs
from services.sim_ground.loaded import LoadedVehicle
from services.sim_ground.motor import WheelMotor
from services.sim_ground.steering import SteeringGear
from services.sim_ground.touching import SOLE
from services.sim_ground.treads import Treads
from uvf.maths.geodesy import GRAVITY
from uvf.maths.rotations import from_euler, multiply, rotate
from uvf.models.urdf.model import load_urdf
from uvf.models.vehicle.drive import AckermannFile
from uvf.models.vehicle.file import Friction, GroundBody
from uvf.models.vehicle.joints import moved_joints

Floats = NDArray[np.float64]
FREE = 0.0  # friction across rollers, and along wheels that nothing drives
SAG = 1e-3  # m, by which tyres of several wheels a side give under the vehicle's weight
SETTLES = 0.7  # damping ratio of that


@dataclass(frozen=True)
class BodyPlacement:
    """A vehicle to add to the world: its file's data, its URDF, its start (x, y [m], yaw [rad], world) and z [m] of what it stands on."""

    body: GroundBody
    urdf: Path
    start: tuple[float, float, float]
    z: float = 0.0


class VehicleLoader:
    """Adds vehicles to an engine."""

    def __init__(self, engine: PhysicsEngine, rate: float, floor: int) -> None:
        """rate: physics steps a second [Hz]; floor: the engine's number of it."""
        self._engine, self._rate, self._floor = engine, rate, floor

    def load(self, vehicle: BodyPlacement) -> LoadedVehicle:
        """Adds a vehicle. Raises BadInput for a URDF that the engine cannot load."""
        index = self._engine.load(vehicle.urdf)
        joints, friction, drive = self._engine.joints(index), vehicle.body.friction, vehicle.body.drive
        wheels = tuple(joints[name] for name in drive.joints)
        self._set_friction(index, friction, wheels, [j for j in joints.values() if j not in wheels])
        com_in_base = self._engine.centre_of_mass(index)
        self._place(index, replace(vehicle, start=(0.0, 0.0, 0.0), z=0.0), com_in_base)
        soles = frozenset(link for link, _ in self._engine.near(index, self._floor, SOLE))
        steering = self._steering(index, drive, joints) if isinstance(drive, AckermannFile) else None
        treads = self._treads(index, vehicle.body, wheels, [joints[name] for name in drive.steered_wheels.values()])
        self._place(index, vehicle, com_in_base)
        drives, springs = self._others(index, vehicle, joints)
        if drives is not None or springs is not None:
            self._engine.be_thorough()
        motors = tuple(WheelMotor(vehicle.body.motor, 1 / self._rate) for _ in wheels)
        most = max(friction.mu, friction.mu2)
        return LoadedVehicle(
            index, drive.on_left, drive.channels, wheels, motors, com_in_base, most, treads, soles, steering, drives, springs
        )

    def _others(self, index: int, vehicle: BodyPlacement, joints: Mapping[str, int]) -> tuple[JointDrives | None, Springs | None]:
        """What moves beside wheels and steering; what nothing moves is held where it is."""
        body = vehicle.body
        turning = {joints[name] for name in (*body.turning_joints, *body.drive.all_wheels)}
        if held := [joint for joint in self._engine.moving_joints(index) if joint not in turning]:
            self._engine.hold(index, held, [0.0] * len(held))
        swinging = [joints[name] for name in body.springs]
        if swinging:
            self._engine.free(index, swinging)
        return (
            JointDrives([joints[n] for n in body.joints], moved_joints(load_urdf(vehicle.urdf), body.joints)) if body.joints else None,
            Springs(swinging, list(body.springs.values())) if swinging else None,
        )

    def _steering(self, index: int, drive: AckermannFile, joints: Mapping[str, int]) -> SteeringGear:
        """Of a vehicle that stands at the origin."""
        steers = [joints[name] for name in drive.steered]
        wheels = self._engine.link_poses(index, [joints[name] for name in drive.steered.values()])
        places = [(float(wheel.position[0]), float(wheel.position[1])) for wheel in wheels]
        links = zip(steers, self._engine.link_poses(index, steers), strict=True)
        signs = [float(np.sign(rotate(link.orientation, self._engine.axle(index, joint))[2])) for joint, link in links]
        return SteeringGear(steers, places, signs, drive.kinematics, drive.steering_rate)

    def _set_friction(self, index: int, friction: Friction, wheels: Sequence[int], sliding: Sequence[int]) -> None:
        """The floor's coefficient is 1 and the engine multiplies both, so that the vehicle's alone count."""
        most = max(friction.mu, friction.mu2)
        for wheel in wheels:
            shares = ((friction.mu + (friction.mu2 - friction.mu) * self._engine.axle(index, wheel) ** 2) / most).tolist()
            self._engine.set_dynamics(index, wheel, lateralFriction=most, anisotropicFriction=shares)
        for link in sliding:
            self._engine.set_dynamics(index, link, lateralFriction=friction.castor)

    def _treads(self, index: int, body: GroundBody, driven: Sequence[int], steered: Sequence[int]) -> Treads | None:
        """None where wheels roll on and the engine's own friction does. driven, steered: links of wheels; steered ones roll freely.

        Tyres of several wheels a side give, so that all of them carry: a rigid body on four points stands on any three.
        """
        drive, wheels = body.drive, [*driven, *steered]
        if not drive.scrubs and drive.holds_at is None and not steered:
            return None
        mass = self._engine.mass(index) / len(wheels)
        stiffness = mass * GRAVITY / SAG
        damping = 2.0 * SETTLES * float(np.sqrt(stiffness * mass))
        for wheel in wheels:
            self._engine.set_dynamics(index, wheel, lateralFriction=0.0, contactStiffness=stiffness, contactDamping=damping)
        axles = np.array([self._engine.axle(index, w) for w in wheels])
        mu, mu2 = body.friction.mu, body.friction.mu2 if drive.holds_at is None else FREE
        grip = np.array([(mu, mu2)] * len(driven) + [(FREE, mu2)] * len(steered))
        on_left = drive.on_left + tuple(link.position[1] > 0.0 for link in self._engine.link_poses(index, steered))
        return Treads(wheels, axles, grip, on_left, drive.holds_at or (0.0,) * len(wheels), drive.wheel_radius if steered else inf)

    def _place(self, index: int, vehicle: BodyPlacement, com_in_base: tuple[Floats, Floats]) -> None:
        x, y, yaw = vehicle.start
        world_from_base = from_euler(0.0, 0.0, yaw)
        position = np.array((x, y, vehicle.z)) + rotate(world_from_base, com_in_base[0])
        self._engine.place(index, position, multiply(world_from_base, com_in_base[1]))
