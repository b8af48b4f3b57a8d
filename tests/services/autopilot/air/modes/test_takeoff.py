"""Take-off, phase by phase: the roll, the rotation, the climb, the throw, and what makes it be given up."""

import pytest

from services.autopilot.air.modes.takeoff import TakeoffMode
from services.autopilot.air.setpoints import FlightContext, PathSetpoint
from tests.services.autopilot.air.states import PARAMS, cruising
from uvf.control.commands import AttitudeSetpoint, Surfaces
from uvf.models.vehicle.flight_params import AirParams

THROWN = AirParams(launch_push=15.0)
STANDING = {"airspeed": 0.5, "ground_speed": 0.1, "height": 0.4, "pitch": 0.06}


def standing(room=float("inf"), params=PARAMS):
    phase = TakeoffMode(cruising(**STANDING), 40.0, FlightContext(airborne=False), room)
    phase.step(cruising(**STANDING), params, 0.02)
    return phase


def after(phase, seconds, params=PARAMS, **now):
    for _ in range(round(seconds * 50)):
        wish = phase.step(cruising(**{**STANDING, **now}), params, 0.02)
    return wish


def test_the_throttle_opens_within_a_second_and_the_elevator_takes_half_of_the_load_off_the_nose_wheel():
    phase = standing()
    half = after(phase, 0.5).asked
    assert half.throttle == pytest.approx(0.5, abs=0.03)
    full = after(phase, 1.0, ground_speed=5.0, airspeed=5.0).asked
    assert isinstance(full, Surfaces)
    assert (full.throttle, full.elevator) == (1.0, pytest.approx(0.5 * PARAMS.elev_per_alpha * STANDING["pitch"]))


def test_a_strong_motor_is_opened_only_as_far_as_is_told():
    limited = AirParams(takeoff_throttle=0.6)
    phase = standing(params=limited)
    assert after(phase, 2.0, limited, ground_speed=5.0, airspeed=5.0).asked.throttle == pytest.approx(0.6)
    assert after(phase, 0.5, limited, height=2.5, airspeed=21.0, ground_speed=21.0).asked.throttle == pytest.approx(0.6)


def test_low_over_the_strip_it_banks_a_little_back_to_its_line():
    phase = standing()
    after(phase, 2.0, height=2.5, airspeed=21.0, ground_speed=21.0)
    right, left = (after(phase, 0.02, height=3.0, airspeed=21.0, ground_speed=21.0, east=east).asked.bank for east in (5.0, -5.0))
    assert -0.16 < right < -0.05 and 0.05 < left < 0.16


def test_it_is_steered_back_to_its_line():
    phase = standing()
    assert after(phase, 0.1, east=1.0, ground_speed=5.0).asked.rudder > 0.02  # right of it: left rudder
    assert after(phase, 0.1, east=-1.0, ground_speed=5.0).asked.rudder < -0.02


def test_it_rotates_at_its_speed_and_not_before():
    phase = standing()
    after(phase, 1.0, ground_speed=8.0, airspeed=8.0)
    assert isinstance(after(phase, 0.02, ground_speed=16.0, airspeed=0.89 * PARAMS.min_airspeed).asked, Surfaces)
    raised = after(phase, 0.02, ground_speed=17.5, airspeed=0.91 * PARAMS.min_airspeed).asked
    assert isinstance(raised, AttitudeSetpoint)
    assert raised.pitch == pytest.approx(PARAMS.takeoff_pitch, abs=0.02)


def test_an_acceleration_that_the_estimate_takes_for_pitch_does_not_lower_the_nose():
    phase = standing()
    after(phase, 1.0, ground_speed=8.0, airspeed=8.0, pitch=0.4)
    raised = after(phase, 0.02, ground_speed=17.5, airspeed=18.0, pitch=0.4).asked
    assert raised.pitch - 0.4 == pytest.approx(PARAMS.takeoff_pitch - 0.06, abs=0.01)  # what is missing by the gyroscopes


def test_it_climbs_straight_ahead_with_full_throttle_and_is_done_at_its_height():
    phase = standing()
    after(phase, 2.0, height=2.5, airspeed=21.0, ground_speed=21.0, climb=2.0)
    climbing = after(phase, 0.02, height=20.0, airspeed=25.0, ground_speed=25.0, east=3.0).asked
    assert isinstance(climbing, PathSetpoint)
    assert (climbing.throttle, climbing.height, climbing.climb) == (1.0, None, PARAMS.climb_max)
    assert climbing.aim.error == pytest.approx(3.0)
    assert phase.ended == ""
    after(phase, 0.02, height=40.1, airspeed=25.0, ground_speed=25.0)
    assert (phase.ended, phase.disarms) == ("take-off complete", False)


@pytest.mark.parametrize(
    ("seconds", "now", "why"),
    [
        (4.1, {"ground_speed": 1.0}, "does not accelerate"),
        (1.0, {"ground_speed": 8.0, "airspeed": 8.0, "east": 9.0}, "left the line"),
        (1.0, {"ground_speed": 12.0, "airspeed": 12.0, "north": 130.0}, "too slow"),
    ],
)
def test_what_is_no_take_off_is_given_up_with_brakes_and_a_reason(seconds, now, why):
    phase = standing(room=250.0)
    after(phase, seconds, **now)
    braking = after(phase, 0.1, **now).asked
    assert (braking.throttle, braking.brake) == (0.0, 0.6)
    after(phase, 0.1, **{**now, "ground_speed": 0.2})
    assert why in phase.ended
    assert phase.disarms


def test_once_it_can_fly_it_is_not_given_up():
    phase = standing(room=250.0)
    after(phase, 1.0, ground_speed=20.0, airspeed=20.0, north=200.0)
    assert after(phase, 0.1, ground_speed=20.0, airspeed=20.0, north=200.0).asked.throttle == 1.0


def test_before_a_throw_the_motor_is_off_and_a_short_knock_does_not_start_it():
    context = FlightContext(airborne=False)
    phase = TakeoffMode(cruising(**STANDING), 40.0, context)
    assert after(phase, 2.0, THROWN).asked.throttle == 0.0
    context.specific_force_x = 30.0
    after(phase, 0.06, THROWN)
    context.specific_force_x = 0.0
    assert after(phase, 1.0, THROWN).asked.throttle == 0.0


def test_a_throw_starts_the_motor_with_level_wings_and_the_nose_up():
    context = FlightContext(airborne=False, specific_force_x=30.0)
    phase = TakeoffMode(cruising(**STANDING), 40.0, context)
    after(phase, 0.12, THROWN, airspeed=9.0)
    wish = after(phase, 0.1, THROWN, airspeed=12.0, ground_speed=12.0).asked
    assert isinstance(wish, AttitudeSetpoint)
    assert wish.throttle == 1.0
    assert 0.0 < wish.pitch <= THROWN.takeoff_pitch
    assert wish.bank == pytest.approx(0.0, abs=0.02)
