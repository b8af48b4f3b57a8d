"""Hello service: what it reads and writes as data, and one pure function of time.

    .venv/bin/python examples/01_hello_service.py

The service below watches a vehicle's speed and says when it is fast. It runs here in lockstep on a bus inside this
process; the very same class runs over Zenoh in a process of its own.
"""

from schemas import topics
from schemas.messages import DriveCommand, Event
from uvf.runtime.contract.declaration import Reads, Writes, topic
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import stamp
from uvf.runtime.time.lockstep import Lockstep


class Driver(Service):
    """Asks for more and more speed."""

    name = "driver"
    hz = 10.0

    class Outputs(Writes):
        drive: DriveCommand | None = topic(topics.DRIVE.by("client"))

    def step(self, t: float, now) -> Outputs:
        return self.Outputs(drive=DriveCommand(timestamp=stamp(t), linear=0.1 * t))


class Watch(Service):
    """Says when more than 0.2 m/s are asked for."""

    name = "watch"
    hz = 5.0

    class Inputs(Reads):
        drive: DriveCommand = topic(topics.DRIVE.by("client"))

    class Outputs(Writes):
        events: list[Event] | None = topic(topics.EVENTS.by("watch"))

    def step(self, t: float, now: Inputs) -> Outputs:
        if now.drive.linear <= 0.2:
            return self.Outputs()
        return self.Outputs(events=Event(timestamp=stamp(t), text=f"fast: {now.drive.linear:.2f} m/s", source="watch"))


lockstep = Lockstep([ServiceInstance(Driver, Driver, "rover"), ServiceInstance(Watch, Watch, "rover")])
lockstep.bus.subscribe("uvf/rover/state/**", topics.Qos.EVENT, lambda s: print(Event.FromString(s.payload).text))
lockstep.run(until=3.0)
