"""Over MAVLink in one flight: sticks, link and battery that fail with what follows, and a mission with jumps that goes on after."""

import numpy as np
import pytest

from tests.services.autopilot.mavlink.parameters.test_parameters import INT
from tests.services.autopilot.mavlink.rig import long
from tests.services.autopilot.mavlink.station_in_flight import ACCEPTED, ALTITUDE, HOLD, LAND, MISSION, RETURN, circling, in_the_air
from uvf.models.mission.faults import Fault

LEFT = -0.5  # of the charge: what the gauge tells too little

pytestmark = pytest.mark.timeout(900)


@pytest.fixture(scope="module")
def station():
    return circling(in_the_air(Fault("milvus", "battery", "bias", 0.0, None, LEFT)))


def test_sticks_that_end_are_missed_after_their_time_with_their_action(station):
    station.sticks = True
    station.take(ALTITUDE)
    station.set("COM_RC_LOSS_T", 2.0)
    station.set("NAV_RCL_ACT", 2, INT)
    station.fly(1.0)
    station.sticks, begun = False, station.t
    station.fly(1.6)
    assert station.mode == ALTITUDE and not station.told("nobody flies by hand", begun)
    station.until(1.5, lambda: station.mode == RETURN)
    assert station.told("manual control lost", begun)


def test_a_mission_jumps_as_often_as_it_says_and_goes_on_where_a_lost_link_has_stopped_it(station):
    """DO_CHANGE_SPEED, DO_JUMP, the link lost and back, Hold and on at the same item."""
    station.set("COM_DL_LOSS_T", 3, INT)
    station.set("NAV_DLL_ACT", 1, INT)
    wp = lambda seq, x, y: station.item(seq, 16, place=(x, y, 85.0))  # noqa: E731
    plan = [wp(0, 100.0, 0.0), station.item(1, 178, (0.0, 29.0, -1.0, 0.0)), wp(2, 250.0, 100.0), wp(3, 100.0, 230.0), wp(4, 0.0, 80.0)]
    plan += [station.item(5, 177, (2.0, 2.0, 0.0, 0.0)), wp(6, 0.0, -200.0)]
    assert station.upload(plan) == ACCEPTED
    begun = station.t
    station.take(MISSION)
    reached = lambda: [m.seq for t, m in station.heard if m.get_type() == "MISSION_ITEM_REACHED" and t > begun]  # noqa: E731
    station.until(60.0, lambda: 2 in reached())
    station.linked = False
    station.until(6.0, lambda: station.mode == HOLD)
    current = station.newest("MISSION_CURRENT").seq
    station.linked = True
    station.until(3.0, lambda: station.told("ground station back", begun))
    station.fly(1.0)
    assert station.mode == HOLD and station.told("ground station lost", begun)
    assert station.ask(long(193, 1.0))[0] == ACCEPTED
    station.fly(1.5)
    assert station.mode == MISSION and station.newest("MISSION_CURRENT").seq == current
    fast = len(station.truth)
    station.until(150.0, lambda: 6 in reached())
    assert [seq for seq in reached() if seq not in (1, 5)] == [0, *[2, 3, 4] * 3, 6]
    assert np.median([m.airspeed for _, m in station.truth[fast:]]) == pytest.approx(29.0, abs=1.0)


def test_a_battery_is_low_critical_and_all_but_empty_at_its_thresholds(station):
    station.take(HOLD)
    station.set("COM_LOW_BAT_ACT", 3, INT)
    states, modes, begun = [], [], station.t
    for name, words in (
        ("BAT_LOW_THR", "battery low"),
        ("BAT_CRIT_THR", "battery critical"),
        ("BAT_EMERGEN_THR", "battery emergency"),
    ):
        station.set(name, 0.8)
        station.until(5.0, lambda words=words: station.told(words, begun))
        station.fly(1.2)
        states.append(station.newest("BATTERY_STATUS").charge_state)
        modes.append(station.mode)
    assert states == [2, 3, 4]  # LOW, CRITICAL, EMERGENCY
    assert modes == [HOLD, RETURN, LAND]
    for name, number in (("BAT_EMERGEN_THR", 0.05), ("BAT_CRIT_THR", 0.07), ("BAT_LOW_THR", 0.15)):
        station.set(name, number)
    station.until(6.0, lambda: station.told("battery no longer low", begun))
    station.fly(1.2)
    assert station.newest("BATTERY_STATUS").charge_state == 1
