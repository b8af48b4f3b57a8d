"""The ground vehicles' physics: a PyBullet world of solids and wheeled bodies; the only file here that knows PyBullet.

Wheels are held at their motors' references by a velocity constraint whose torque is what the motor has; solids with a script
are put where they are at each physics step, with the velocity they have, so that they push what stands in their way.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from services.sim_ground.body import BodyState, Motion, Touch, base_motion
from services.sim_ground.guest import Course
from services.sim_ground.loaded import LoadedVehicle, Saved
from services.sim_ground.motor import WheelMotor
from services.sim_ground.touching import FLOOR, SOLE, Bodies, EngineContact
from uvf.maths.geodesy import GRAVITY
from uvf.maths.kinematics import WheelSpeeds
from uvf.maths.rotations import IDENTITY, from_euler, matrix, multiply, rotate
from uvf.models.shapes.solid import Keyframes, Solid, pose_at
from uvf.models.vehicle.file import Friction, GroundBody
from uvf.models.yaml_data import BadInput
from uvf.runtime.process.quiet import c_errors_discarded

with c_errors_discarded():
    import pybullet

Floats = NDArray[np.float64]
STOPPED = WheelSpeeds(0.0, 0.0)
AWAY = np.array((0.0, 0.0, 1e4))  # m
DEEP = 2e-3  # m, from which on one body is inside another
FALLEN = 0.5  # cosine of the tilt from which on a vehicle no longer stands on its wheels
MOVING, STANDING = (1, -1), (2, -3)
"""The engine's own filters (group, mask): what stands does not touch what stands."""
SETTLING = 0.3  # s of physics before the start: the wheels sink into their contacts


@dataclass(frozen=True)
class BodyPlacement:
    """A vehicle to add to the world: its file's data, its URDF, its start (x, y [m], yaw [rad], world) and z [m] of what it stands on."""

    body: GroundBody
    urdf: Path
    start: tuple[float, float, float]
    z: float = 0.0


class BulletWorld:
    """A physics client of its own. The floor is z = 0; base_link is the point on the floor under the axle's middle."""

    def __init__(self, solids: Sequence[Solid], vehicles: Mapping[str, BodyPlacement]) -> None:
        self._client: int = pybullet.connect(pybullet.DIRECT)
        self.rate = max((v.body.physics_hz for v in vehicles.values()), default=200.0)
        self._bodies = Bodies()
        self._objects: dict[str, int] = {}
        self._scripted: list[tuple[int, Solid, Keyframes]] = []
        self._guests: dict[str, tuple[int, Course | None]] = {}
        self._drawn: dict[str, float] = {}
        pybullet.setGravity(0.0, 0.0, -GRAVITY, physicsClientId=self._client)
        pybullet.setPhysicsEngineParameter(
            fixedTimeStep=1 / self.rate, numSolverIterations=50, deterministicOverlappingPairs=1, physicsClientId=self._client
        )
        floor = pybullet.createCollisionShape(pybullet.GEOM_PLANE, physicsClientId=self._client)
        self._floor = self._add(FLOOR, floor, np.zeros(3), IDENTITY)
        for solid in solids:
            index = self._add(solid.name, _collision_shape(solid, self._client), solid.position, solid.orientation)
            if solid.path is None:
                self._bodies.fixed.add(index)
            else:
                self._scripted.append((index, solid, solid.path))
        self._vehicles = {name: self._load(name, vehicle) for name, vehicle in vehicles.items()}
        self.advance({}, SETTLING)

    def _add(self, name: str, shape: int, position: Floats, orientation: Floats, mass: float = 0.0) -> int:
        index: int = pybullet.createMultiBody(
            mass, shape, basePosition=position.tolist(), baseOrientation=_xyzw(orientation), physicsClientId=self._client
        )
        pybullet.changeDynamics(index, -1, lateralFriction=1.0, physicsClientId=self._client)
        self._bodies.names[index] = name
        return index

    def _load(self, name: str, vehicle: BodyPlacement) -> LoadedVehicle:
        try:
            index = pybullet.loadURDF(str(vehicle.urdf), flags=pybullet.URDF_USE_INERTIA_FROM_FILE, physicsClientId=self._client)
        except pybullet.error as error:
            raise BadInput(f"{vehicle.urdf}: PyBullet cannot load it ({error}); check its geometry and joints") from error
        self._bodies.names[index] = name
        joints = self._joints(index)
        wheels = (joints[vehicle.body.left_joint], joints[vehicle.body.right_joint])
        for link in (-1, *joints.values()):
            pybullet.changeDynamics(index, link, linearDamping=0.0, angularDamping=0.0, physicsClientId=self._client)
        self._set_friction(index, vehicle.body.friction, wheels, [j for j in joints.values() if j not in wheels])
        local = pybullet.getDynamicsInfo(index, -1, physicsClientId=self._client)
        com_in_base = (np.array(local[3]), _wxyz(local[4]))
        soles = self._soles(index, vehicle, com_in_base)
        self._place(index, vehicle, com_in_base)
        left, right = (WheelMotor(vehicle.body.motor, 1 / self.rate) for _ in wheels)
        x, y, z = matrix(com_in_base[1])[2]
        friction = max(vehicle.body.friction.mu, vehicle.body.friction.mu2)
        return LoadedVehicle(index, wheels, (left, right), com_in_base, (float(x), float(y), float(z)), friction, soles)

    def _soles(self, index: int, vehicle: BodyPlacement, com_in_base: tuple[Floats, Floats]) -> frozenset[int]:
        """The links with which it stands on a level floor."""
        self._place(index, replace(vehicle, start=(0.0, 0.0, 0.0), z=0.0), com_in_base)
        near: Any = pybullet.getClosestPoints(index, self._floor, SOLE, physicsClientId=self._client)
        return frozenset(point[3] for point in near)

    def _set_friction(self, index: int, friction: Friction, wheels: Sequence[int], sliding: Sequence[int]) -> None:
        """The floor's coefficient is 1 and the engine multiplies both, so that the vehicle's alone count."""
        most = max(friction.mu, friction.mu2)
        for wheel in wheels:
            axle = np.array(pybullet.getJointInfo(index, wheel, physicsClientId=self._client)[13])  # in the wheel's axes of inertia
            shares = ((friction.mu + (friction.mu2 - friction.mu) * axle**2) / most).tolist()
            pybullet.changeDynamics(index, wheel, lateralFriction=most, anisotropicFriction=shares, physicsClientId=self._client)
        for link in sliding:
            pybullet.changeDynamics(index, link, lateralFriction=friction.castor, physicsClientId=self._client)

    def _joints(self, index: int) -> dict[str, int]:
        count = pybullet.getNumJoints(index, physicsClientId=self._client)
        infos = [pybullet.getJointInfo(index, j, physicsClientId=self._client) for j in range(count)]
        return {info[1].decode(): j for j, info in enumerate(infos)}

    def _place(self, index: int, vehicle: BodyPlacement, com_in_base: tuple[Floats, Floats]) -> None:
        x, y, yaw = vehicle.start
        world_from_base = from_euler(0.0, 0.0, yaw)
        position = np.array((x, y, vehicle.z)) + rotate(world_from_base, com_in_base[0])
        orientation = multiply(world_from_base, com_in_base[1])
        pybullet.resetBasePositionAndOrientation(index, position.tolist(), _xyzw(orientation), physicsClientId=self._client)

    def set_grip(self, vehicle: str, shares: tuple[float, float]) -> None:
        """Leaves a vehicle's left and right wheel a share of their friction from now on, 0 to 1."""
        loaded = self._vehicles[vehicle]
        if shares != loaded.grip:
            loaded.grip = shares
            for wheel, share in zip(loaded.wheels, shares, strict=True):
                pybullet.changeDynamics(loaded.index, wheel, lateralFriction=share * loaded.friction, physicsClientId=self._client)

    def advance(self, wheels: Mapping[str, WheelSpeeds], duration: float, since: float = 0.0) -> None:
        """Moves the world by ``duration`` [s]; a vehicle without a finite command brakes its wheels to a stop.

        since: simulation time [s] at the beginning, for scripted solids. wheels: speed commands [rad/s].
        """
        wanted = {name: wheels.get(name, STOPPED) for name in self._vehicles}
        for name, speeds in wanted.items():
            if not np.isfinite(speeds).all():
                wanted[name] = STOPPED
        for n in range(round(duration * self.rate)):
            self._move_scripted(since + n / self.rate)
            self._move_guests(since + n / self.rate)
            for name, vehicle in self._vehicles.items():
                self._drawn[name] = self._drawn.get(name, 0.0) + self._drive(vehicle, wanted[name])
            pybullet.stepSimulation(physicsClientId=self._client)

    def motor_energy(self, vehicle: str) -> float:
        """Energy [J] that a vehicle's motors have drawn since the last call."""
        return self._drawn.pop(vehicle, 0.0)

    def _drive(self, vehicle: LoadedVehicle, wanted: WheelSpeeds) -> float:
        """J drawn in the step before."""
        (left, right), (left_motor, right_motor) = self._joint_states(vehicle), vehicle.motors
        forces = [left_motor.step(wanted[0], left[1]), right_motor.step(wanted[1], right[1])]
        pybullet.setJointMotorControlArray(
            vehicle.index,
            vehicle.wheels,
            pybullet.VELOCITY_CONTROL,
            targetVelocities=[left_motor.reference, right_motor.reference],
            forces=forces,
            physicsClientId=self._client,
        )
        return (left_motor.power(left[3], left[1]) + right_motor.power(right[3], right[1])) / self.rate

    def _joint_states(self, vehicle: LoadedVehicle) -> Any:
        """Of the left and the right wheel: angle [rad], speed [rad/s], ..."""
        return pybullet.getJointStates(vehicle.index, vehicle.wheels, physicsClientId=self._client)

    def _move_scripted(self, t: float) -> None:
        """The engine carries a body on by its velocity in the step."""
        for index, solid, path in self._scripted:
            position, orientation = pose_at(solid, t)
            x, y, turning = path.velocity(t)
            pybullet.resetBasePositionAndOrientation(index, position.tolist(), _xyzw(orientation), physicsClientId=self._client)
            pybullet.resetBaseVelocity(index, [x, y, 0.0], [0.0, 0.0, turning], physicsClientId=self._client)

    def let_in(self, name: str, solid: Solid) -> None:
        """Adds a body that another simulator moves, see ``guide``: it pushes others and is not pushed. Until then it is out of reach."""
        self._guests[name] = self._add(name, _collision_shape(solid, self._client), AWAY, IDENTITY), None

    def guide(self, guests: Mapping[str, Course]) -> None:
        """Sets how these bodies move until the next call; one that is not named stays where it is."""
        for name, (index, _) in self._guests.items():
            self._guests[name] = index, guests.get(name)

    def _move_guests(self, t: float) -> None:
        for index, course in self._guests.values():
            if course is not None:
                position, turned = course.at(t)
                pybullet.resetBasePositionAndOrientation(index, position.tolist(), _xyzw(turned), physicsClientId=self._client)
                pybullet.resetBaseVelocity(index, course.velocity.tolist(), [0.0, 0.0, 0.0], physicsClientId=self._client)

    def state(self, vehicle: str) -> BodyState:
        """Motion of base_link and the wheels now."""
        loaded = self._vehicles[vehicle]
        left, right = self._joint_states(loaded)
        return BodyState(*self._motion(loaded), wheel_angles=(left[0], right[0]), wheel_speeds=WheelSpeeds(left[1], right[1]))

    def _motion(self, loaded: LoadedVehicle) -> Motion:
        com, orientation = pybullet.getBasePositionAndOrientation(loaded.index, physicsClientId=self._client)
        velocity, angular = pybullet.getBaseVelocity(loaded.index, physicsClientId=self._client)
        return base_motion(com, orientation, velocity, angular, *loaded.com_in_base)

    def touches(self, vehicle: str) -> list[Touch]:
        """Everything that a vehicle touches now; what it stands on only if it has fallen over."""
        loaded = self._vehicles[vehicle]
        rows: Any = pybullet.getContactPoints(bodyA=loaded.index, physicsClientId=self._client)
        contacts = [EngineContact(other, link, place, normal, gap) for _, _, other, link, _, place, _, normal, gap, *_ in rows]
        return self._bodies.felt(contacts, loaded.soles, self._motion(loaded), self._has_fallen(loaded))

    def _has_fallen(self, loaded: LoadedVehicle) -> bool:
        _, (x, y, z, w) = pybullet.getBasePositionAndOrientation(loaded.index, physicsClientId=self._client)
        a, b, c = loaded.up_in_com
        up: float = 2 * ((x * z - w * y) * a + (y * z + w * x) * b) + (1 - 2 * (x * x + y * y)) * c
        return up < FALLEN

    def put(self, name: str, solid: Solid, mass: float) -> str:
        """Adds a solid of ``mass`` [kg], 0 = fixed. Returns what it would stand in, "" when it is added."""
        self._objects[name] = index = self._add(name, _collision_shape(solid, self._client), solid.position, solid.orientation, mass)
        if mass == 0.0:
            self._bodies.fixed.add(index)
        return self._unless_free(name)

    def put_vehicle(self, name: str, vehicle: BodyPlacement) -> str:
        """Adds a vehicle, as ``put`` does. Raises BadInput for a URDF that the engine cannot load."""
        self._vehicles[name] = self._load(name, vehicle)
        return self._unless_free(name)

    def _unless_free(self, name: str) -> str:
        if met := self._meets(self._index(name)):
            self.remove(name)
        return met

    def remove(self, name: str) -> None:
        """Removes a solid or a vehicle."""
        index = self._index(name)
        self._objects.pop(name, None)
        self._vehicles.pop(name, None)
        self._bodies.remove(index)
        pybullet.removeBody(index, physicsClientId=self._client)

    def place(self, name: str, position: Floats, orientation: Floats) -> str:
        """Puts a vehicle's base_link or an object at ``position`` (3,) [m, world], ``orientation`` (4,) wxyz, at rest.

        Returns what it would stand in; then it has not moved.
        """
        index = self._index(name)
        before = pybullet.getBasePositionAndOrientation(index, physicsClientId=self._client)
        moving = pybullet.getBaseVelocity(index, physicsClientId=self._client)
        com, turned = self._vehicles[name].com_in_base if name in self._vehicles else (np.zeros(3), IDENTITY)
        centre, attitude = position + rotate(orientation, com), multiply(orientation, turned)
        pybullet.resetBasePositionAndOrientation(index, centre.tolist(), _xyzw(attitude), physicsClientId=self._client)
        if met := self._meets(index):
            pybullet.resetBasePositionAndOrientation(index, *before, physicsClientId=self._client)
            pybullet.resetBaseVelocity(index, *moving, physicsClientId=self._client)
            return met
        pybullet.resetBaseVelocity(index, [0.0, 0.0, 0.0], [0.0, 0.0, 0.0], physicsClientId=self._client)
        if name in self._vehicles:
            self._stop_wheels(self._vehicles[name])
        return ""

    def _stop_wheels(self, vehicle: LoadedVehicle) -> None:
        angles = [joint[0] for joint in self._joint_states(vehicle)]
        for wheel, motor, angle in zip(vehicle.wheels, vehicle.motors, angles, strict=True):
            motor.reference = 0.0
            pybullet.resetJointState(vehicle.index, wheel, angle, 0.0, physicsClientId=self._client)

    def _index(self, name: str) -> int:
        return self._vehicles[name].index if name in self._vehicles else self._objects[name]

    def _meets(self, index: int) -> str:
        """The name of a body that it is in by more than a contact's depth."""
        for other, name in self._bodies.names.items():
            if other != index:
                near: Any = pybullet.getClosestPoints(index, other, 0.0, physicsClientId=self._client)
                if any(point[8] < -DEEP for point in near):
                    return name
        return ""

    def poses(self) -> dict[str, tuple[Floats, Floats]]:
        """Position (3,) [m, world] and orientation (4,) wxyz of each added solid, by name; vehicles are not included."""
        found = {n: pybullet.getBasePositionAndOrientation(i, physicsClientId=self._client) for n, i in self._objects.items()}
        return {name: (np.array(position), _wxyz(turned)) for name, (position, turned) in found.items()}

    def save(self) -> Saved:
        """Saves all that the next steps depend on."""
        self._find_contacts_anew()
        references = {name: [m.reference for m in v.motors] for name, v in self._vehicles.items()}
        return Saved(pybullet.saveState(physicsClientId=self._client), references)

    def restore(self, saved: Saved) -> None:
        """Restores a saved state; the same bodies must be there as then."""
        pybullet.restoreState(stateId=saved.state, physicsClientId=self._client)
        self._find_contacts_anew()
        for name, references in saved.references.items():
            for motor, reference in zip(self._vehicles[name].motors, references, strict=True):
                motor.reference = reference

    def _find_contacts_anew(self) -> None:
        """The engine does not keep in which order it came to know of pairs that are close, and solves contacts in that order.

        To set a filter, even the one that holds, makes it forget and find them again: at a save and a restore alike.
        """
        for index in sorted(self._bodies.names):
            moves = pybullet.getDynamicsInfo(index, -1, physicsClientId=self._client)[0] > 0.0
            group, mask = MOVING if moves else STANDING
            for link in range(-1, pybullet.getNumJoints(index, physicsClientId=self._client)):
                pybullet.setCollisionFilterGroupMask(index, link, group, mask, physicsClientId=self._client)

    def forget(self, saved: Saved) -> None:
        """Releases a saved state."""
        pybullet.removeState(saved.state, physicsClientId=self._client)

    def close(self) -> None:
        """Disconnects the physics client."""
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
