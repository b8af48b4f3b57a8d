"""What a launcher says on the bus, as each container has one: deaths, STOP ALL, what runs."""

import os
import signal
import threading

import pytest

import uvf
from launch.launcher import Launcher
from launch.supervisor import DEATHS
from schemas import topics
from schemas.messages import Clock, Event, Process
from tests.runtime.modes import free_port
from uvf.runtime.bus.zenoh_bus import ZenohBus, open_router
from uvf.runtime.log.state_store import StateStore

NAME = "launcher.recorder"
CLOCK = Clock(tick=500, t_ns=5_000_000_000, epoch=3)
PATIENCE = 20.0


class Scene:
    """A router, a clock that stands in its third epoch, a launcher around a recorder, and who listens."""

    def __init__(self, endpoint, folder):
        self.said, self.heard = [], []
        self.bus = ZenohBus(endpoint, timeout=5.0)
        self.client = uvf.connect(endpoint)
        for topic in (topics.STOP, topics.SYSTEM_EVENTS, topics.PROCESSES):
            self.bus.subscribe(topic.by("*").at("sys"), topic.qos, self.heard.append, depth=100)
        self.clock = self.bus.publisher(topics.CLOCK.at("sys"), "uvf.v1.Clock", topics.CLOCK.qos)
        self.launcher = Launcher(NAME, self.said.append)
        self.launcher.start("recorder", ["record", str(folder)], lambda line: None)

    def connect(self):
        def kept():
            self.clock.put(CLOCK.SerializeToString(), CLOCK.t_ns)
            return self.bus.recall(topics.CLOCK.at("sys")) is not None

        self.client.wait(kept, PATIENCE)
        self.launcher.connect(5.0)

    def until(self, condition):
        def look():
            self.launcher.look()
            self.bus.poll()
            return condition()

        self.client.wait(look, PATIENCE)

    def kill(self):
        """kill -9, and wait until the launcher has seen it."""
        deaths = len(self.said)
        (child,) = self.launcher._supervisor.describe()
        os.kill(child.pid, signal.SIGKILL)
        self.until(lambda: len(self.said) > deaths)

    def newest(self, topic):
        samples = [s for s in self.heard if s.key == topic.by(NAME).at("sys")]
        return (samples[-1], topic.message.FromString(samples[-1].payload)) if samples else (None, None)

    def process(self):
        message = self.newest(topics.PROCESSES)[1]
        return message.processes[0] if message else Process()

    def close(self):
        self.launcher.stop()
        self.client._bus.close()
        self.bus.close()


def keep(endpoint, stop):
    with ZenohBus(endpoint, timeout=5.0) as bus:
        keeper = StateStore(bus, print)
        while not stop.wait(0.01):
            keeper.poll()


@pytest.fixture
def scene(monkeypatch, tmp_path):
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    monkeypatch.setenv("UVF_ROUTER", endpoint)
    router = open_router(endpoint)
    stop = threading.Event()
    keeper = threading.Thread(target=keep, args=(endpoint, stop))
    keeper.start()
    made = Scene(endpoint, tmp_path)
    yield made
    made.close()
    stop.set()
    keeper.join()
    router.close()


def test_a_death_is_an_event_and_the_process_runs_again(scene):
    scene.connect()
    scene.kill()
    scene.until(lambda: scene.process().restarts == 1)
    assert scene.process().state == Process.RUNNING
    sample, event = scene.newest(topics.SYSTEM_EVENTS)
    assert (event.severity, event.text) == (Event.WARNING, "recorder ended by signal 9; started again")
    assert sample.stamp_ns == CLOCK.t_ns
    assert scene.newest(topics.STOP) == (None, None)
    assert not scene.launcher.failed


def test_the_third_death_stops_all_vehicles_says_so_and_stays_visible(scene):
    scene.connect()
    for _ in range(DEATHS):
        scene.kill()
    scene.until(lambda: scene.process().state == Process.FAILED)
    _, event = scene.newest(topics.SYSTEM_EVENTS)
    assert (event.severity, event.text) == (Event.CRITICAL, "recorder ended by signal 9; given up")
    sample, stop = scene.newest(topics.STOP)
    assert stop.engaged and stop.source == NAME
    # Later than a release that somebody has said in this epoch.
    assert (sample.epoch, sample.stamp_ns) == (CLOCK.epoch, CLOCK.t_ns)
    assert scene.launcher.failed


def test_what_has_died_before_there_was_a_router_is_told_when_there_is_one(scene):
    for _ in range(DEATHS):
        scene.kill()
    assert scene.heard == []
    scene.connect()
    scene.until(lambda: scene.newest(topics.STOP)[1] is not None and scene.process().state == Process.FAILED)
    assert [s for s in scene.heard if s.key == topics.SYSTEM_EVENTS.by(NAME).at("sys")][DEATHS - 1]


def test_its_end_is_told_too(scene):
    scene.connect()
    scene.until(lambda: scene.process().state == Process.RUNNING)
    scene.launcher.stop()
    scene.client.wait(lambda: (scene.bus.poll(), scene.process().state == Process.ENDED)[1], PATIENCE)
