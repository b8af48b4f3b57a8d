"""The ground vehicles' simulator as a service: wheel commands in, what the sensors say out."""

from collections.abc import Callable, Collection, Mapping, Sequence
from functools import cache, partial
from typing import Protocol

from schemas import topics
from schemas.messages import (
    Battery,
    Contact,
    FrameTransforms,
    Gnss,
    Imu,
    JointStates,
    LaserScan,
    NavState,
    Range,
    RemoveRequest,
    Reply,
    SetPoseRequest,
    SimObjects,
    SpawnRequest,
    StateRequest,
    WheelCommand,
    WheelTicks,
)
from services.sim_ground.body import BodyState, Touch
from services.sim_ground.guest import Course, courses
from services.sim_ground.rig import STEP_HZ, Moment
from services.sim_ground.stage import GroundStage, Stageable
from uvf.maths.raycast import MovingBody
from uvf.runtime.contract.declaration import Reads, Writes, each_vehicle, optional, replies, request, topic
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.joints import positions_of
from uvf.runtime.messages.readings.faults import Faults
from uvf.runtime.messages.readings.sensors import later
from uvf.runtime.messages.wheels import speeds_of
from uvf.sensors.sampling import Due
from uvf.sensors.surroundings import Surroundings, Whereabouts


class GroundWorld(Stageable, Protocol):
    """The physics behind the service."""

    rate: float
    """Physics steps a second."""

    def advance(
        self,
        wheels: Mapping[str, Sequence[float]],
        duration: float,
        since: float,
        steering: Mapping[str, float],
        joints: Mapping[str, Mapping[str, float]],
    ) -> None:
        """Moves the world from simulation time ``since`` [s] by ``duration`` [s].

        wheels: speed commands [rad/s]; steering [rad]; joints: positions of what else is moved [rad or m].
        """
        ...

    def state(self, vehicle: str) -> BodyState:
        """Motion of a vehicle's base_link and wheels now."""
        ...

    def touches(self, vehicle: str) -> list[Touch]:
        """Everything that a vehicle touches now."""
        ...

    def motor_energy(self, vehicle: str) -> float:
        """Energy [J] that a vehicle's motors have drawn since the last call."""
        ...

    def set_grip(self, vehicle: str, shares: tuple[float, float]) -> None:
        """Leaves a vehicle's left and right wheel a share of their friction from now on, 0 to 1."""
        ...

    def guide(self, guests: Mapping[str, Course]) -> None:
        """Sets how bodies of another simulator move until the next call."""
        ...

    def close(self) -> None:
        """Releases the engine."""
        ...


class SimGround(Service):
    """All ground vehicles in one world. A vehicle whose command is older than 0.5 s brakes its wheels to a stop and holds its joints.

    Truth is the motion of base_link: the point on the floor under the axle's middle, in the world frame.
    """

    name = "sim_ground"
    hz = STEP_HZ
    scope = "world"
    simulator = True

    class Inputs(Reads):
        """Wheel commands, true motion of the aircraft, and requests."""

        commands: dict[str, WheelCommand] = each_vehicle(optional(topics.WHEEL_COMMAND))
        joint_commands: dict[str, JointStates] = each_vehicle(optional(topics.JOINT_COMMAND))
        truth: dict[str, NavState] = each_vehicle(optional(topics.TRUTH))
        flying: SimObjects | None = optional(topics.AIR_OBJECTS)
        spawn: list[SpawnRequest] = request(topics.SPAWN)
        remove: list[RemoveRequest] = request(topics.REMOVE)
        set_pose: list[SetPoseRequest] = request(topics.SET_POSE)
        save: list[StateRequest] = request(topics.SAVE)
        restore: list[StateRequest] = request(topics.RESTORE)

    class Outputs(Writes):
        """Sensor readings and true motion of each vehicle, and replies."""

        imu: dict[str, Imu] | None = topic(topics.IMU)
        scan: dict[str, LaserScan] | None = topic(topics.SCAN)
        other_scans: dict[str, LaserScan] | None = topic(topics.OTHER_SCANS)
        wheels: dict[str, WheelTicks] | None = topic(topics.WHEELS)
        gnss: dict[str, Gnss] | None = topic(topics.GNSS)
        sonar: dict[str, Range] | None = topic(topics.SONAR)
        range: dict[str, Range] | None = topic(topics.RANGE)
        contact: dict[str, Contact] | None = topic(topics.CONTACT)
        battery: dict[str, Battery] | None = topic(topics.BATTERY)
        joints: dict[str, JointStates] | None = topic(topics.JOINTS)
        joint_frames: dict[str, FrameTransforms] | None = topic(topics.TF_JOINTS)
        frames: dict[str, FrameTransforms] | None = topic(topics.TF_STATIC)
        truth: dict[str, NavState] | None = topic(topics.TRUTH)
        objects: SimObjects | None = topic(topics.OBJECTS)
        spawn: list[Reply] = replies(topics.SPAWN)
        remove: list[Reply] = replies(topics.REMOVE)
        set_pose: list[Reply] = replies(topics.SET_POSE)
        save: list[Reply] = replies(topics.SAVE)
        restore: list[Reply] = replies(topics.RESTORE)

    def __init__(
        self,
        world: GroundWorld,
        surroundings: Surroundings,
        stage: GroundStage,
        aircraft: Collection[str] = (),
        faults: Faults | None = None,
    ) -> None:
        """aircraft: names of those that another simulator moves among these vehicles."""
        self._faults = faults or Faults()
        self._world = world
        self._surroundings = surroundings
        self._stage = stage
        self._aircraft = aircraft
        self._guests: dict[str, Course] = {}
        self._objects_due = Due(topics.OBJECTS.hz)
        self._had_objects = False

    def step(self, t: float, now: Inputs) -> Outputs:
        """One cycle at ``t`` [s, simulation]. Requests take effect at its end.

        truth: of the aircraft; flying: the spawned ones among them.
        """
        self._guests = courses(now.truth, self._aircraft)
        self._world.guide(self._guests)
        for name in self._stage.rigs:
            self._world.set_grip(name, self._faults.grip(t, name))
        self._advance(t, {n: c for n, c in now.commands.items() if not self._is_flat(n)}, _positions(now.joint_commands, self._is_flat))
        out, n, stage = self._read(t), round(t * self.hz), self._stage
        flying = [o.name for o in now.flying.objects] if now.flying else []
        out.spawn = [stage.spawn(r, flying) for r in now.spawn]
        out.remove = [stage.remove(r) for r in now.remove]
        out.set_pose = [stage.set_pose(r) for r in now.set_pose]
        out.save = [stage.save(n, r) for r in now.save]
        out.restore = [stage.restore(n, r) for r in now.restore]
        out.objects = self._objects(t)
        return out

    def _read(self, t: float) -> Outputs:
        """What the sensors say, and the frames of those that have not been told of: at the first step and later."""
        rigs, late = self._stage.rigs, self._stage.late / self.hz
        at = self._sensors_time(t)
        states = {name: self._world.state(name) for name in rigs}
        bodies = cache(lambda: (self._moving(t), self._surroundings.bodies({**states, **self._flying(t)})))
        out = self.Outputs()
        for name, rig in rigs.items():
            drawn = self._world.motor_energy(name) if rig.charge is not None else 0.0
            moment = Moment(states[name], partial(_others, name, bodies), self._world.touches(name), drawn)
            for output, said in self._faults.spoil(t, name, dict(rig.read(at, moment))).items():
                out.add(output, name, later(said, late) if late else said)
        if new := [name for name in rigs if name not in self._stage.told]:
            out.frames = {name: rigs[name].frames(t) for name in new}
            self._stage.told.update(new)
        return out

    def _is_flat(self, name: str) -> bool:
        return name in self._stage.rigs and self._stage.rigs[name].is_flat

    def _flying(self, t: float) -> dict[str, Whereabouts]:
        return {name: course.at(t) for name, course in self._guests.items()}

    def _moving(self, t: float) -> list[MovingBody]:
        return [*self._surroundings.moving(t).values(), *self._surroundings.objects(self._world.poses()).values()]

    def _sensors_time(self, t: float) -> float:
        """s; the clock, unless a state was restored: then that of the state and what has passed since."""
        return (round(t * self.hz) - self._stage.late) / self.hz if self._stage.late else t

    def _advance(self, t: float, commands: Mapping[str, WheelCommand], joints: Mapping[str, Mapping[str, float]]) -> None:
        """To ``t`` [s], looking at those who read faster than this service steps after each step of the physics."""
        quick = [name for name, rig in self._stage.rigs.items() if rig.is_quick]
        parts = round(self._world.rate / self.hz) if quick else 1
        part = 1 / self.hz / parts
        wheels, steering = {name: speeds_of(c) for name, c in commands.items()}, {name: c.steering for name, c in commands.items()}
        for left in range(parts - 1, -1, -1):
            self._world.advance(wheels, part, t - (left + 1) * part, steering, joints)
            for name in quick if left else ():
                self._stage.rigs[name].glance(self._sensors_time(t) - left * part, self._world.state(name))

    def _objects(self, t: float) -> SimObjects | None:
        """Told while there are any, and once when the last one has gone."""
        if not self._objects_due.at(t):
            return None
        told = self._stage.objects(t)
        had, self._had_objects = self._had_objects, bool(told.objects)
        return told if told.objects or had else None

    def close(self) -> None:
        """Releases the engine."""
        self._world.close()


def _positions(commands: Mapping[str, JointStates], is_flat: Callable[[str], bool]) -> dict[str, dict[str, float]]:
    """Of joints by their vehicles and names [rad or m], as told by those that have power."""
    return {vehicle: positions_of(told) for vehicle, told in commands.items() if not is_flat(vehicle)}


def _others(name: str, bodies: Callable[[], tuple[list[MovingBody], dict[str, MovingBody]]]) -> list[MovingBody]:
    """What moves about a vehicle: solids by script, what has been put in, and the other vehicles."""
    moving, vehicles = bodies()
    return moving + [body for other, body in vehicles.items() if other != name]
