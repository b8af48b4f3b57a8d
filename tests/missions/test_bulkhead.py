"""Five rovers and three aircraft, one of each failing at every step: the other six finish their mission with the same bytes as without."""

import pytest
import yaml

from launch import catalogue
from schemas import topics
from schemas.messages import Event, MissionProgress, NavState, VehicleStatus
from services.autopilot.air.service import AutopilotAir
from services.autopilot.ground.service import GroundAutopilot
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.bus.interface import LocalBus
from uvf.runtime.time.lockstep import Lockstep

ROVERS = {
    "ann": ((2.2, 1.3), (3.4, 1.4)),
    "bob": ((10.0, 1.4), (10.0, 2.6)),
    "cat": ((2.8, 7.7), (3.0, 6.6)),
    "dan": ((9.4, 7.2), (9.4, 8.1)),
    "eve": ((7.0, 4.4), None),  # would be seen by the others if she moved in one run only
}
AIRCRAFT = {"kim": 60.0, "leo": 90.0, "max": 120.0}
FAILING = {"eve": 5, "max": 13}
SYSTEMS = {name: n for n, name in enumerate(ROVERS, 1)} | {name: n for n, name in enumerate(AIRCRAFT, 11)}
UNTIL = 16.0  # s
COMPLETE = MissionProgress.COMPLETE


def mission(folder):
    vehicles = {}
    for name, ((x, y), to) in ROVERS.items():
        job = {"mission": [{"x": to[0], "y": to[1]}]} if to else {}
        vehicles[name] = {"model": "burger", "system_id": SYSTEMS[name], "start": {"x": x, "y": y}, "job": job}
    for name, z in AIRCRAFT.items():
        start = {"x": -200.0, "y": -150.0, "z": z, "speed": 25.0}
        items = [{"x": -100.0, "y": -150.0, "z": z}, {"x": 20.0, "y": -150.0, "z": z}]
        vehicles[name] = {"model": "milvus", "system_id": SYSTEMS[name], "start": start, "job": {"mission": items}}
    path = folder / "bulkhead.yaml"
    path.write_text(yaml.safe_dump({"about": "a test", "world": "house", "seed": 1, "duration": UNTIL, "vehicles": vehicles}))
    return path


class Run:
    def __init__(self, path):
        site = load_scenario(path, ROOT)
        self.bus, self.actuators, self.newest, self.events, self.height = LocalBus(), {}, {}, [], []
        for topic in (topics.WHEEL_COMMAND, topics.SURFACE_COMMAND):
            self.bus.subscribe(topic.at("*"), topic.qos, lambda s: self.actuators.setdefault(s.key.split("/")[1], []).append(s.payload))
        for topic in (topics.STATUS, topics.PROGRESS):
            self.bus.subscribe(topic.at("*"), topic.qos, self._keep(topic))
        self.bus.subscribe("uvf/*/state/events/*", topics.EVENTS.qos, lambda s: self.events.append((s.key, Event.FromString(s.payload))))
        self.bus.subscribe(
            topics.TRUTH.at("max"), topics.TRUTH.qos, lambda s: self.height.append(NavState.FromString(s.payload).position.z)
        )
        kinds = [kind for kind in catalogue.needed(site) if kind.clock == "sim" and kind.name not in ("sim_camera", "merging")]
        lockstep = Lockstep(catalogue.hosts(site, kinds), self.bus, contains=True)
        lockstep.run(UNTIL)
        lockstep.close()

    def _keep(self, topic):
        return lambda s: self.newest.__setitem__((s.key.split("/")[1], topic), topic.message.FromString(s.payload))


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    path = mission(tmp_path_factory.mktemp("missions"))
    alone = Run(path)
    with pytest.MonkeyPatch.context() as patch:
        for kind, system in ((GroundAutopilot, FAILING["eve"]), (AutopilotAir, FAILING["max"])):
            patch.setattr(kind, "step", failing(kind.step, system))
        return alone, Run(path)


def failing(step, system):
    def fails(self, t, now):
        if getattr(self, "_system_id", None) == system or getattr(getattr(self, "_config", None), "system_id", None) == system:
            raise ZeroDivisionError("as told")
        return step(self, t, now)

    return fails


def test_the_others_finish_with_the_same_actuator_bytes(runs):
    alone, beset = runs
    for name in (*ROVERS, *AIRCRAFT):
        if name not in FAILING:
            assert beset.actuators[name] == alone.actuators[name], name
            assert beset.newest[name, topics.PROGRESS].state == COMPLETE, name


def test_each_failure_is_told_of_its_own_vehicle_only(runs):
    _, beset = runs
    told = [(key.split("/")[1], event) for key, event in beset.events if "ZeroDivisionError" in event.cause]
    for name in FAILING:
        mine = [event.severity for owner, event in told if owner == name]
        assert mine == [Event.ERROR, Event.ERROR, Event.CRITICAL]
    assert {owner for owner, _ in told} == set(FAILING)


def test_the_failing_ones_are_in_their_safe_state(runs):
    _, beset = runs
    rover = topics.WHEEL_COMMAND.message.FromString(beset.actuators["eve"][-1])
    aircraft = topics.SURFACE_COMMAND.message.FromString(beset.actuators["max"][-1])
    assert (rover.left, rover.right) == (0.0, 0.0)
    assert aircraft.throttle == 0.0 and aircraft.rudder > 0
    assert beset.height[-1] < beset.height[0] - 15.0
    for name in FAILING:
        assert "was given up: ZeroDivisionError" in beset.newest[name, topics.STATUS].reason
        assert isinstance(beset.newest[name, topics.STATUS], VehicleStatus)
