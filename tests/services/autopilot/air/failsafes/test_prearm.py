"""What is not in order on the ground is told, and keeps the aircraft from being armed."""

from dataclasses import replace

import pytest

from schemas.messages import ArmRequest, Battery, Fence, FenceRequest, FenceZone, Vector3
from services.autopilot.air.failsafes.prearm import CHECKS, PrearmInputs, faults
from tests.services.autopilot.air.sensing import resting
from tests.services.autopilot.air.states import PARAMS, cruising
from tests.stops import ENGAGED
from uvf.estimation.state import Ratios
from uvf.guidance import fence_plan

AT_REST = PrearmInputs(cruising(ground_speed=0.1, airspeed=2.0, height=0.0, pitch=0.1), PARAMS, accuracy=0.8, field=46e-6)
WRONG = {
    "estimator": [{"now": replace(AT_REST.now, position_sigma=30.0)}, {"now": replace(AT_REST.now, yaw_sigma=1.0)}],
    "GNSS": [{"gnss_age": 4.0}, {"accuracy": 12.0}],
    "battery": [{"charge": 0.1}],
    "air data": [{"has_air_data": False}, {"now": replace(AT_REST.now, airspeed=18.0)}],
    "compass": [{"field": 300e-6}, {"field": 1e-6}, {"now": replace(AT_REST.now, ratios=Ratios(field=2.0))}],
    "at rest": [{"now": replace(AT_REST.now, ground_speed=3.0)}, {"now": replace(AT_REST.now, roll=1.0)}],
    "fence": [{"fence_fault": "it stands outside"}],
    "mission": [{"mission_fault": "item 3 leaves it"}],
}
ARM, FORCE = [ArmRequest(arm=True)], [ArmRequest(arm=True, force=True)]


def test_nothing_is_wrong_with_an_aircraft_that_stands_ready():
    assert faults(AT_REST) == []
    assert faults(replace(AT_REST, field=0.0)) == [], "without a magnetometer there is nothing to compare"


@pytest.mark.parametrize("check", [name for name, _ in CHECKS])
def test_each_check_finds_its_fault_and_no_other(check):
    for wrong in WRONG[check]:
        (why,) = faults(replace(AT_REST, **wrong))
        assert why == dict(CHECKS)[check](replace(AT_REST, **wrong))


def test_all_reasons_are_told_at_once_and_shown_in_the_status():
    bench = resting()
    low = Battery(remaining=0.05, voltage=42.0)
    bench.run(speed=0.0, arm=[ArmRequest(arm=False)])
    bench.run(speed=0.0, battery=low, gnss=None, cycles=80)
    (reply,) = bench.run(speed=0.0, battery=low, gnss=None, arm=ARM)["arm"]
    assert not reply.accepted and "battery low: 5 %" in reply.reason and "no satellite fix" in reply.reason
    assert list(bench.status.prearm) == reply.reason.split("; ")
    (reply,) = bench.run(speed=0.0, arm=ARM)["arm"]
    assert "battery low" in reply.reason, "what a silent battery said last still counts"


def test_one_that_is_ready_is_armed_and_complains_of_nothing():
    bench = resting()
    bench.run(speed=0.0, arm=[ArmRequest(arm=False)])
    (reply,) = bench.run(speed=0.0, cycles=5, arm=ARM)["arm"]
    assert reply.accepted and not bench.status.prearm


def test_force_overrides_everything_but_a_stop():
    bench = resting()
    bench.run(speed=0.0, arm=[ArmRequest(arm=False)], battery=Battery(remaining=0.05))
    (reply,) = bench.run(speed=0.0, arm=FORCE)["arm"]
    assert reply.accepted
    stop = ENGAGED
    (reply,) = bench.run(speed=0.0, stop=stop, arm=FORCE)["arm"]
    assert not reply.accepted and "release the stop" in reply.reason


def test_in_the_air_nothing_of_it_counts():
    bench = resting()
    bench.run(cycles=50, battery=Battery(remaining=0.05))
    assert not bench.status.prearm


def test_outside_of_the_fence_it_is_not_armed():
    bench = resting([])
    bench.run(speed=0.0, arm=[ArmRequest(arm=False)])
    away = Fence(zones=[FenceZone(centre=Vector3(x=5000.0), radius=1000.0)])
    (reply,) = bench.run(speed=0.0, fence=[FenceRequest(fence=away, source="test")])["fence"]
    assert reply.accepted, reply.reason
    (reply,) = bench.run(speed=0.0, arm=ARM)["arm"]
    assert "fence: it stands outside" in reply.reason


def test_the_mission_is_looked_at_once_and_again_when_mission_or_fence_change(monkeypatch):
    looks = []
    monkeypatch.setattr(fence_plan, "mission_fault", lambda *of: looks.append(of) or "")
    bench = resting()
    bench.run(speed=0.0, cycles=100)
    assert len(looks) == 1
    around = Fence(zones=[FenceZone(radius=3000.0)])
    (reply,) = bench.run(speed=0.0, fence=[FenceRequest(fence=around)])["fence"]
    bench.run(speed=0.0, cycles=100)
    assert reply.accepted and len(looks) == 2
