"""Parameters over MAVLink in one flight with physics: what is set counts at once, and is seen in the motion."""

import msgspec
import numpy as np
import pytest

from services.autopilot.mavlink.parameters.parameter_table import parameters_of
from tests.services.autopilot.mavlink.parameters.test_parameters import INT
from tests.services.autopilot.mavlink.rig import long
from tests.services.autopilot.mavlink.station_in_flight import HOLD, LAND, RETURN, circling, in_the_air

pytestmark = pytest.mark.timeout(900)


@pytest.fixture(scope="module")
def station():
    return circling(in_the_air())


def test_each_that_can_be_written_is_the_flying_autopilots_at_once(station):
    """All of them, a little beside their values, and back; the aircraft flies on."""
    service = next(s.service for s in station.run.shells if s.service.name == "autopilot_air")
    before = service.params
    for p in parameters_of(station.facts):
        if p.fixed or p.cases:
            continue
        was = float(getattr(before, p.own))
        other = was + (1 if p.is_int else 0.01 * max(abs(was), 0.1)) * (1 if was < 0.9 * p.high else -1)
        station.set(p.name, int(other) if p.is_int else other, p.type)
        assert getattr(service.params, p.own) == pytest.approx(other, rel=1e-6), p.name
        station.set(p.name, round(was) if p.is_int else was, p.type)
    for p in parameters_of(station.facts):
        for number, case in p.cases.items() if not p.fixed and p.name != "LAW" else ():
            if case.sets:
                station.set(p.name, number, INT)
                assert all(getattr(service.params, name) == word for name, word in case.sets.items()), p.name
    station.say(long(245, 2.0))
    station.until(3.0, lambda: msgspec.to_builtins(service.params) == msgspec.to_builtins(before))
    assert station.mode in (HOLD, RETURN, LAND)


def test_airspeed_and_radius_of_a_circle_that_is_flown_follow(station):
    station.take(HOLD)
    station.set("FW_AIRSPD_TRIM", 28.0)
    station.set("NAV_LOITER_RAD", 130.0)
    station.fly(22.0)
    assert station.radii(5.0) == pytest.approx(130.0, rel=0.1)
    assert np.mean([m.airspeed for t, m in station.truth if t > station.t - 5.0]) == pytest.approx(28.0, abs=0.7)
    station.set("FW_AIRSPD_TRIM", 25.0)
    station.set("NAV_LOITER_RAD", 90.0)


def test_return_climbs_comes_down_and_lands_as_they_say(station):
    station.take(RETURN)
    station.set("RTL_RETURN_ALT", 105.0)
    station.until(25.0, lambda: station.now[0][2] > 102.0)
    station.set("RTL_DESCEND_ALT", 85.0)
    station.until(40.0, lambda: station.now[0][2] < 88.0)
    station.fly(2.0)
    assert station.mode == RETURN and station.now[0][2] > 80.0
    station.set("RTL_LAND_DELAY", 0.0)
    station.until(5.0, lambda: station.mode == LAND)
    station.set("RTL_DESCEND_ALT", 0.0)
    station.set("RTL_LAND_DELAY", -1.0)
