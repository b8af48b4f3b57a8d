"""Small services that stand for the real ones wherever the runtime itself is tested."""

from typing import Annotated

import msgspec

from schemas import topics
from schemas.messages import (
    ArmRequest,
    Clock,
    DriveCommand,
    Event,
    Imu,
    NavStatus,
    Reply,
    StopCommand,
    WheelCommand,
)
from uvf.models.params import Params
from uvf.runtime.contract.declaration import (
    Reads,
    Writes,
    answers,
    call,
    each_vehicle,
    every,
    of_role,
    optional,
    replies,
    request,
    stop_all,
    topic,
)
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service import Answer, Service
from uvf.runtime.messages.convert import seconds, stamp
from uvf.runtime.state.stop_all import StopStatus

VEHICLES = ("alpha", "beta")


class Plant(Service):
    """A simulator of all vehicles: a number each, pushed by the wheels, with noise from a seed."""

    name = "plant"
    hz = 100.0
    scope = "world"
    simulator = True

    class Inputs(Reads):
        wheels: dict[str, WheelCommand] = each_vehicle(topics.WHEEL_COMMAND)

    class Outputs(Writes):
        imu: dict[str, Imu] | None = topic(topics.IMU)

    def __init__(self, rng):
        self._rng = rng
        self.state = dict.fromkeys(VEHICLES, 0.0)
        self.times = []

    def step(self, t: float, now: Inputs) -> Outputs:
        self.times.append(t)
        for name, command in now.wheels.items():
            self.state[name] += command.left * 0.01
        out = {}
        for name in VEHICLES:
            imu = Imu(timestamp=stamp(t))
            imu.specific_force.x = self.state[name] + self._rng.normal(0, 0.01)
            imu.angular_velocity.x = t
            out[name] = [imu]
        return self.Outputs(imu=out)


class PilotParams(Params):
    gain: Annotated[float, msgspec.Meta(ge=0, le=10, description="of the loop", extra_json_schema={"unit": "1/s"})] = 1.0


class Pilot(Service):
    """A controller that notes everything it is handed."""

    name = "pilot"
    hz = 50.0

    class Inputs(Reads):
        imu: list[Imu] = every(topics.IMU)
        goal: NavStatus | None = optional(topics.NAV_STATUS)
        stop: StopStatus = stop_all()
        arm: list[ArmRequest] = request(topics.ARM)

    class Outputs(Writes):
        wheels: WheelCommand | None = topic(topics.WHEEL_COMMAND)
        events: list[Event] | None = topic(topics.EVENTS.by("pilot"))
        arm: list[Reply] = replies(topics.ARM)

    def __init__(self):
        self.params = PilotParams()
        self.times = []
        self.imu_times = []
        self.goal_stamps = []
        self.missing = []
        self.stops = 0

    def step(self, t: float, now: Inputs) -> Outputs:
        self.times.append(t)
        self.imu_times += [(t, i.angular_velocity.x) for i in now.imu]
        self.stops += bool(now.stop)
        if now.goal is not None:
            self.goal_stamps.append((t, seconds(now.goal.timestamp)))
        force = now.imu[-1].specific_force.x if now.imu else 0.0
        events = [Event(timestamp=stamp(t), text="armed", source="pilot") for _ in now.arm]
        replies = [Reply(accepted=a.arm, reason="" if a.arm else "only arming") for a in now.arm]
        return self.Outputs(wheels=WheelCommand(timestamp=stamp(t), left=1 - self.params.gain * force), events=events, arm=replies)

    def stale(self, t, missing):
        self.missing.append((t, missing))
        return self.Outputs(wheels=WheelCommand(timestamp=stamp(t)))


class Thinker(Service):
    """Slow work: its results come out half a second after the step."""

    name = "thinker"
    hz = 1.0
    latency = 0.5

    class Inputs(Reads):
        arm: list[Answer[ArmRequest, Reply]] = answers(topics.ARM)

    class Outputs(Writes):
        goal: NavStatus | None = topic(topics.NAV_STATUS)
        arm: list[ArmRequest] = call(topics.ARM)

    def __init__(self):
        self.answers = []

    def step(self, t: float, now: Inputs) -> Outputs:
        self.answers += [(t, a.reply.accepted) for a in now.arm if a.reply]
        return self.Outputs(goal=NavStatus(timestamp=stamp(t)), arm=[ArmRequest(arm=True)])


class Follower(Service):
    """Reads another vehicle's wheels, whichever the mission names its leader."""

    name = "follower"
    hz = 10.0

    class Inputs(Reads):
        leader: WheelCommand = of_role("leader", topics.WHEEL_COMMAND)

    class Outputs(Writes):
        drive: DriveCommand | None = topic(topics.DRIVE.by("follower"))

    def __init__(self):
        self.seen = []

    def step(self, t: float, now: Inputs) -> Outputs:
        self.seen.append((t, seconds(now.leader.timestamp)))
        now.leader.left = 1e9  # a message of its own: nobody else may see this
        return self.Outputs(drive=DriveCommand(timestamp=stamp(t), linear=1.0))


class Watcher(Service):
    """A wall-clock service, as a page is."""

    name = "watcher"
    hz = 50.0
    scope = "world"
    clock = "wall"

    class Inputs(Reads):
        clock: Clock | None = optional(topics.CLOCK)
        wheels: dict[str, WheelCommand] = each_vehicle(topics.WHEEL_COMMAND)

    class Outputs(Writes):
        stop: StopCommand | None = topic(topics.STOP.by("watcher"))

    def __init__(self):
        self.clocks: list[Clock] = []
        self.steps = 0
        self.vehicles = set()

    def step(self, t: float, now: Inputs) -> Outputs:
        self.steps += 1
        self.vehicles |= set(now.wheels)
        if now.clock is not None:
            self.clocks.append(now.clock)
        return self.Outputs(stop=StopCommand(engaged=False) if self.steps == 1 else None)


class Cast:
    """Services by process, and every instance that was made of them, oldest first."""

    simulators: tuple[str, ...] = ()

    def __init__(self):
        self.made: dict[str, list[Service]] = {}

    def host(self, service, vehicle=None, make=None, roles=None):
        def build():
            instance = (make or service)()
            self.made.setdefault(f"{service.name}.{vehicle}" if vehicle else service.name, []).append(instance)
            return instance

        return ServiceInstance(service, build, vehicle, roles)

    def processes(self) -> dict[str, list[ServiceInstance]]:
        """Process name -> its hosts."""
        raise NotImplementedError

    def one(self, name):
        """The newest instance."""
        return self.made[name][-1]


class Toys(Cast):
    """A plant, two pilots, a thinker and a follower."""

    simulators = ("plant",)

    def __init__(self, rng_of):
        super().__init__()
        self._rng_of = rng_of

    def processes(self):
        return {
            "plant": [self.host(Plant, make=lambda: Plant(self._rng_of()))],
            "pilot": [self.host(Pilot, name) for name in VEHICLES],
            "thinker": [self.host(Thinker, "alpha"), self.host(Follower, "beta", roles={"leader": "alpha"})],
        }

    def watcher(self) -> ServiceInstance:
        return self.host(Watcher)
