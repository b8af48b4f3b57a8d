"""Each failsafe by its real cause, in flights with the simulator: what is said, what is done, and how it recovers."""

import numpy as np
import pytest

from schemas import topics
from schemas.messages import Fence, FenceRequest, FenceZone, GoalRequest, Mission, MissionItem, MissionRequest, Mode, ModeRequest, Vector3
from tests.services.autopilot.air.trouble import Trouble
from tests.services.autopilot.proofs import shows
from uvf.maths.rotations import to_euler
from uvf.models.mission.fence import FenceFile, ZoneFile
from uvf.runtime.messages.convert import wxyz

NEUTRAL = {"throttle": 0.78}
BOX = [(-500.0, -500.0), (500.0, -500.0), (500.0, 500.0), (-500.0, 500.0)]
MISSION = ModeRequest(mode=Mode.MODE_MISSION, source="test")


@shows("air", "link")
def test_without_its_ground_station_it_returns_and_goes_on_when_asked():
    flight = Trouble()
    flight.linked = True
    flight.run(10.0)
    flight.linked = False
    flight.run(18.0)
    assert flight.told("ground station lost") == pytest.approx([14.5], abs=1.0)
    assert (flight.mode_at(18.0).mode, flight.mode_at(18.0).reason) == (Mode.MODE_RETURN, "ground station lost")
    assert list(flight.mode_at(18.0).failsafes) == ["ground station lost"]
    flight.linked = True
    flight.run(20.0)
    assert len(flight.told("ground station back")) == 1
    assert flight.mode_at(20.0).mode == Mode.MODE_RETURN, "nobody has asked for another mode"
    flight.ask(topics.SET_MODE, MISSION, 20.0)
    flight.run(21.0)
    assert flight.mode_at(21.0).mode == Mode.MODE_MISSION and not flight.mode_at(21.0).failsafes
    return flight


def test_who_asks_for_the_mission_after_a_failsafe_gets_it():
    flight = Trouble()
    flight.linked = True
    flight.run(3.0)
    flight.linked = False
    flight.run(10.0)
    flight.ask(topics.SET_MODE, MISSION, 10.0)
    flight.run(20.0)
    assert flight.mode_at(20.0).mode == Mode.MODE_MISSION
    assert len(flight.told("ground station lost")) == 1


@pytest.mark.parametrize(("kind", "size"), [("lost", 0.0), ("frozen", 0.0), ("bias", -220.0)])
@shows("air", "airspeed")
def test_a_pitot_tube_that_fails_is_noticed_flown_without_and_believed_again(kind, size):
    flight = Trouble(faults=[("pitot", kind, 20.0, 40.0, size)], wind=(4.0, 3.0, 0.0))
    flight.run(50.0)
    assert flight.told("airspeed sensor failed") == pytest.approx([21.0], abs=1.1)
    assert flight.told("airspeed sensor back") == pytest.approx([45.0], abs=2.5)
    assert max(abs(m.airspeed - 25.0) for t, m in flight.truth if t > 19.0) < 3.0
    assert flight.mode_at(50.0).mode == Mode.MODE_MISSION
    return flight


@shows("air", "gnss")
def test_a_receiver_that_freezes_is_lost_and_one_that_moves_again_is_back():
    flight = Trouble(faults=[("gnss", "frozen", 10.0, 20.0, 0.0)])
    flight.run(24.0)
    assert flight.told("GNSS lost") == pytest.approx([12.8], abs=1.0)
    assert flight.told("GNSS back") == pytest.approx([20.2], abs=0.5)
    return flight


@shows("air", "air_data")
def test_a_static_port_that_freezes_is_no_height():
    flight = Trouble(faults=[("static", "frozen", 10.0, 20.0, 0.0)])
    flight.run(24.0)
    assert flight.told("air data lost") == pytest.approx([11.0], abs=0.5)
    assert flight.told("air data back") == pytest.approx([20.1], abs=0.5)
    assert np.abs(flight.positions(after=10.0)[:, 2] - 60.0).max() < 8.0
    return flight


@shows("air", "battery_low", "battery_critical", "battery_emergency")
def test_on_a_battery_that_runs_out_it_turns_home_while_that_is_left_and_lands():
    """Until the pack's gauge finds that there is more in it than it told."""
    flight = Trouble(energy=18e3, faults=[("battery", "bias", 48.0, None, 0.5)], params={"emergency_charge": 0.069})
    flight.run(53.0)
    (low,) = flight.told("battery low")
    assert low < flight.told("battery critical")[0]
    home = next(m.battery_remaining for t, m in flight.status if t >= low)
    assert home > 0.2, "the way home counts, not only what is left"
    assert flight.mode_at(low + 0.5).mode == Mode.MODE_RETURN
    assert flight.mode_at(flight.told("battery critical")[0] + 0.5).mode == Mode.MODE_LAND
    return flight


@shows("air", "wind")
def test_in_a_storm_that_leaves_no_way_back_it_does_not_stay_out_until_it_is_over():
    flight = Trouble(storm=(24.0, 1500.0))
    flight.run(78.0)
    (began,) = flight.told("wind too strong")
    assert flight.mode_at(began + 1.0).mode == Mode.MODE_RETURN
    assert len(flight.told("wind has slackened")) == 1
    assert not flight.told("airspeed sensor failed"), "wind that rises by 1 m/s in a second is no fault of the pitot"
    assert max(abs(m.airspeed - 25.0) for _, m in flight.truth) < 4.0
    return flight


def test_an_elevator_that_sits_ten_degrees_off_is_found_out_before_it_is_at_its_stop():
    """Half of its way: turns are banked for by what is left of it."""
    flight = Trouble(faults=[("elevator", "bias", 5.0, 40.0, 0.17)], wind=(17.0, 0.0, 0.0))
    flight.run(50.0)
    assert not flight.told("surface at its stop")
    assert np.abs(flight.positions()[:, 2] - 60.0).max() < 10.0 and not flight.crashed


@shows("air", "saturation")
def test_an_elevator_at_its_stop_is_asked_for_less_in_strong_wind_too():
    """Asked for more, the aircraft sinks through its turns, and is on the ground within ten seconds."""
    flight = Trouble(faults=[("elevator", "bias", 5.0, 40.0, 0.205)], wind=(18.0, 0.0, 0.0))
    flight.run(50.0)
    began, ended = flight.told("surface at its stop"), flight.told("surfaces free again")
    assert began and began[0] < 40.0
    assert ended and ended[-1] > began[-1]
    assert flight.positions()[:, 2].min() > 35.0 and not flight.crashed
    assert np.abs(flight.positions()[:, :2]).max() < 300.0, "half the bank takes it back all the same"
    return flight


def fenced(action, wind=(10.0, 0.0, 0.0)):
    """Flown by stick straight at the fence, downwind."""
    fence = FenceFile([ZoneFile(polygon=BOX)], floor=20.0, ceiling=120.0, action=action)
    flight = Trouble(fence=fence, wind=wind)
    flight.hand = NEUTRAL
    flight.run(3.0)
    flight.ask(topics.SET_MODE, ModeRequest(mode=Mode.MODE_ALTITUDE, source="test"), 3.0)
    return flight


@pytest.mark.parametrize(("action", "mode"), [("hold", Mode.MODE_HOLD), ("return", Mode.MODE_RETURN)])
@shows("air", "fence")
def test_a_fence_is_never_left(action, mode):
    flight = fenced(action)
    flight.run(45.0)
    positions = flight.positions()
    assert np.abs(positions[:, :2]).max() < 500.0
    assert np.abs(positions[:, 0]).max() > 440.0, "it is not turned away far too early"
    assert len(flight.told("fence ahead")) == 1 and flight.told("clear of the fence")
    assert flight.mode_at(45.0).mode == mode
    assert not flight.told("outside")
    return flight


@shows("air", "breach", "sticks")
def test_a_fence_that_warns_tells_of_the_breach_and_nobody_at_the_stick_is_told_too():
    flight = fenced("warn")
    flight.run(20.0)
    assert flight.told("fence ahead") and flight.told("outside of the fence")
    assert flight.mode_at(20.0).mode == Mode.MODE_ALTITUDE
    flight.hand = None
    flight.run(21.0)
    assert (flight.mode_at(21.0).mode, flight.mode_at(21.0).reason) == (Mode.MODE_HOLD, "manual control lost")
    flight.ask(topics.SET_MODE, ModeRequest(mode=Mode.MODE_RETURN, source="test"), 21.0)
    flight.run(46.0)
    assert flight.told("inside of the fence")
    return flight


def test_goals_and_missions_outside_are_refused_and_a_new_fence_is_told():
    flight = Trouble()
    flight.run(1.0)
    zone = FenceZone(vertices=[Vector3(x=x, y=y) for x, y in BOX])
    fences = flight._record(topics.FENCE)
    flight.ask(topics.SET_FENCE, FenceRequest(fence=Fence(zones=[zone], ceiling=120.0), source="test"), 1.0)
    flight.run(1.2)
    flight.ask(topics.GOAL, GoalRequest(position=Vector3(x=460.0, y=0.0, z=60.0)), 1.2)
    mission = Mission(items=[MissionItem(position=Vector3(x=0.0, z=60.0)), MissionItem(position=Vector3(x=0.0, z=160.0))])
    flight.ask(topics.SET_MISSION, MissionRequest(mission=mission), 1.2)
    small = Fence(zones=[FenceZone(centre=Vector3(x=-200.0, y=-150.0), radius=150.0)])
    flight.ask(topics.SET_FENCE, FenceRequest(fence=small), 1.2)
    flight.run(1.5)
    accepted, goal, items, fence = flight.replies
    assert accepted.accepted and fences[-1][1].ceiling == 120.0
    assert "(460, 0) is 40 m from the fence" in goal.reason
    assert "item 1: its height of 160 m" in items.reason
    assert "the mission does not lie within it: item 0" in fence.reason


@shows("air", "attitude")
def test_an_attitude_that_nobody_wants_ends_the_flight_by_hand():
    flight = Trouble()
    flight.hand = {**NEUTRAL, "elevator": -0.13, "aileron": 0.15}
    flight.run(2.0)
    flight.ask(topics.SET_MODE, ModeRequest(mode=Mode.MODE_MANUAL, source="test"), 2.0)
    flight.run(25.0)
    assert flight.told("attitude beyond limits") and flight.told("attitude within limits")
    assert flight.mode_at(25.0).mode == Mode.MODE_HOLD
    assert abs(to_euler(wxyz(flight.truth[-1][1].orientation))[0]) < 1.0
    return flight
