"""A service that a rover cannot drive without is given up on its way: the rover stands, and its operator is told by whom it was left."""

import pytest

from launch import catalogue
from launch.settings import mission_path
from schemas import topics
from schemas.messages import Event, WheelCommand
from uvf.models.scenario import load_scenario
from uvf.runtime.bus.interface import LocalBus
from uvf.runtime.time.lockstep import Lockstep

FAILS = 8.0  # s
UNTIL = 15.0  # s
SERVICES = ("odometry", "mapping", "planner", "tracker")


class Run:
    def __init__(self, name, monkeypatch):
        site = load_scenario(mission_path("demo"))
        kinds = [catalogue.kind(kind) for kind in ("sim_ground", "slam", "planner", "autopilot")]
        self.bus, self.wheels, self.events = LocalBus(), [], []
        self.bus.subscribe(
            topics.WHEEL_COMMAND.at("burger"), topics.WHEEL_COMMAND.qos, lambda s: self.wheels.append(taken(s, WheelCommand))
        )
        self.bus.subscribe("uvf/burger/state/events/*", topics.EVENTS.qos, lambda s: self.events.append(taken(s, Event)[1]))
        hosts = [host for host in catalogue.hosts(site, kinds) if host.vehicle in (None, "burger")]
        lockstep = Lockstep(hosts, self.bus, contains=True)
        (failing,) = (shell for shell in lockstep.shells if shell.type.name == name)
        for method in ("step", "stale"):
            monkeypatch.setattr(failing.type, method, fails(getattr(failing.type, method)))
        lockstep.run(UNTIL)
        lockstep.close()


def taken(sample, type_):
    return sample.stamp_ns / 1e9, type_.FromString(sample.payload)


def fails(sound):
    def step(self, t, given):
        if t > FAILS:
            raise ZeroDivisionError("as told")
        return sound(self, t, given)

    return step


@pytest.mark.parametrize("name", SERVICES)
def test_the_rover_stands(name, monkeypatch):
    run = Run(name, monkeypatch)
    assert any(c.left or c.right for t, c in run.wheels if FAILS - 1 < t < FAILS)
    assert all((c.left, c.right) == (0.0, 0.0) for t, c in run.wheels if t > UNTIL - 1)
    told = [e for e in run.events if "as told" in e.cause]
    assert [e.severity for e in told] == [Event.ERROR, Event.ERROR, Event.CRITICAL]
    assert (
        told[-1].text
        == f"{name} of burger has failed 3 times within 30 s and is given up: the vehicle stands where it would drive by itself"
    )
