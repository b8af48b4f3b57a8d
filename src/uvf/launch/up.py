"""``uvf up``: every process of a mission, supervised, until Ctrl-C."""

import signal
import socket
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from threading import Event as Flag

from schemas import topics
from schemas.convert import stamp_ns
from schemas.messages import Clock, Event, Health, Processes, StopCommand
from uvf.launch import catalogue, settings
from uvf.launch.supervisor import Supervisor
from uvf.runtime.address import address_from, host_and_port, router_from
from uvf.runtime.bus import Sample
from uvf.runtime.params import BadInput
from uvf.runtime.site import load_site
from uvf.runtime.wire import guarded
from uvf.runtime.zenoh_bus import ZenohBus

LOOK = 0.1  # s, how often the supervisor looks for the dead
ROUTER_PATIENCE = 10.0  # s
HANGS = 10.0  # s, of silence

Say = Callable[[str], None]


@dataclass(frozen=True)
class Wanted:
    """What ``uvf up`` was asked for."""

    mission: str
    rate: float = 1.0
    page: bool = True
    seconds: float | None = None


def up(wanted: Wanted, folder: Path, say: Say) -> int:
    """Runs until Ctrl-C, SIGTERM or the time is over; returns the exit code. Raises BadInput before anything starts."""
    site = load_site(settings.mission_path(wanted.mission))
    kinds = [k for k in catalogue.needed(site) if wanted.page or k.name != "gcs"]
    stop = Flag()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.set())
    run = Run(wanted, folder, say)
    try:
        run.start([k.name for k in kinds])
        run.watch(stop)
    finally:
        say("stopping")
        run.stop()
        say(f"{run.simulated:.1f} s simulated; log and output in {folder}")
    return 1 if run.failed else 0


def check_ports(page: bool) -> None:
    """One clear line for a port that is taken, before anything is started. Raises BadInput."""
    host, port = host_and_port(router_from())
    wanted = [(host, port, "the router", "UVF_ROUTER=tcp/127.0.0.1:7448")]
    if page:
        address = address_from()
        wanted.append((address.host, address.port, "the page", "UVF_GCS_PORT=8081"))
    for host, port, what, mend in wanted:
        with socket.socket() as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                probe.bind((host, port))
            except OSError as error:
                line = f"port {port} for {what} is taken ({error.strerror}): is another 'uvf up' running? Choose another with {mend}"
                raise BadInput(line) from error


class Run:
    """The processes of one run and the launcher's own voice on the bus."""

    def __init__(self, wanted: Wanted, folder: Path, say: Say) -> None:
        self._wanted = wanted
        self._say = say
        self._folder = folder
        self._supervisor = Supervisor(folder, self._on_death)
        self._bus: ZenohBus | None = None
        self._lives: dict[str, tuple[int, float]] = {}
        self._t_ns = 0
        self._moving_since: float | None = None
        self._begun = time.monotonic()
        self.failed = False

    def start(self, services: list[str]) -> None:
        """The router first, then everybody; the conductor lets time begin when all are there."""
        mission = self._wanted.mission
        self._supervisor.start("router", ["router"])
        self._bus = ZenohBus(router_from(), timeout=ROUTER_PATIENCE)
        self._declare(self._bus)
        self._supervisor.start("conductor", ["service", "conductor", "--mission", mission, "--rate", str(self._wanted.rate)])
        for name in services:
            self._supervisor.start(name, ["service", name, "--mission", mission])
        self._supervisor.start("recorder", ["record", str(self._folder), "--mission", mission])
        self._tell_processes()

    def _declare(self, bus: ZenohBus) -> None:
        events, stop = topics.SYSTEM_EVENTS.by("launcher"), topics.STOP.by("launcher")
        self._events = bus.publisher(events.at("sys"), Event.DESCRIPTOR.full_name, events.qos)
        self._stop = bus.publisher(stop.at("sys"), StopCommand.DESCRIPTOR.full_name, stop.qos)
        self._processes = bus.publisher(topics.PROCESSES.at("sys"), Processes.DESCRIPTOR.full_name, topics.PROCESSES.qos)
        bus.subscribe(topics.CLOCK.at("sys"), topics.CLOCK.qos, guarded(topics.CLOCK, self._on_clock, self._say), depth=1)
        for name in ("conductor", "recorder"):
            told = topics.SYSTEM_EVENTS.by(name)
            bus.subscribe(told.at("sys"), told.qos, guarded(told, lambda event, _: self._say(event.text), self._say), depth=16)
        health = topics.HEALTH.by("*")
        bus.subscribe(health.at("sys"), health.qos, guarded(health, self._on_health, self._say), depth=64)
        bus.token(f"@node/sys/launcher/{bus.boot:x}")

    def _on_clock(self, clock: Clock, sample: Sample) -> None:
        self._t_ns = clock.t_ns
        if clock.tick and self._moving_since is None:
            self._moving_since = time.monotonic()
            self._say(f"time runs, {self._moving_since - self._begun:.1f} s after the start")

    @property
    def simulated(self) -> float:
        """s."""
        return self._t_ns / 1e9

    def watch(self, stop: Flag) -> None:
        """Until ``stop``; starts again what dies."""
        while not stop.wait(LOOK) and not self._over() and not self._cannot_begin():
            if self._bus is not None:
                self._bus.poll()
            self._end_silent()
            if self._supervisor.look():
                self._tell_processes()

    def _on_health(self, health: Health, sample: Sample) -> None:
        self._lives[health.service] = (health.pid, time.monotonic())

    def _end_silent(self) -> None:
        """A process that hangs is ended, and started again like one that has died."""
        for name, (pid, heard) in list(self._lives.items()):
            child = self._supervisor.children.get(name)
            if child is None or child.describe().pid != pid:
                del self._lives[name]
            elif time.monotonic() - heard > HANGS:
                del self._lives[name]
                self._say(f"{name} has been silent for {HANGS:g} s: it is ended")
                self._supervisor.kill(name)

    def _over(self) -> bool:
        """Whether the seconds asked for have passed since time began to run."""
        wanted, since = self._wanted.seconds, self._moving_since
        return wanted is not None and since is not None and time.monotonic() - since > wanted

    def _cannot_begin(self) -> bool:
        """Whether a service has been given up that time waits for."""
        return self.failed and self._moving_since is None

    def _on_death(self, line: str, given_up: bool) -> None:
        self._say(line)
        severity = Event.CRITICAL if given_up else Event.WARNING
        event = Event(timestamp=stamp_ns(self._t_ns), severity=severity, text=line, source="launcher")
        if self._bus is not None:
            self._events.put(event.SerializeToString(deterministic=True), self._t_ns)
        if given_up:
            self.failed = True
            self._stop_all(line)

    def _stop_all(self, line: str) -> None:
        """A service that cannot be kept alive: every vehicle goes to its safe state until somebody releases it."""
        command = StopCommand(timestamp=stamp_ns(self._t_ns), engaged=True, source="launcher")
        if self._bus is not None:
            self._stop.put(command.SerializeToString(deterministic=True), self._t_ns)
        self._say(f"STOP ALL: {line}")

    def _tell_processes(self) -> None:
        message = Processes(timestamp=stamp_ns(self._t_ns), processes=[c.describe() for c in self._supervisor.children.values()])
        self._processes.put(message.SerializeToString(deterministic=True), self._t_ns)

    def stop(self) -> None:
        if self._bus is not None:
            self._bus.close()
            self._bus = None
        self._supervisor.stop()
