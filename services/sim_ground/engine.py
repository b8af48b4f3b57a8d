"""The physics engine of the ground vehicles; the only file here that knows PyBullet. Orientations are wxyz, links and joints numbers."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from services.sim_ground.body import BodyPose, LinkPose, Three
from services.sim_ground.touching import EngineContact
from uvf.maths.geodesy import GRAVITY
from uvf.models.shapes.solid import Solid
from uvf.models.yaml_data import BadInput
from uvf.runtime.process.quiet import c_errors_discarded

with c_errors_discarded():
    import pybullet

Floats = NDArray[np.float64]

BASE = -1  # the link that is the root
STIFF = 1e3  # N m
ITERATIONS = 50  # of the solver, in a step
THOROUGH = 500
"""Instead, with chains of joints: with 50 a standing vehicle with an arm creeps by 8 mm and 2 deg in 10 s, with 500 by 0.1 mm."""
MOVING, STANDING = (1, -1), (2, -3)
"""The engine's own filters (group, mask): what stands does not touch what stands."""


class JointMotion(NamedTuple):
    """angle [rad], speed [rad/s], torque of its motor [N m]."""

    angle: float
    speed: float
    torque: float


class PhysicsEngine:
    """A physics client of its own, in steps of 1 / ``rate`` [Hz]."""

    def __init__(self, rate: float) -> None:
        self.client: int = pybullet.connect(pybullet.DIRECT)
        pybullet.setGravity(0.0, 0.0, -GRAVITY, physicsClientId=self.client)
        pybullet.setPhysicsEngineParameter(
            fixedTimeStep=1 / rate, numSolverIterations=ITERATIONS, deterministicOverlappingPairs=1, physicsClientId=self.client
        )

    def be_thorough(self) -> None:
        """Takes more iterations from now on."""
        pybullet.setPhysicsEngineParameter(numSolverIterations=THOROUGH, physicsClientId=self.client)

    def add_floor(self) -> int:
        """The plane z = 0; its number."""
        plane = pybullet.createCollisionShape(pybullet.GEOM_PLANE, physicsClientId=self.client)
        return self._body(plane, np.zeros(3), np.array((1.0, 0.0, 0.0, 0.0)), 0.0)

    def add(self, solid: Solid, position: Floats, orientation: Floats, mass: float = 0.0) -> int:
        """Adds a solid of ``mass`` [kg], 0 = fixed; its number."""
        return self._body(_collision_shape(solid, self.client), position, orientation, mass)

    def _body(self, shape: int, position: Floats, orientation: Floats, mass: float) -> int:
        index: int = pybullet.createMultiBody(
            mass, shape, basePosition=position.tolist(), baseOrientation=_xyzw(orientation), physicsClientId=self.client
        )
        pybullet.changeDynamics(index, BASE, lateralFriction=1.0, physicsClientId=self.client)
        return index

    def load(self, urdf: Path) -> int:
        """Adds a vehicle; its number. Raises BadInput for a URDF that the engine cannot load."""
        try:
            index: int = pybullet.loadURDF(str(urdf), flags=pybullet.URDF_USE_INERTIA_FROM_FILE, physicsClientId=self.client)
        except pybullet.error as error:
            raise BadInput(f"{urdf}: PyBullet cannot load it ({error}); check its geometry and joints") from error
        for link in range(BASE, self._joint_count(index)):
            pybullet.changeDynamics(index, link, linearDamping=0.0, angularDamping=0.0, physicsClientId=self.client)
        return index

    def remove(self, index: int) -> None:
        """Removes a body."""
        pybullet.removeBody(index, physicsClientId=self.client)

    def _joint_count(self, index: int) -> int:
        count: int = pybullet.getNumJoints(index, physicsClientId=self.client)
        return count

    def joints(self, index: int) -> dict[str, int]:
        """Joints of a vehicle by name; the link behind a joint has the joint's number."""
        return {self._joint(index, j)[1].decode(): j for j in range(self._joint_count(index))}

    def moving_joints(self, index: int) -> list[int]:
        """Numbers of the joints that turn or slide."""
        moves = (pybullet.JOINT_REVOLUTE, pybullet.JOINT_PRISMATIC)
        return [j for j in range(self._joint_count(index)) if self._joint(index, j)[2] in moves]

    def link_name(self, index: int, link: int) -> str:
        """Name of a link."""
        name: bytes = pybullet.getBodyInfo(index, physicsClientId=self.client)[0] if link == BASE else self._joint(index, link)[12]
        return name.decode()

    def axle(self, index: int, joint: int) -> Floats:
        """Axis (3,) of a joint in its link's axes of inertia."""
        return np.array(self._joint(index, joint)[13])

    def _joint(self, index: int, joint: int) -> Any:
        return pybullet.getJointInfo(index, joint, physicsClientId=self.client)

    def mass(self, index: int) -> float:
        """kg, of all links."""
        links = range(BASE, self._joint_count(index))
        return float(sum(pybullet.getDynamicsInfo(index, link, physicsClientId=self.client)[0] for link in links))

    def centre_of_mass(self, index: int) -> tuple[Floats, Floats]:
        """Position (3,) [m] and axes of inertia (4,) of the root link in its frame."""
        info = pybullet.getDynamicsInfo(index, BASE, physicsClientId=self.client)
        return np.array(info[3]), _wxyz(info[4])

    def set_dynamics(self, index: int, link: int, **values: Any) -> None:
        """Sets what ``changeDynamics`` of PyBullet takes."""
        pybullet.changeDynamics(index, link, **values, physicsClientId=self.client)

    def place(self, index: int, position: Floats, orientation: Floats) -> None:
        """Puts a body's centre of mass at ``position`` (3,) [m], ``orientation`` (4,), with the velocity that it has."""
        pybullet.resetBasePositionAndOrientation(index, position.tolist(), _xyzw(orientation), physicsClientId=self.client)

    def set_velocity(self, index: int, velocity: Sequence[float], angular: Sequence[float]) -> None:
        """Sets a body's velocity (3,) [m/s] and angular velocity (3,) [rad/s], world."""
        pybullet.resetBaseVelocity(index, velocity, angular, physicsClientId=self.client)

    def pose(self, index: int) -> BodyPose:
        """Where a body's centre of mass is, and how it moves."""
        position, xyzw = pybullet.getBasePositionAndOrientation(index, physicsClientId=self.client)
        return BodyPose(position, xyzw, *pybullet.getBaseVelocity(index, physicsClientId=self.client))

    def where(self, index: int) -> tuple[Floats, Floats]:
        """Position (3,) [m] and orientation (4,) of a body's centre of mass."""
        position, xyzw = pybullet.getBasePositionAndOrientation(index, physicsClientId=self.client)
        return np.array(position), _wxyz(xyzw)

    def restore_pose(self, index: int, pose: BodyPose) -> None:
        """Puts a body where it was."""
        pybullet.resetBasePositionAndOrientation(index, pose.position, pose.xyzw, physicsClientId=self.client)
        pybullet.resetBaseVelocity(index, pose.velocity, pose.angular_velocity, physicsClientId=self.client)

    def turn(self, index: int, joints: Sequence[int], speeds: Sequence[float], torques: Sequence[float]) -> None:
        """Holds joints at speeds [rad/s] with at most these torques [N m]."""
        pybullet.setJointMotorControlArray(
            index,
            joints,
            pybullet.VELOCITY_CONTROL,
            targetVelocities=speeds,
            forces=torques,
            physicsClientId=self.client,
        )

    def hold(self, index: int, joints: Sequence[int], positions: Sequence[float], efforts: Sequence[float] = ()) -> None:
        """Holds joints at positions [rad or m] with at most these efforts [N m or N], by default with whatever that takes."""
        pybullet.setJointMotorControlArray(
            index,
            joints,
            pybullet.POSITION_CONTROL,
            targetPositions=positions,
            forces=efforts or [STIFF] * len(joints),
            physicsClientId=self.client,
        )

    def free(self, index: int, joints: Sequence[int]) -> None:
        """Takes the brakes off joints, which the engine puts on all that it loads."""
        self.turn(index, joints, [0.0] * len(joints), [0.0] * len(joints))

    def drive(self, index: int, joints: Sequence[int], efforts: Sequence[float]) -> None:
        """Efforts [N m or N] on joints without brakes during the next step."""
        pybullet.setJointMotorControlArray(index, joints, pybullet.TORQUE_CONTROL, forces=efforts, physicsClientId=self.client)

    def joint_motions(self, index: int, joints: Sequence[int]) -> list[JointMotion]:
        """How joints stand and turn."""
        return [JointMotion(j[0], j[1], j[3]) for j in pybullet.getJointStates(index, joints, physicsClientId=self.client)]

    def link_poses(self, index: int, links: Sequence[int]) -> list[LinkPose]:
        """Where links are. How they move the engine does not tell: what it tells is turned by as much as a wheel turns in a step."""
        states: Any = pybullet.getLinkStates(index, links, physicsClientId=self.client)
        return [LinkPose(np.array(s[0]), _wxyz(s[1])) for s in states]

    def stop_joint(self, index: int, joint: int, angle: float) -> None:
        """Puts a joint at rest at an angle [rad]."""
        pybullet.resetJointState(index, joint, angle, 0.0, physicsClientId=self.client)

    def push(self, index: int, link: int, force: Floats, place: Three) -> None:
        """A force (3,) [N] on a link at a place (3,) [m] during the next step, world."""
        pybullet.applyExternalForce(index, link, force.tolist(), place, pybullet.WORLD_FRAME, physicsClientId=self.client)

    def contacts(self, index: int) -> list[EngineContact]:
        """What a body touches, or is near to, after the last step."""
        rows: Any = pybullet.getContactPoints(bodyA=index, physicsClientId=self.client)
        return [EngineContact(row[2], row[3], row[5], row[7], row[8], row[9]) for row in rows]

    def near(self, index: int, other: int, distance: float) -> list[tuple[int, float]]:
        """Links of a body that are within ``distance`` [m] of another one, and how far off they are [m], below 0 inside of it."""
        points: Any = pybullet.getClosestPoints(index, other, distance, physicsClientId=self.client)
        return [(point[3], point[8]) for point in points]

    def step(self) -> None:
        """One step of physics."""
        pybullet.stepSimulation(physicsClientId=self.client)

    def save(self, bodies: Sequence[int]) -> int:
        """Saves the state of all bodies; its number."""
        self._find_contacts_anew(bodies)
        state: int = pybullet.saveState(physicsClientId=self.client)
        return state

    def restore(self, state: int, bodies: Sequence[int]) -> None:
        """Restores a saved state; the same bodies must be there as then."""
        pybullet.restoreState(stateId=state, physicsClientId=self.client)
        self._find_contacts_anew(bodies)

    def _find_contacts_anew(self, bodies: Sequence[int]) -> None:
        """The engine does not keep in which order it came to know of pairs that are close, and solves contacts in that order.

        To set a filter, even the one that holds, makes it forget and find them again: at a save and a restore alike.
        """
        for index in sorted(bodies):
            moves = pybullet.getDynamicsInfo(index, BASE, physicsClientId=self.client)[0] > 0.0
            group, mask = MOVING if moves else STANDING
            for link in range(BASE, self._joint_count(index)):
                pybullet.setCollisionFilterGroupMask(index, link, group, mask, physicsClientId=self.client)

    def forget(self, state: int) -> None:
        """Releases a saved state."""
        pybullet.removeState(state, physicsClientId=self.client)

    def close(self) -> None:
        """Disconnects."""
        pybullet.disconnect(physicsClientId=self.client)


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
