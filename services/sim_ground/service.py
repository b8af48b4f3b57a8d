"""The ground vehicles' simulator as a service: wheel commands in, what the sensors say out."""

from collections.abc import Callable, Mapping
from functools import cache, partial
from typing import Protocol

from schemas import topics
from schemas.messages import WheelCommand
from services.sim_ground.body import BodyState, Touch
from services.sim_ground.rig import STEP_HZ, Moment, Rig
from services.sim_ground.surroundings import Surroundings
from uvf.maths.kinematics import WheelSpeeds
from uvf.maths.raycast3 import Body
from uvf.runtime.service import Outputs, Service, Value, each_vehicle, optional


class GroundWorld(Protocol):
    """The physics behind the service."""

    rate: float
    """Physics steps a second."""

    def advance(self, wheels: Mapping[str, WheelSpeeds], duration: float, since: float) -> None: ...

    def state(self, vehicle: str) -> BodyState: ...

    def touches(self, vehicle: str) -> list[Touch]: ...

    def close(self) -> None: ...


class SimGround(Service):
    """All ground vehicles in one world. A vehicle whose command is older than 0.5 s brakes its wheels to a stand.

    Truth is the motion of base_link: the point on the floor under the axle's middle, in the world frame.
    """

    name = "sim_ground"
    hz = STEP_HZ
    scope = "world"
    simulator = True
    inputs = {"commands": each_vehicle(optional(topics.WHEEL_COMMAND))}
    outputs = {
        "imu": topics.IMU,
        "scan": topics.SCAN,
        "wheels": topics.WHEELS,
        "gnss": topics.GNSS,
        "sonar": topics.SONAR,
        "contact": topics.CONTACT,
        "joints": topics.JOINTS,
        "joint_frames": topics.TF_JOINTS,
        "frames": topics.TF_STATIC,
        "truth": topics.TRUTH,
    }

    def __init__(self, world: GroundWorld, rigs: Mapping[str, Rig], surroundings: Surroundings) -> None:
        self._world = world
        self._surroundings = surroundings
        self._rigs = rigs
        self._told = False

    def step(self, t: float, commands: dict[str, WheelCommand]) -> Outputs:
        self._advance(t, {name: WheelSpeeds(c.left, c.right) for name, c in commands.items()})
        states = {name: self._world.state(name) for name in self._rigs}
        bodies = cache(lambda: (self._surroundings.moving(t), self._surroundings.bodies(states)))
        outputs: dict[str, dict[str, Value]] = {}
        for name, rig in self._rigs.items():
            moment = Moment(states[name], partial(_others, name, bodies), self._world.touches(name))
            for output, read in rig.read(t, moment).items():
                outputs.setdefault(output, {})[name] = read
        if not self._told:  # at the first step, which is not always step 1: a process may join a running clock
            outputs["frames"] = {name: rig.frames(t) for name, rig in self._rigs.items()}
            self._told = True
        return outputs

    def _advance(self, t: float, wheels: Mapping[str, WheelSpeeds]) -> None:
        """To ``t`` [s], looking at those who read faster than this service steps after each step of the physics."""
        quick = [name for name, rig in self._rigs.items() if rig.is_quick]
        parts = round(self._world.rate / self.hz) if quick else 1
        duration = 1 / self.hz
        for n in range(parts):
            self._world.advance(wheels, duration / parts, t - duration + n * duration / parts)
            for name in quick if n < parts - 1 else ():
                self._rigs[name].glance(t - duration + (n + 1) * duration / parts, self._world.state(name))

    def close(self) -> None:
        self._world.close()


def _others(name: str, bodies: Callable[[], tuple[list[Body], dict[str, Body]]]) -> list[Body]:
    """What moves about a vehicle: solids by script and the other vehicles."""
    moving, vehicles = bodies()
    return moving + [body for other, body in vehicles.items() if other != name]
