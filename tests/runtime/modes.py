"""One set of services run four ways: in one process or over Zenoh, each in lockstep and live."""

import socket
import threading
import time

import numpy as np

from schemas import topics
from schemas.messages import Clock, Done
from tests.runtime.in_process import InProcess
from tests.runtime.outcome import Outcome, ask
from tests.runtime.toys import Toys
from uvf.runtime.bus.interface import LocalBus
from uvf.runtime.bus.zenoh_bus import ZenohBus, open_router
from uvf.runtime.log.state_store import StateStore
from uvf.runtime.time.conductor import Conductor
from uvf.runtime.time.live import Live
from uvf.runtime.time.lockstep import Lockstep

SAY_AGAIN = 0.2  # s, wall: how often time that stands is told


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def toys_of(seed):
    return Toys(lambda: np.random.default_rng(seed))


def run_local(until, seed=1):
    toys, bus, samples = toys_of(seed), LocalBus(), []
    lockstep = Lockstep([h for hosts in toys.processes().values() for h in hosts], bus)
    bus.subscribe("uvf/**", topics.Qos.SENSOR, samples.append)
    lockstep.run(until)
    lockstep.close()
    return Outcome(toys, samples)


class Distributed:
    """A router, a keeper, a conductor and one Live per process, each with a session of its own, in threads."""

    def __init__(self, lockstep, cast=None, watcher=False):
        self.endpoint = f"tcp/127.0.0.1:{free_port()}"
        self.lockstep = lockstep
        self.toys = cast or toys_of(1)
        self.samples = []
        self.warnings = []
        processes = self.toys.processes()
        others = [name for name in processes if name not in self.toys.simulators]
        self.conductor = Conductor(self.toys.simulators, others, 1.0, lockstep)
        self._processes = processes | ({"watcher": [self.toys.watcher()]} if watcher else {})
        self._threads = {}
        self._stops = {}
        self._told = 0.0

    def __enter__(self):
        self._router = open_router(self.endpoint)
        self.bus = ZenohBus(self.endpoint, blocking=self.lockstep)
        self._keeper = StateStore(ZenohBus(self.endpoint), print)
        self.bus.subscribe_all(self.samples.append, depth=100_000)
        self.bus.subscribe(topics.DONE.by("*").at("sys"), topics.DONE.qos, self._on_done, depth=1000, wake=True)
        self._clock = self.bus.publisher(topics.CLOCK.at("sys"), Clock.DESCRIPTOR.full_name, topics.CLOCK.qos)
        for name in self._processes:
            self.start(name)
        return self

    def _on_done(self, sample):
        self.conductor.done(Done.FromString(sample.payload), sample.boot)

    def start(self, name):
        self._stops[name] = threading.Event()
        self._threads[name] = threading.Thread(target=self._live, args=(name, self._stops[name]))
        self._threads[name].start()

    def end(self, name):
        """Ends one process as if it had died: its session goes, nothing else hears of it."""
        self._stops[name].set()
        self._threads[name].join()
        self.turn()

    def _live(self, name, stop):
        with ZenohBus(self.endpoint, blocking=self.lockstep) as bus:
            Live(name, self._processes[name], bus, self.warnings.append).run(stop)

    def turn(self):
        """Hands over what has arrived, and waits a little for more."""
        self.bus.wait(0.002)
        while self.bus.poll():
            pass
        self._keeper.poll()

    def run(self, until, patience=60.0):
        """Lets time run to ``until`` [s, simulation], and everything arrive."""
        end = time.monotonic() + patience
        while self.conductor.t_ns < until * 1e9 or self.conductor.waiting_for():
            assert time.monotonic() < end, f"time stands at {self.conductor.t_ns / 1e9} s, waiting for {self.conductor.waiting_for()}"
            self.turn()
            wall = time.monotonic()
            tick = self.conductor.advance(wall) if self.conductor.t_ns < until * 1e9 else None
            if tick is None and self.conductor.started and wall - self._told > SAY_AGAIN:
                tick = self.conductor.clock(wall)
            if tick is not None:
                self._told, self.bus.epoch = wall, tick.epoch
                self._clock.put(tick.SerializeToString(deterministic=True), tick.t_ns)

    def run_on(self, seconds):
        """So much further."""
        self.run(self.conductor.t_ns / 1e9 + seconds)

    def ask(self, request, owner, message, stamp):
        """Asks as a client does; the list will hold (reply or None, reason, stamp [s] of the answer)."""
        return ask(self.bus, request, owner, message, stamp)

    def outcome(self):
        return Outcome(self.toys, self.samples)

    def __exit__(self, *_):
        for name in self._processes:
            self._stops[name].set()
        for thread in self._threads.values():
            thread.join()
        self.turn()
        self.bus.close()
        self._keeper._bus.close()
        self._router.close()


def run_in(run, until):
    with run:
        run.run(until)
    return run.outcome()


RUNS = {
    "one process, lockstep": lambda cast=None: InProcess(True, cast or toys_of(1)),
    "one process, live": lambda cast=None: InProcess(False, cast or toys_of(1)),
    "zenoh, lockstep": lambda cast=None: Distributed(True, cast),
    "zenoh, live": lambda cast=None: Distributed(False, cast),
}
MODES = {"one process": run_local} | {
    name: lambda until, seed=1, make=make: run_in(make(toys_of(seed)), until)
    for name, make in RUNS.items()
    if name != "one process, lockstep"
}
