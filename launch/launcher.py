"""A supervisor with a voice: what dies and what is given up is told on the bus, and stops the vehicles."""

import signal
from collections.abc import Callable
from threading import Event as Flag

from launch.output import Write
from launch.supervisor import Supervisor
from schemas import topics
from schemas.messages import Clock, Event, Processes, StopCommand, StopEngagement
from uvf.runtime.bus.address import router_from
from uvf.runtime.bus.interface import Publisher
from uvf.runtime.bus.wire import Malformed, decode
from uvf.runtime.bus.zenoh_bus import ZenohBus
from uvf.runtime.messages.convert import stamp_ns
from uvf.runtime.state.stop_all import StopBook, StopVoice, name_of

LOOK = 0.1  # s, how often to look for the dead

Say = Callable[[str], None]


class Launcher:
    """Starts and supervises processes: all of a mission, or the only one of a container."""

    def __init__(self, name: str, say: Say) -> None:
        """name: who speaks on the bus, on keys of its own."""
        self.name = name
        self.bus: ZenohBus | None = None
        self.failed = False
        """Something has been given up."""
        self._say = say
        self._supervisor = Supervisor(self._on_death)
        self._untold: list[tuple[str, bool]] = []
        self._stops = StopBook()
        self._voice = StopVoice(name)
        self._t_ns = 0

    def start(self, name: str, arguments: list[str], write: Write) -> None:
        """Starts ``uvf <arguments>`` with its output to ``write``; whoever has started the last one calls ``tell``."""
        self._supervisor.start(name, arguments, write)

    def connect(self, timeout: float) -> ZenohBus:
        """Connects to the router. Raises BadInput when there is none within ``timeout`` [s]."""
        self.bus = bus = ZenohBus(router_from(), timeout=timeout)
        self._events = self._publisher(bus, topics.SYSTEM_EVENTS)
        self._stop = self._publisher(bus, topics.STOP)
        self._processes = self._publisher(bus, topics.PROCESSES)
        self._stops.follow(bus)
        bus.token(f"@node/sys/{self.name}/{bus.boot:x}")
        self.tell()
        return bus

    def _publisher(self, bus: ZenohBus, topic: topics.Topic[topics.M]) -> Publisher:
        return bus.publisher(topic.by(self.name).at("sys"), topic.message.DESCRIPTOR.full_name, topic.qos)

    def _ask_time(self, bus: ZenohBus) -> None:
        """From the keeper; following the clock would cost each container 1 % of a core."""
        left = bus.recall(topics.CLOCK.at("sys"))
        if left is None:
            return
        try:
            clock = decode("clock", left, Clock)
        except Malformed as error:
            self._say(str(error))
            return
        self._t_ns, bus.epoch = clock.t_ns, clock.epoch

    def look(self) -> None:
        """Polls the bus, restarts what has died and publishes changes."""
        if self.bus is not None:
            self.bus.poll()
            self._heed_release()
        if self._supervisor.look():
            self.tell()

    def _heed_release(self) -> None:
        """Once an operator has released what it had engaged, it no longer says so to those who come late."""
        if self._voice.engages is not None and self._voice.engages not in map(name_of, self._stops.now.engagements):
            self._say_stop(self._voice.withdraw(self._t_ns))

    def _say_stop(self, command: StopCommand) -> None:
        self._stop.put(command.SerializeToString(deterministic=True), self._t_ns)

    def _on_death(self, line: str, given_up: bool) -> None:
        self._say(line)
        self._untold.append((line, given_up))
        if given_up:
            self.failed = True
            self._say(f"STOP ALL: {line}")

    def tell(self) -> None:
        """Publishes the deaths not yet reported and the state of the processes; without a bus they wait for ``connect``."""
        if self.bus is None:
            return
        self._ask_time(self.bus)
        now, source = self._t_ns, self.name
        for line, given_up in self._untold:
            severity = Event.CRITICAL if given_up else Event.WARNING
            event = Event(timestamp=stamp_ns(now), severity=severity, text=line, source=source)
            self._events.put(event.SerializeToString(deterministic=True), now)
            if given_up:
                # What cannot be kept alive: every vehicle goes to its safe state until somebody releases it.
                stop = self._voice.engage(now, line)
                self._stops.take_up([StopEngagement(source=source, id=stop.id)])
                self._say_stop(stop)
        self._untold.clear()
        processes = Processes(timestamp=stamp_ns(now), processes=self._supervisor.describe())
        self._processes.put(processes.SerializeToString(deterministic=True), now)

    def stop(self) -> None:
        """Ends all processes and publishes that, while there is still a router."""
        self._supervisor.end(but="router")
        self.tell()
        if self.bus is not None:
            self.bus.close()
            self.bus = None
        self._supervisor.end()


def stop_flag() -> Flag:
    """A flag that Ctrl-C and SIGTERM set."""
    stop = Flag()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.set())
    return stop
