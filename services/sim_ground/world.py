"""The ground vehicles' physics: a PyBullet world of solids and wheeled bodies; the only file here that knows PyBullet."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pybullet
from numpy.typing import NDArray

from services.sim_ground.body import BodyState, Touch
from uvf.maths.geodesy import GRAVITY
from uvf.maths.kinematics import WheelSpeeds, spin_velocity
from uvf.maths.rotations import from_euler, inverse, matrix, multiply, rotate
from uvf.runtime.params import BadInput
from uvf.runtime.solid import UPRIGHT, Solid
from uvf.runtime.vehicle_file import GroundBody

Floats = NDArray[np.float64]
STOPPED = WheelSpeeds(0.0, 0.0)
TOUCH = 5e-4  # m, gap at which two bodies touch; the engine leaves a little air
FALLEN = 0.5  # cosine of the tilt from which on a vehicle no longer stands on its wheels
SETTLING = 0.3  # s of physics before the start: the wheels sink into their contacts


@dataclass(frozen=True)
class Placed:
    """A vehicle to put into the world: its file's data, its URDF and its start (x, y [m], yaw [rad], world)."""

    body: GroundBody
    urdf: Path
    start: tuple[float, float, float]


@dataclass(frozen=True)
class _Loaded:
    """A vehicle inside the engine, whose own frame is the centre of mass: position (3,) m and orientation wxyz in base_link."""

    index: int
    wheels: tuple[int, int]
    torque: float
    com_in_base: tuple[Floats, Floats]


class BulletWorld:
    """One physics client of its own. The floor is z = 0; base_link is the point on the floor under the axle's middle."""

    def __init__(self, solids: Sequence[Solid], vehicles: Mapping[str, Placed]) -> None:
        self._client: int = pybullet.connect(pybullet.DIRECT)
        self._rate = max((v.body.physics_hz for v in vehicles.values()), default=200.0)
        self._names: dict[int, str] = {}
        pybullet.setGravity(0.0, 0.0, -GRAVITY, physicsClientId=self._client)
        pybullet.setPhysicsEngineParameter(
            fixedTimeStep=1 / self._rate, numSolverIterations=50, deterministicOverlappingPairs=1, physicsClientId=self._client
        )
        floor = pybullet.createCollisionShape(pybullet.GEOM_PLANE, physicsClientId=self._client)
        self._add("floor", floor, np.zeros(3), UPRIGHT)
        for solid in solids:
            self._add(solid.name, _collision_shape(solid, self._client), solid.position, solid.orientation)
        self._vehicles = {name: self._load(name, vehicle) for name, vehicle in vehicles.items()}
        self.advance({}, SETTLING)

    def _add(self, name: str, shape: int, position: Floats, orientation: Floats) -> None:
        index: int = pybullet.createMultiBody(
            0.0, shape, basePosition=position.tolist(), baseOrientation=_xyzw(orientation), physicsClientId=self._client
        )
        pybullet.changeDynamics(index, -1, lateralFriction=1.0, physicsClientId=self._client)
        self._names[index] = name

    def _load(self, name: str, vehicle: Placed) -> _Loaded:
        try:
            index = pybullet.loadURDF(str(vehicle.urdf), flags=pybullet.URDF_USE_INERTIA_FROM_FILE, physicsClientId=self._client)
        except pybullet.error as error:
            raise BadInput(f"{vehicle.urdf}: PyBullet cannot load it ({error}); check its geometry and joints") from error
        self._names[index] = name
        joints = self._joints(index)
        wheels = (joints[vehicle.body.left_joint], joints[vehicle.body.right_joint])
        for wheel in wheels:
            pybullet.changeDynamics(index, wheel, lateralFriction=vehicle.body.lateral_friction, physicsClientId=self._client)
        for link in (-1, *joints.values()):
            pybullet.changeDynamics(index, link, linearDamping=0.0, angularDamping=0.0, physicsClientId=self._client)
        local = pybullet.getDynamicsInfo(index, -1, physicsClientId=self._client)
        com_in_base = (np.array(local[3]), _wxyz(local[4]))
        self._place(index, vehicle.start, com_in_base)
        return _Loaded(index, wheels, vehicle.body.motor_torque, com_in_base)

    def _joints(self, index: int) -> dict[str, int]:
        count = pybullet.getNumJoints(index, physicsClientId=self._client)
        infos = [pybullet.getJointInfo(index, j, physicsClientId=self._client) for j in range(count)]
        return {info[1].decode(): j for j, info in enumerate(infos)}

    def _place(self, index: int, start: tuple[float, float, float], com_in_base: tuple[Floats, Floats]) -> None:
        x, y, yaw = start
        world_from_base = from_euler(0.0, 0.0, yaw)
        position = np.array((x, y, 0.0)) + rotate(world_from_base, com_in_base[0])
        orientation = multiply(world_from_base, com_in_base[1])
        pybullet.resetBasePositionAndOrientation(index, position.tolist(), _xyzw(orientation), physicsClientId=self._client)

    def advance(self, wheels: Mapping[str, WheelSpeeds], duration: float) -> None:
        """Moves the world by ``duration`` [s]; a vehicle without a finite command brakes its wheels to a stand."""
        for name, vehicle in self._vehicles.items():
            wanted = wheels.get(name, STOPPED)
            pybullet.setJointMotorControlArray(
                vehicle.index,
                vehicle.wheels,
                pybullet.VELOCITY_CONTROL,
                targetVelocities=wanted if np.isfinite(wanted).all() else STOPPED,
                forces=[vehicle.torque, vehicle.torque],
                physicsClientId=self._client,
            )
        for _ in range(round(duration * self._rate)):
            pybullet.stepSimulation(physicsClientId=self._client)

    def state(self, vehicle: str) -> BodyState:
        """Motion of base_link and the wheels now."""
        loaded = self._vehicles[vehicle]
        com, orientation = pybullet.getBasePositionAndOrientation(loaded.index, physicsClientId=self._client)
        velocity, angular = (np.array(v) for v in pybullet.getBaseVelocity(loaded.index, physicsClientId=self._client))
        com_in_base, turned = loaded.com_in_base
        world_from_base = multiply(_wxyz(orientation), inverse(turned))
        arm = rotate(world_from_base, com_in_base)
        joints = pybullet.getJointStates(loaded.index, loaded.wheels, physicsClientId=self._client)
        return BodyState(
            position=np.array(com) - arm,
            world_from_body=world_from_base,
            velocity=velocity - spin_velocity(angular, arm),
            angular_velocity=rotate(inverse(world_from_base), angular),
            wheel_angles=(joints[0][0], joints[1][0]),
            wheel_speeds=WheelSpeeds(joints[0][1], joints[1][1]),
        )

    def touches(self, vehicle: str) -> list[Touch]:
        """All that is touched now, the floor only by a vehicle that has fallen over."""
        index, body = self._vehicles[vehicle].index, self.state(vehicle)
        contacts: list[Any] = list(pybullet.getContactPoints(bodyA=index, physicsClientId=self._client))
        fallen = matrix(body.world_from_body)[2, 2] < FALLEN
        felt = [c for c in contacts if c[8] <= TOUCH and (self._names[c[2]] != "floor" or fallen)]
        places = [rotate(inverse(body.world_from_body), np.array(c[5]) - body.position) for c in felt]
        return [Touch(self._names[c[2]], float(np.arctan2(p[1], p[0]))) for c, p in zip(felt, places, strict=True)]

    def close(self) -> None:
        pybullet.disconnect(physicsClientId=self._client)


def _collision_shape(solid: Solid, client: int) -> int:
    """A mesh keeps its hollows, which the engine allows of bodies that are not pushed about."""
    shape: int
    if solid.shape == "box":
        half = [side / 2 for side in solid.size]
        shape = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=half, physicsClientId=client)
    elif solid.shape == "cylinder":
        radius, height = solid.size
        shape = pybullet.createCollisionShape(pybullet.GEOM_CYLINDER, radius=radius, height=height, physicsClientId=client)
    elif solid.shape == "sphere":
        shape = pybullet.createCollisionShape(pybullet.GEOM_SPHERE, radius=solid.size[0], physicsClientId=client)
    else:
        shape = pybullet.createCollisionShape(
            pybullet.GEOM_MESH,
            fileName=str(solid.mesh),
            meshScale=solid.size,
            flags=pybullet.GEOM_FORCE_CONCAVE_TRIMESH,
            physicsClientId=client,
        )
    return shape


def _xyzw(wxyz: Floats) -> list[float]:
    return [float(wxyz[1]), float(wxyz[2]), float(wxyz[3]), float(wxyz[0])]


def _wxyz(xyzw: tuple[float, ...]) -> Floats:
    return np.array((xyzw[3], xyzw[0], xyzw[1], xyzw[2]))
