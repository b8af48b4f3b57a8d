"""GNSS that is gone for long: the aircraft comes down where it is, into the wind; back in time it holds, or does what was ordered."""

import math

import numpy as np
import pytest

from schemas.messages import Mode
from services.autopilot.air.modes.descent import upwind
from tests.services.autopilot.air.states import cruising
from tests.services.autopilot.air.trouble import Trouble
from tests.services.autopilot.proofs import shows
from uvf.maths.rotations import to_euler
from uvf.runtime.messages.convert import wxyz

LOST = ("gnss", "lost", 10.0, None, 0.0)
SOON = {"gnss_time": 20.0}


def touched(flight):
    """The true motion when the wheels come to the ground."""
    return next(m for t, m in flight.truth if m.position.z < 0.45)


@pytest.mark.parametrize("altimeter", [True, False])
def test_it_comes_down_into_the_wind_softly_stands_and_is_disarmed(altimeter):
    flight = Trouble(faults=[LOST], wind=(6.0, -4.0, 0.0), params=SOON, altimeter=altimeter)
    flight.run(105.0)
    (began,) = flight.told("without a position for long")
    assert began == pytest.approx(35.0, abs=0.5)
    assert flight.mode_at(began + 1.0).mode == Mode.MODE_LAND
    down, (roll, _, yaw) = touched(flight), to_euler(wxyz(touched(flight).orientation))
    assert -1.2 < down.velocity.z < 0.0 and abs(roll) < 0.1
    assert math.remainder(yaw - math.atan2(4.0, -6.0), math.tau) == pytest.approx(0.0, abs=0.2)
    last = flight.status[-1][1]
    assert last.landed and not last.armed
    assert np.ptp(flight.positions(after=103.0)[:, :2], axis=0).max() < 0.1
    assert flight.told("disarmed") and not flight.crashed


@shows("air", "position", "estimator")
def test_gnss_back_on_the_way_down_is_a_hold_at_a_safe_height():
    flight = Trouble(faults=[(*LOST[:3], 46.0, 0.0)], params={**SOON, "sigma_max": 1.5})
    flight.run(60.0)
    assert flight.positions(after=45.0)[0, 2] < 45.0, "it was on its way down"
    assert (flight.mode_at(60.0).mode, flight.mode_at(60.0).reason) == (Mode.MODE_HOLD, "GNSS back: holds until a mode is asked for")
    assert 28.0 < flight.positions()[-1, 2] < 45.0
    return flight


def test_a_return_that_was_ordered_meanwhile_is_flown_once_gnss_is_back():
    flight = Trouble(faults=[(*LOST[:3], 30.0, 0.0)])
    flight.linked = True
    flight.run(15.0)
    flight.linked = False
    flight.run(29.0)
    assert flight.told("ground station lost") and flight.mode_at(29.0).mode == Mode.MODE_HOLD
    flight.run(32.0)
    assert (flight.mode_at(32.0).mode, flight.mode_at(32.0).reason) == (Mode.MODE_RETURN, "ground station lost")


def test_without_gnss_a_critical_battery_brings_it_down_at_once():
    empty = ("battery", "bias", 14.0, None, -0.95)
    flight = Trouble(faults=[LOST, empty])
    flight.run(25.0)
    assert flight.mode_at(25.0).mode == Mode.MODE_LAND
    assert flight.positions()[-1, 2] < 55.0


def test_who_flies_by_hand_is_not_taken_down():
    flight = Trouble(faults=[LOST], params={"gnss_time": 10.0})
    flight.hand = {"throttle": 0.78}
    flight.run(3.0)
    flight.take("altitude")
    flight.run(40.0)
    assert not flight.told("without a position for long") and flight.mode_at(40.0).mode == Mode.MODE_ALTITUDE


def test_upwind_is_where_the_wind_comes_from_and_any_way_in_calm_air():
    assert abs(upwind(cruising(wind_north=5.0))) == pytest.approx(math.pi)
    assert upwind(cruising(yaw=0.7, wind_north=0.5)) == 0.7
