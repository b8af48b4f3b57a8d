"""The ground vehicles' simulator as a service: wheel commands in, what the sensors say out."""

from collections.abc import Mapping
from typing import Protocol

from schemas import topics
from schemas.messages import WheelCommand
from services.sim_ground.body import BodyState, Touch
from services.sim_ground.rig import STEP_HZ, Moment, Rig
from services.sim_ground.surroundings import Surroundings
from uvf.maths.kinematics import WheelSpeeds
from uvf.runtime.service import Outputs, Service, Value, each_vehicle, optional


class GroundWorld(Protocol):
    """The physics behind the service."""

    def advance(self, wheels: Mapping[str, WheelSpeeds], duration: float) -> None: ...

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
        self._world.advance({name: WheelSpeeds(c.left, c.right) for name, c in commands.items()}, 1 / self.hz)
        states = {name: self._world.state(name) for name in self._rigs}
        vehicles, moving = self._surroundings.bodies(states), self._surroundings.moving(t)
        outputs: dict[str, dict[str, Value]] = {}
        for name, rig in self._rigs.items():
            others = moving + [body for other, body in vehicles.items() if other != name]
            for output, read in rig.read(t, Moment(states[name], others, self._world.touches(name))).items():
                outputs.setdefault(output, {})[name] = read
        if not self._told:  # at the first step, which is not always step 1: a process may join a running clock
            outputs["frames"] = {name: rig.frames(t) for name, rig in self._rigs.items()}
            self._told = True
        return outputs

    def close(self) -> None:
        self._world.close()
