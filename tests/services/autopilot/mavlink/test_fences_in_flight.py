"""Fences and rally points over MAVLink in flight: breached, told, acted on, entered again; Return goes to the nearest place."""

import math

import numpy as np
import pytest

from tests.services.autopilot.mavlink.parameters.test_parameters import INT
from tests.services.autopilot.mavlink.station_in_flight import ACCEPTED, HOLD, RETURN, circling, in_the_air
from uvf.mavlink import dialect as mav

GEOFENCE = mav.MAV_SYS_STATUS_GEOFENCE

pytestmark = pytest.mark.timeout(900)


@pytest.fixture
def station():
    return circling(in_the_air())


def breached(station, kind, seconds=2.0):
    """Told by every message at once."""
    station.until(seconds, lambda: station.newest("FENCE_STATUS") is not None and station.newest("FENCE_STATUS").breach_status == 1)
    assert station.newest("FENCE_STATUS").breach_type == kind
    assert not station.newest("SYS_STATUS").onboard_control_sensors_health & GEOFENCE
    assert station.told("outside of the fence", station.t - seconds - 0.5)


def cleared(station, seconds):
    begun = station.t
    station.until(seconds, lambda: station.newest("FENCE_STATUS").breach_status == 0)
    assert station.newest("SYS_STATUS").onboard_control_sensors_health & GEOFENCE
    station.until(2.0, lambda: station.told("inside of the fence", begun))


def test_a_fence_about_home_is_breached_acted_on_and_entered_again(station):
    station.take(HOLD)
    station.set("GF_ACTION", 3, INT)
    station.set("GF_MAX_VER_DIST", round(station.now[0][2] - 20.0))
    breached(station, mav.FENCE_BREACH_MAXALT)
    cleared(station, 20.0)
    station.set("GF_MAX_VER_DIST", 0.0)
    station.set("RTL_RETURN_ALT", 60.0)
    station.fly(8.0)  # the same text is said again after 10 s
    home = np.array(station.now[0][:2]) - 300.0 * np.array((0.0, 1.0))
    at = station.item(0, 0, place=(*home, 0.0))
    station.say(mav.MAVLink_command_int_message(1, 1, 0, 179, 0, 0, 0.0, 0.0, 0.0, math.nan, at.x, at.y, 300.0))
    station.fly(0.5)
    station.set("GF_MAX_HOR_DIST", 200.0)
    breached(station, mav.FENCE_BREACH_BOUNDARY)
    station.fly(1.0)
    assert station.mode == RETURN
    cleared(station, 30.0)
    station.set("GF_MAX_HOR_DIST", 0.0)


def test_zones_that_are_uploaded_are_told_of_or_kept_as_the_action_says(station):
    """A zone to keep out of lies on the circle that is flown: passed with a warning, then no more."""
    station.take(HOLD)
    station.set("GF_ACTION", 1, INT)
    station.fly(8.0)
    x, y, _ = station.now[0]
    centre = station.centre()
    far = 2.0 * centre - (x, y)
    corner = lambda seq, dx, dy: station.item(seq, 5001, (4.0, 0.0, 0.0, 0.0), (x + dx, y + dy, 0.0), 1)  # noqa: E731
    square = [corner(i, dx, dy) for i, (dx, dy) in enumerate([(-900.0, -900.0), (900.0, -900.0), (900.0, 900.0), (-900.0, 900.0)])]
    assert station.upload([*square, station.item(4, 5004, (35.0, 0.0, 0.0, 0.0), (*far, 0.0), 1)], 1) == ACCEPTED
    breached(station, mav.FENCE_BREACH_BOUNDARY, 20.0)
    assert station.mode == HOLD
    cleared(station, 10.0)
    count = station.newest("FENCE_STATUS").breach_count
    station.set("GF_ACTION", 2, INT)
    station.fly(30.0)
    assert station.newest("FENCE_STATUS").breach_count == count and station.mode == HOLD
    assert min(math.hypot(m.position.x - far[0], m.position.y - far[1]) for t, m in station.truth if t > station.t - 20.0) > 35.0


def test_return_leads_to_the_nearest_rally_point(station):
    x, y, _ = station.now[0]
    near, away = (x + 40.0, y + 30.0, 70.0), (x - 700.0, y, 70.0)  # home is further than the first
    assert station.upload([], 1) == ACCEPTED
    assert station.upload([station.item(i, 5100, place=place, kind=2) for i, place in enumerate((away, near))], 2) == ACCEPTED
    station.take(RETURN)
    station.fly(1.0)
    assert station.centre() == pytest.approx(near[:2], abs=2.0)
    station.until(30.0, lambda: abs(station.radii(0.1).mean() - 90.0) < 15.0)
