"""With a stranger on the bus nobody dies, every refusal is counted, and no vehicle moves otherwise: actuators are equal to the byte."""

import os

import pytest

from launch import catalogue
from schemas import topics
from schemas.messages import VehicleStatus
from tests.hostile.bus_client import STRANGER, Stranger
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.bus.interface import LocalBus, Query
from uvf.runtime.state.stop_all import StopVoice
from uvf.runtime.time.lockstep import Lockstep

SECONDS = float(os.environ.get("UVF_HOSTILE_SECONDS", "4"))
"""Simulated seconds of a run; by hand some hundreds make a million messages."""
A_TICK = 3
STOPS = (topics.STOP, topics.STOP_STATE)


class Run:
    """A mission in lockstep, with a stranger if there is a seed."""

    def __init__(self, mission, seed=None, until=SECONDS):
        site = load_scenario(ROOT / "missions" / f"{mission}.yaml")
        kinds = [kind for kind in catalogue.needed(site) if kind.clock == "sim" and kind.name != "sim_camera"]
        self.bus, self.warnings, self.replies = LocalBus(), [], []
        self.actuators = {}
        for topic in (topics.WHEEL_COMMAND, topics.SURFACE_COMMAND):
            self.bus.subscribe(topic.at("*"), topic.qos, self._keep)
        self.status = {}
        self.bus.subscribe(topics.STATUS.at("*"), topics.STATUS.qos, self._keep_status)
        self.lockstep = Lockstep(catalogue.hosts(site, kinds), self.bus, self.warnings.append)
        self.stranger = Stranger(seed, sorted(site.members)) if seed is not None else None
        self.lockstep.run(until, self._at_tick)

    def _keep(self, sample):
        if sample.boot != STRANGER:
            self.actuators.setdefault(sample.key, []).append((sample.stamp_ns, sample.payload))

    def _keep_status(self, sample):
        if sample.boot != STRANGER:
            self.status[sample.key.split("/")[1]] = VehicleStatus.FromString(sample.payload)

    def _at_tick(self, t):
        t_ns = round(t * 1e9)
        for _ in range(A_TICK if self.stranger else 0):
            topic = self.stranger.random.choice(list(topics.TOPICS.values()))
            sample = self.stranger.sample(topic, t_ns)
            if topic in STOPS:  # which anybody may engage: only what is broken is hostile
                sample = self.stranger.random_bytes(topic, t_ns, 0)
            for sink in self.bus._sinks_of(sample.key):
                sink(sample)
            self._ask(self.stranger.random.choice(list(topics.REQUESTS.values())), t_ns)
        return True

    def _ask(self, request, t_ns):
        key, payload = self.stranger.request(request)
        self.bus.call(key, payload, t_ns, lambda reply, reason, at: self.replies.append((request, reply, reason)))

    @property
    def refused(self):
        return sum(shell.refusals.count for shell in self.lockstep.shells)


@pytest.mark.parametrize("mission", ["demo", "team"])
@pytest.mark.parametrize("seed", [1])
def test_no_vehicle_moves_otherwise(mission, seed):
    alone, beset = Run(mission), Run(mission, seed)
    assert beset.actuators == alone.actuators
    assert beset.refused > 100
    instances = len(beset.lockstep.shells)
    assert all(beset.warnings.count(line) <= instances for line in set(beset.warnings)), "told more than once"
    assert all(len(line) < 400 and line.isprintable() for line in beset.warnings)


def test_no_hostile_request_is_accepted():
    run = Run("demo", seed=2)
    for request, reply, _ in run.replies:
        assert reply is None or not request.reply.FromString(reply).accepted, request.key
    assert len(run.replies) > 100


def test_stop_all_works_meanwhile():
    run = Run("demo", seed=3, until=2.0)
    voice = StopVoice("gcs")
    key, name = topics.STOP.by("gcs").at("sys"), "uvf.v1.StopCommand"
    run.bus.deliver(key, name, topics.STOP.qos, voice.engage(0, "button").SerializeToString(), 0)
    run.lockstep.run(3.0, run._at_tick)
    assert all(status.stopped for status in run.status.values()) and run.status
    stops = next(iter(run.status.values())).stops
    run.bus.deliver(key, name, topics.STOP.qos, voice.release(0, stops).SerializeToString(), 0)
    run.lockstep.run(4.0, run._at_tick)
    assert not any(status.stopped for status in run.status.values())


def test_one_parameter_request_kills_nobody():
    """A hundred thousand brackets used to end every service, the autopilots too."""
    run = Run("demo", until=0.1)
    for shell in run.lockstep.shells:
        for value in ("[" * 100_000, "[" * 1900, '{"a":' * 300, "9" * 400, "1e999", "NaN", '"' + "x" * 1500 + '"', "-" + "9" * 1999):
            for name in shell.service.params.__struct_fields__[:3] or ("",):
                request = topics.PARAM.message(name=name, value=value, source="evil").SerializeToString()
                key = topics.PARAM.by(shell.type.name).at(shell.owner)
                shell._param_server.queue(Query(key, request, 0, lambda reply, at: run.replies.append(reply), run.replies.append))
    before = {shell.owner + shell.type.name: shell.service.params for shell in run.lockstep.shells}
    run.lockstep.run(1.5)
    assert {shell.owner + shell.type.name: shell.service.params for shell in run.lockstep.shells} == before
    assert run.replies and not any(topics.PARAM.reply.FromString(reply).accepted for reply in run.replies if isinstance(reply, bytes))
