"""One set of services run three ways: in one process, over Zenoh in lockstep, over Zenoh in real time."""

import socket
import threading
import time

import numpy as np

from schemas import topics
from schemas.messages import Clock, Done
from tests.runtime.toys import Toys
from uvf.runtime.bus import LocalBus
from uvf.runtime.conductor import Conductor
from uvf.runtime.live import Live
from uvf.runtime.lockstep import Lockstep
from uvf.runtime.recording import LogHash
from uvf.runtime.zenoh_bus import ZenohBus, open_router


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Outcome:
    """What a run has left: its toys, its messages in order, its hash."""

    def __init__(self, toys, samples):
        self.toys = toys
        self.samples = [s for s in samples if "/time/" not in s.key and "/health/" not in s.key]
        log_hash = LogHash()
        for s in sorted(self.samples, key=lambda s: (s.key, s.stamp_ns, s.seq)):
            log_hash.add(s.key, s.stamp_ns, s.seq, s.payload)
        self.hash = log_hash.hexdigest()

    def of(self, key):
        return [s for s in self.samples if s.key == key]


def run_local(until, seed=1):
    toys, bus, samples = Toys(lambda: np.random.default_rng(seed)), LocalBus(), []
    lockstep = Lockstep([h for hosts in toys.processes().values() for h in hosts], bus)
    bus.subscribe("uvf/**", topics.Qos.SENSOR, samples.append)
    lockstep.run(until)
    lockstep.close()
    return Outcome(toys, samples)


class Distributed:
    """A router, a conductor and one Live per process, each with a session of its own, in threads."""

    def __init__(self, lockstep, seed=1, rate=1.0, watcher=False):
        self.endpoint = f"tcp/127.0.0.1:{free_port()}"
        self.lockstep = lockstep
        self.stop = threading.Event()
        self.toys = Toys(lambda: np.random.default_rng(seed))
        self.samples = []
        self.warnings = []
        self.conductor = Conductor(["plant"], ["pilot", "thinker"], rate, lockstep)
        self._processes = self.toys.processes() | ({"watcher": [self.toys.watcher()]} if watcher else {})
        self._threads = {}
        self._stops = {}

    def __enter__(self):
        self._router = open_router(self.endpoint)
        self.bus = ZenohBus(self.endpoint, blocking=self.lockstep)
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

    def _live(self, name, stop):
        with ZenohBus(self.endpoint, blocking=self.lockstep) as bus:
            Live(name, self._processes[name], bus, self.warnings.append).run(stop)

    def run(self, until, patience=60.0):
        """Lets time run to ``until`` [s, simulation], and everything arrive."""
        end = time.monotonic() + patience
        while self.conductor.t_ns < until * 1e9 or self.conductor.waiting_for():
            assert time.monotonic() < end, f"time stands at {self.conductor.t_ns / 1e9} s, waiting for {self.conductor.waiting_for()}"
            self.bus.wait(0.002)
            self.bus.poll()
            tick = self.conductor.advance(time.monotonic()) if self.conductor.t_ns < until * 1e9 else None
            if tick is not None:
                self._clock.put(tick.SerializeToString(deterministic=True), tick.t_ns)

    def outcome(self):
        return Outcome(self.toys, self.samples)

    def __exit__(self, *_):
        for name in self._processes:
            self._stops[name].set()
        for thread in self._threads.values():
            thread.join()
        self.bus.poll()
        self.bus.close()
        self._router.close()


def run_zenoh(until, lockstep, seed=1, rate=1.0):
    with Distributed(lockstep, seed, rate) as run:
        run.run(until)
    return run.outcome()


MODES = {
    "one process": run_local,
    "zenoh lockstep": lambda until, seed=1: run_zenoh(until, True, seed),
    "zenoh real time": lambda until, seed=1: run_zenoh(until, False, seed),
}
