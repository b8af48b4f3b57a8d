"""QGroundControl's buttons from the strip of a field 300 m high, each seen in the motion of the aircraft: one flight, many claims."""

import math

import numpy as np
import pytest

from services.autopilot.mavlink.build import facts_of
from tests.services.autopilot.mavlink.airborne import Airborne, field
from tests.services.autopilot.mavlink.rig import long
from uvf.mavlink import dialect as mav
from uvf.models.vehicle.flight_params import AirParams

SEA = 300.0  # m: of the field
ORIGIN = facts_of(field())[0].origin
HELD = 6.0  # s, looked at
NAN = math.nan
TAKEOFF, HOLD, RETURN, LAND, ORBIT = 0x02040000, 0x03040000, 0x05040000, 0x06040000, 0x01030000
ACCEPTED, REJECTED = 0, 1

pytestmark = pytest.mark.timeout(400)


def place(number, x, y, z, *p):
    """COMMAND_INT at a place of the world [m], altitude above the sea."""
    latitude, longitude, _ = ORIGIN.geodetic((x, y, 0.0))
    e7 = [round(math.degrees(v) * 1e7) for v in (latitude, longitude)]
    return mav.MAVLink_command_int_message(1, 1, 0, number, 0, 0, *p, *[NAN] * (4 - len(p)), *e7, z + SEA)


class Held:
    """What the aircraft did while it was looked at: (n, 3) positions and velocities, airspeeds."""

    def __init__(self, flight, begin, end):
        seen = [m for t, m in flight.truth if begin < t <= end]
        self.positions = np.array([(m.position.x, m.position.y, m.position.z) for m in seen])
        self.velocities = np.array([(m.velocity.x, m.velocity.y, m.velocity.z) for m in seen])
        self.airspeeds = np.array([m.airspeed for m in seen])

    def radii(self, x, y):
        return np.hypot(self.positions[:, 0] - x, self.positions[:, 1] - y)

    def clockwise(self, x, y):
        """m/s round the place, seen from above; positive clockwise."""
        away = self.positions[:, :2] - (x, y)
        return (away[:, 1] * self.velocities[:, 0] - away[:, 0] * self.velocities[:, 1]) / np.hypot(*away.T)


class Story:
    """The flight; ``held`` by the name of the button."""

    def __init__(self):
        self.flight = flight = Airborne()
        self.results, self.held, self.delays = {}, {}, []
        assert flight.fly(30.0, lambda: self.newest("SYS_STATUS") is not None and self._ready()), flight.texts()
        self._take_off()
        self._guided()
        self._stop()

    def newest(self, kind):
        return next((m for _, m in reversed(self.flight.heard) if m.get_type() == kind), None)

    def mode(self):
        return self.newest("HEARTBEAT").custom_mode

    def _ready(self):
        return bool(self.newest("SYS_STATUS").onboard_control_sensors_health & mav.MAV_SYS_STATUS_PREARM_CHECK)

    def press(self, name, command, seconds):
        """Presses a button, waits until it has had its effect, and looks for a while."""
        self.results[name], delay = self.flight.ask(command)
        self.delays.append(delay)
        if seconds:
            self.flight.fly(seconds)
            self.held[name] = Held(self.flight, self.flight.t - HELD, self.flight.t)

    def _take_off(self):
        flight = self.flight
        flight.say(mav.MAVLink_set_mode_message(1, 157, TAKEOFF))
        self.waiting = flight.hears("HEARTBEAT", 1.3, lambda m: m.custom_mode == TAKEOFF)[1]
        flight.fly(2.0)
        self.stood = abs(flight.now[1][0]) < 0.2
        self.press("arm", long(400, 1.0), 0.0)
        self.armed = flight.hears("HEARTBEAT", 1.5, lambda m: bool(m.base_mode & 128))[1]
        assert flight.fly(60.0, lambda: self.mode() == HOLD), flight.texts()
        self.height_of_hold = flight.now[0][2]
        flight.fly(12.0)
        self.centres = [self._centre()]
        self.held["takeoff"] = Held(flight, flight.t - HELD, flight.t)

    def _guided(self):
        self.press("altitude", long(192, -1.0, 1.0, 0.0, NAN, NAN, NAN, SEA + 90.0), 22.0)
        self.centres.append(self._centre())
        self.press("go to", place(192, 300.0, 250.0, 90.0, -1.0, 1.0, 0.0), 32.0)
        self.press("speed", long(178, 0.0, 29.0, -1.0, 0.0), 13.0)
        self.press("ground speed", long(178, 1.0, 26.0, -1.0, 0.0), 13.0)
        self.press("orbit", place(34, -100.0, 250.0, 110.0, -130.0), 36.0)
        self.orbit = self.newest("ORBIT_EXECUTION_STATUS")
        self.modes = [self.mode()]
        self.pressed_at = self.flight.now[0]
        self.press("pause", long(192, -1.0, 1.0, 0.0), 18.0)
        self.modes.append(self.mode())
        self.press("disarm", long(400, 0.0), 0.0)
        self.press("return", long(20), 34.0)
        self.modes.append(self.mode())

    def _centre(self):
        """deg e7, of the circle that is steered at."""
        target = self.newest("POSITION_TARGET_GLOBAL_INT")
        return target.lat_int, target.lon_int

    def _stop(self):
        self.press("go around", long(191, 50.0), 0.0)
        self.press("stop", long(400, 0.0, 21196.0), 0.0)
        self.flight.fly(1.0)


@pytest.fixture(scope="module")
def story():
    return Story()


def test_take_off_is_accepted_disarmed_and_begins_with_arming(story):
    assert not story.waiting.base_mode & 128 and story.stood
    assert story.results["arm"] == ACCEPTED


def test_it_climbs_to_its_height_above_home_and_holds(story):
    assert story.height_of_hold == pytest.approx(AirParams().takeoff_alt, abs=5.0)
    assert np.abs(story.held["takeoff"].positions[:, 2] - AirParams().takeoff_alt).max() < 5.0


def test_ground_stations_see_it_stand_take_off_and_fly(story):
    told = [m.landed_state for _, m in story.flight.heard if m.get_type() == "EXTENDED_SYS_STATE"]
    changes = [b for a, b in zip([0, *told], told, strict=False) if a != b]
    assert changes[:3] == [1, 3, 2]


def test_every_button_is_answered_within_100_ms(story):
    assert max(story.delays) <= 0.1
    assert {name for name, result in story.results.items() if result != ACCEPTED} == {"disarm", "go around"}


def test_change_of_altitude_keeps_the_circle_at_the_height_above_the_sea(story):
    assert np.abs(story.held["altitude"].positions[:, 2] - 90.0).max() < 3.0
    assert story.centres[0] == story.centres[1]


def test_go_to_circles_the_place_at_the_height_of_now(story):
    held = story.held["go to"]
    assert held.radii(300.0, 250.0) == pytest.approx(AirParams().hold_radius, rel=0.1)
    assert np.abs(held.positions[:, 2] - 90.0).max() < 3.0
    assert held.clockwise(300.0, 250.0).min() > 0


def test_airspeed_and_ground_speed_are_flown(story):
    assert np.abs(story.held["speed"].airspeeds.mean() - 29.0) < 0.5
    over_ground = np.hypot(*story.held["ground speed"].velocities[:, :2].T)
    assert abs(over_ground.mean() - 26.0) < 1.0 and np.abs(over_ground - 26.0).max() < 3.0


def test_an_orbit_has_the_radius_the_height_and_the_direction_asked_for(story):
    held = story.held["orbit"]
    assert held.radii(-100.0, 250.0) == pytest.approx(130.0, rel=0.1)
    assert held.clockwise(-100.0, 250.0).max() < 0
    assert np.abs(held.positions[:, 2] - 110.0).max() < 3.0
    assert (story.orbit.radius, story.orbit.z) == (-130.0, pytest.approx(SEA + 110.0))
    assert np.abs(held.airspeeds.mean() - AirParams().trim_airspeed) < 0.5  # another mode: cruise again


def test_pause_holds_near_where_it_was_pressed(story):
    held, pressed = story.held["pause"], story.pressed_at
    assert held.radii(*pressed[:2]).max() < 2.2 * AirParams().hold_radius
    assert np.abs(held.positions[:, 2] - pressed[2]).max() < 5.0
    assert story.modes == [ORBIT, HOLD, RETURN]


def test_return_leads_home_at_a_safe_height(story):
    home = story.newest("HOME_POSITION")
    held = story.held["return"]
    assert home.altitude == pytest.approx(SEA * 1e3, abs=500)
    assert held.radii(-140.0, 0.0).mean() == pytest.approx(AirParams().hold_radius, rel=0.1)
    assert held.positions[:, 2].min() > AirParams().return_altitude - 3.0


def test_in_the_air_disarming_needs_force(story):
    assert story.results["disarm"] == REJECTED
    assert any(text.startswith("Disarming denied: the aircraft is flying") for text in story.flight.texts())
    assert story.results["stop"] == ACCEPTED
    assert not story.newest("HEARTBEAT").base_mode & 128


def test_altitudes_agree_above_the_sea_and_above_home(story):
    last = {kind: story.newest(kind) for kind in ("GLOBAL_POSITION_INT", "ALTITUDE", "VFR_HUD", "GPS_RAW_INT")}
    height = story.flight.now[0][2]
    assert last["GLOBAL_POSITION_INT"].alt * 1e-3 == pytest.approx(SEA + height, abs=5.0)
    assert last["GLOBAL_POSITION_INT"].relative_alt * 1e-3 == pytest.approx(last["GLOBAL_POSITION_INT"].alt * 1e-3 - SEA, abs=0.5)
    assert last["ALTITUDE"].altitude_amsl == pytest.approx(last["VFR_HUD"].alt, abs=1.5)
    assert last["ALTITUDE"].altitude_relative == pytest.approx(last["ALTITUDE"].altitude_amsl - SEA, abs=0.5)


def test_nothing_pops_up_over_the_map(story):
    assert [m.text for _, m in story.flight.heard if m.get_type() == "STATUSTEXT" and m.severity <= mav.MAV_SEVERITY_ERROR] == []
