"""The ground vehicles' physics: a world of solids and wheeled bodies.

Wheels are held at their motors' references by a velocity constraint whose torque is what the motor has; solids with a script
are put where they are at each physics step, with the velocity they have, so that they push what stands in their way.
"""

from collections.abc import Mapping, Sequence
from math import nan

import numpy as np
from numpy.typing import NDArray

from services.sim_ground.body import BodyState, Motion, Touch, base_motion
from services.sim_ground.engine import PhysicsEngine
from services.sim_ground.guest import Course
from services.sim_ground.loaded import LoadedVehicle, Saved
from services.sim_ground.loading import BodyPlacement, VehicleLoader
from services.sim_ground.touching import FLOOR, GROUND, Bodies
from services.sim_ground.treads import Rolling, Treads
from uvf.maths.rotations import IDENTITY, multiply, rotate
from uvf.models.shapes.solid import Keyframes, Solid, pose_at

Floats = NDArray[np.float64]
AWAY = np.array((0.0, 0.0, 1e4))  # m
DEEP = 2e-3  # m, from which on one body is inside another
FALLEN = 0.5  # cosine of the tilt from which on a vehicle no longer stands on its wheels
STILL = (0.0, 0.0, 0.0)
UNSTEERED: Mapping[str, float] = {}
UNMOVED: Mapping[str, Mapping[str, float]] = {}
SETTLING = 0.3  # s of physics before the start: the wheels sink into their contacts


class BulletWorld:
    """A physics engine of its own. The floor is z = 0; base_link is the point on the floor under the axle's middle."""

    def __init__(self, solids: Sequence[Solid], vehicles: Mapping[str, BodyPlacement]) -> None:
        self.rate = max((v.body.physics_hz for v in vehicles.values()), default=200.0)
        self.engine = PhysicsEngine(self.rate)
        self._bodies = Bodies()
        self._objects: dict[str, int] = {}
        self._scripted: list[tuple[int, Solid, Keyframes]] = []
        self._guests: dict[str, tuple[int, Course | None]] = {}
        self._drawn: dict[str, float] = {}
        self._floor = self.engine.add_floor()
        self._bodies.names[self._floor] = FLOOR
        self._loader = VehicleLoader(self.engine, self.rate, self._floor)
        for solid in solids:
            index = self._add(solid.name, solid, solid.position, solid.orientation)
            if solid.path is None:
                self._bodies.fixed.add(index)
            else:
                self._scripted.append((index, solid, solid.path))
        self._vehicles = {name: self._load(name, vehicle) for name, vehicle in vehicles.items()}
        self.advance({}, SETTLING)

    def _add(self, name: str, solid: Solid, position: Floats, orientation: Floats, mass: float = 0.0) -> int:
        index = self.engine.add(solid, position, orientation, mass)
        self._bodies.names[index] = name
        return index

    def _load(self, name: str, vehicle: BodyPlacement) -> LoadedVehicle:
        loaded = self._loader.load(vehicle)
        self._bodies.names[loaded.index] = name
        return loaded

    def set_grip(self, vehicle: str, shares: tuple[float, float]) -> None:
        """Leaves a vehicle's left and right wheel a share of their friction from now on, 0 to 1."""
        loaded = self._vehicles[vehicle]
        if shares != loaded.grip:
            loaded.grip = shares
            for wheel, is_left in zip(loaded.wheels, loaded.on_left, strict=True):
                if loaded.treads is None:
                    share = shares[0] if is_left else shares[1]
                    self.engine.set_dynamics(loaded.index, wheel, lateralFriction=share * loaded.friction)

    def advance(
        self,
        wheels: Mapping[str, Sequence[float]],
        duration: float,
        since: float = 0.0,
        steering: Mapping[str, float] = UNSTEERED,
        joints: Mapping[str, Mapping[str, float]] = UNMOVED,
    ) -> None:
        """Moves the world by ``duration`` [s]; a vehicle without a finite command brakes its wheels to a stop.

        since: simulation time [s] at the beginning, for scripted solids. wheels: speed commands [rad/s], one for each channel of a drive.
        steering: of cars [rad, left positive]; one that is not named keeps its steering where it is. joints: positions [rad or m] likewise.
        """
        wanted = {name: vehicle.by_wheel(wheels.get(name, ())) for name, vehicle in self._vehicles.items()}
        for n in range(round(duration * self.rate)):
            self._move_scripted(since + n / self.rate)
            self._move_guests(since + n / self.rate)
            for name, vehicle in self._vehicles.items():
                self._drawn[name] = self._drawn.get(name, 0.0) + self._drive(vehicle, wanted[name])
                if vehicle.steering is not None:
                    self.engine.hold(vehicle.index, vehicle.steering.joints, vehicle.steering.turn(steering.get(name, nan), 1 / self.rate))
                self._move_joints(vehicle, joints.get(name, UNSTEERED))
                if vehicle.treads is not None:
                    self._push_off(vehicle, vehicle.treads)
            self.engine.step()

    def _move_joints(self, vehicle: LoadedVehicle, wanted: Mapping[str, float]) -> None:
        """Those that are moved on command, and those on springs. wanted: rad or m."""
        if (drives := vehicle.drives) is not None:
            self.engine.hold(vehicle.index, drives.joints, drives.lead(wanted, 1 / self.rate), drives.efforts)
        if (springs := vehicle.springs) is not None:
            motions = self.engine.joint_motions(vehicle.index, springs.joints)
            self.engine.drive(vehicle.index, springs.joints, springs.efforts(motions, 1 / self.rate))

    def motor_energy(self, vehicle: str) -> float:
        """Energy [J] that a vehicle's motors have drawn since the last call."""
        return self._drawn.pop(vehicle, 0.0)

    def _drive(self, vehicle: LoadedVehicle, wanted: Sequence[float]) -> float:
        """J drawn in the step before. wanted: rad/s, wheel by wheel."""
        joints = self.engine.joint_motions(vehicle.index, vehicle.wheels)
        wheels = list(zip(vehicle.motors, wanted, joints, strict=True))
        torques = [motor.step(speed, joint.speed) for motor, speed, joint in wheels]
        self.engine.turn(vehicle.index, vehicle.wheels, [motor.reference for motor in vehicle.motors], torques)
        return sum(motor.power(joint.torque, joint.speed) for motor, _, joint in wheels) / self.rate

    def _push_off(self, vehicle: LoadedVehicle, treads: Treads) -> None:
        """Friction on wheels that scrub."""
        index = vehicle.index
        spins = [joint.speed for joint in self.engine.joint_motions(index, treads.wheels)]
        rolling = Rolling(self.engine.pose(index), self.engine.link_poses(index, treads.wheels), spins)
        for wheel, force, place in treads.pushes(self.engine.contacts(index), rolling, vehicle.grip, 1 / self.rate):
            self.engine.push(index, wheel, force, place)

    def _move_scripted(self, t: float) -> None:
        """The engine carries a body on by its velocity in the step."""
        for index, solid, path in self._scripted:
            x, y, turning = path.velocity(t)
            self.engine.place(index, *pose_at(solid, t))
            self.engine.set_velocity(index, (x, y, 0.0), (0.0, 0.0, turning))

    def let_in(self, name: str, solid: Solid) -> None:
        """Adds a body that another simulator moves, see ``guide``: it pushes others and is not pushed. Until then it is out of reach."""
        self._guests[name] = self._add(name, solid, AWAY, IDENTITY), None

    def guide(self, guests: Mapping[str, Course]) -> None:
        """Sets how these bodies move until the next call; one that is not named stays where it is."""
        for name, (index, _) in self._guests.items():
            self._guests[name] = index, guests.get(name)

    def _move_guests(self, t: float) -> None:
        for index, course in self._guests.values():
            if course is not None:
                self.engine.place(index, *course.at(t))
                self.engine.set_velocity(index, course.velocity.tolist(), STILL)

    def state(self, vehicle: str) -> BodyState:
        """Motion of base_link and the wheels now."""
        loaded = self._vehicles[vehicle]
        joints = self.engine.joint_motions(loaded.index, loaded.wheels)
        steers = loaded.steering.joints if loaded.steering is not None else ()
        others = loaded.other_joints
        return BodyState(
            *self._motion(loaded),
            wheel_angles=tuple(j.angle for j in joints),
            wheel_speeds=tuple(j.speed for j in joints),
            steered_to=tuple(j.angle for j in self.engine.joint_motions(loaded.index, steers)) if steers else (),
            joints=tuple((j.angle, j.speed) for j in self.engine.joint_motions(loaded.index, others)) if others else (),
        )

    def _motion(self, loaded: LoadedVehicle) -> Motion:
        return base_motion(*self.engine.pose(loaded.index), *loaded.com_in_base)

    def touches(self, vehicle: str) -> list[Touch]:
        """Everything that a vehicle touches now; what it stands on only if it has fallen over."""
        loaded = self._vehicles[vehicle]
        contacts, motion = self.engine.contacts(loaded.index), self._motion(loaded)
        _, x, y, _ = motion[1].tolist()
        has_fallen = 1 - 2 * (x * x + y * y) < FALLEN
        return self._bodies.felt(contacts, loaded.soles, motion, has_fallen)

    def bearing(self, vehicle: str) -> list[str]:
        """Names of the links beside its driven and steered wheels with which a vehicle bears on the ground now."""
        loaded = self._vehicles[vehicle]
        wheels = {*loaded.wheels, *(loaded.treads.wheels if loaded.treads is not None else ())}
        bear = {c.link for c in self.engine.contacts(loaded.index) if c.load > 0.0 and self._bodies.names[c.other] in GROUND}
        return sorted(self.engine.link_name(loaded.index, link) for link in bear - wheels)

    def put(self, name: str, solid: Solid, mass: float) -> str:
        """Adds a solid of ``mass`` [kg], 0 = fixed. Returns what it would stand in, "" when it is added."""
        self._objects[name] = index = self._add(name, solid, solid.position, solid.orientation, mass)
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
        self.engine.remove(index)

    def place(self, name: str, position: Floats, orientation: Floats) -> str:
        """Puts a vehicle's base_link or an object at ``position`` (3,) [m, world], ``orientation`` (4,) wxyz, at rest.

        Returns what it would stand in; then it has not moved.
        """
        index = self._index(name)
        before = self.engine.pose(index)
        com, turned = self._vehicles[name].com_in_base if name in self._vehicles else (np.zeros(3), IDENTITY)
        self.engine.place(index, position + rotate(orientation, com), multiply(orientation, turned))
        if met := self._meets(index):
            self.engine.restore_pose(index, before)
            return met
        self.engine.set_velocity(index, STILL, STILL)
        if name in self._vehicles:
            self._stop_wheels(self._vehicles[name])
        return ""

    def _stop_wheels(self, vehicle: LoadedVehicle) -> None:
        joints = self.engine.joint_motions(vehicle.index, vehicle.wheels)
        for wheel, motor, joint in zip(vehicle.wheels, vehicle.motors, joints, strict=True):
            motor.reference = 0.0
            self.engine.stop_joint(vehicle.index, wheel, joint.angle)
        if vehicle.treads is not None:
            vehicle.treads.deflections[:] = 0.0

    def _index(self, name: str) -> int:
        return self._vehicles[name].index if name in self._vehicles else self._objects[name]

    def _meets(self, index: int) -> str:
        """The name of a body that it is in by more than a contact's depth."""
        for other, name in self._bodies.names.items():
            if other != index and any(gap < -DEEP for _, gap in self.engine.near(index, other, 0.0)):
                return name
        return ""

    def poses(self) -> dict[str, tuple[Floats, Floats]]:
        """Position (3,) [m, world] and orientation (4,) wxyz of each added solid, by name; vehicles are not included."""
        return {name: self.engine.where(index) for name, index in self._objects.items()}

    def save(self) -> Saved:
        """Saves all that the next steps depend on."""
        references = {name: [m.reference for m in v.motors] for name, v in self._vehicles.items()}
        deflections = {name: v.treads.deflections.copy() for name, v in self._vehicles.items() if v.treads is not None}
        steering = {name: v.steering.angle for name, v in self._vehicles.items() if v.steering is not None}
        joints = {name: list(v.drives.positions) for name, v in self._vehicles.items() if v.drives is not None}
        return Saved(self.engine.save(list(self._bodies.names)), references, deflections, steering, joints)

    def restore(self, saved: Saved) -> None:
        """Restores a saved state; the same bodies must be there as then."""
        self.engine.restore(saved.state, list(self._bodies.names))
        for name, references in saved.references.items():
            for motor, reference in zip(self._vehicles[name].motors, references, strict=True):
                motor.reference = reference
        for name, deflections in saved.deflections.items():
            treads = self._vehicles[name].treads
            assert treads is not None
            treads.deflections[:] = deflections
        for name, angle in saved.steering.items():
            gear = self._vehicles[name].steering
            assert gear is not None
            gear.angle = angle
        for name, positions in saved.joints.items():
            drives = self._vehicles[name].drives
            assert drives is not None
            drives.positions[:] = positions

    def forget(self, saved: Saved) -> None:
        """Releases a saved state."""
        self.engine.forget(saved.state)

    def close(self) -> None:
        """Ends the engine."""
        self.engine.close()
