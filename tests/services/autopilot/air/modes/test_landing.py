"""Landing: where, along which path, and what makes it be given up."""

import math
from dataclasses import replace
from itertools import pairwise

import msgspec
import numpy as np
import pytest

from services.autopilot.air.modes.landing import EARLY, GUSTY, LIFT_A, LIFT_P, TOUCH_SINK, LandingMode, flare, late
from services.autopilot.air.setpoints import FlightContext
from tests.services.autopilot.air.states import PARAMS, cruising
from uvf.control.commands import AttitudeSetpoint, Surfaces
from uvf.guidance.route import Place
from uvf.guidance.runways import LandingStrip, lane_for
from uvf.maths.atmosphere import STRIP_ROUGHNESS, logarithmic
from uvf.maths.geodesy import GRAVITY

STRIP = LandingStrip(Place(0.0, 0.0, 5.0), math.pi / 2, 300.0, 12.0)  # east and west
SLOPE = math.tan(PARAMS.glide_slope)
EAST = STRIP.lane(math.pi / 2)


@pytest.mark.parametrize(("wind_east", "course"), [(-8.0, math.pi / 2), (8.0, -math.pi / 2)])
def test_it_lands_against_the_wind(wind_east, course):
    lane = lane_for(Place(0.0, 0.0, 0.0), [STRIP], cruising(wind_east=wind_east, wind_north=2.0))
    assert math.cos(lane.course - course) == pytest.approx(1.0)


def test_in_calm_air_it_lands_straight_in():
    assert lane_for(Place(0.0, 0.0, 0.0), [STRIP], cruising(east=900.0)).course == pytest.approx(-math.pi / 2)


def test_the_nearest_strip_is_taken_and_without_any_the_place_itself():
    other = LandingStrip(Place(2000.0, 0.0, 0.0), 0.0, 200.0, 10.0)
    assert lane_for(Place(1900.0, 0.0, 0.0), [STRIP, other], cruising()).width == 10.0
    assert lane_for(Place(70.0, 30.0, 2.0), [], cruising()).aim == Place(70.0, 30.0, 2.0)


def test_the_wheels_are_to_touch_a_quarter_or_sixty_metres_behind_the_threshold():
    assert EAST.aim.east == pytest.approx(-150.0 + 60.0)
    assert EAST.rest == pytest.approx(240.0)
    assert LandingStrip(Place(0.0, 0.0, 0.0), 0.0, 100.0, 8.0).lane(0.0).aim.north == pytest.approx(-25.0)


@pytest.mark.parametrize("wind", [-2.0, 0.0, 8.0])
def test_the_flare_ends_on_the_ground_where_it_is_meant_to_whatever_the_wind(wind):
    speed = 19.0 - wind
    height, slope, flares = flare(0.0, speed, SLOPE)
    assert (height, flares) == (0.0, True)
    assert slope * speed == pytest.approx(TOUCH_SINK)


def test_the_flare_has_no_step_and_no_kink():
    distances = np.linspace(-20.0, 200.0, 2201)
    heights, slopes = np.array([flare(float(d), 19.0, SLOPE)[:2] for d in distances]).T
    assert np.abs(np.diff(heights)).max() < 0.1 * SLOPE * 1.01
    assert np.abs(np.gradient(heights, distances)[1:-1] - slopes[1:-1]).max() < 2e-4
    assert (np.diff(slopes) > -1e-9).all()


def replace_params(**changed):
    return msgspec.structs.replace(PARAMS, **changed)


def joining(**state):
    """Where the circle is left for the final approach, eastwards."""
    start = 25.0 * PARAMS.min_airspeed
    place = {"east": EAST.aim.east - start, "north": 0.0, "height": 5.0 + PARAMS.gear_height + SLOPE * start}
    return cruising(**{"course": math.pi / 2, "yaw": math.pi / 2, **state, **place})


def on_final(distance, height, right=0.0, airspeed=19.0, clearance=None, params=PARAMS, must_land=False, **now):
    """Eastwards, ``distance`` [m] before the point to touch at, the wheels ``height`` [m] over the strip."""
    context = FlightContext(clearance=clearance, must_land=must_land)
    state = {
        "course": math.pi / 2,
        "yaw": math.pi / 2,
        "airspeed": airspeed,
        "ground_speed": airspeed,
        "north": -right,
        "east": EAST.aim.east - distance,
        "height": height + 5.0 + PARAMS.gear_height,
        **now,
    }
    landing = LandingMode(cruising(**state), lambda now: EAST, context, params)
    landing.step(joining(**state), params, 0.02)
    return landing, cruising(**state)


def test_it_leaves_the_circle_onto_the_final_approach_only_aligned_and_low_enough():
    landing, _ = on_final(300.0, 24.0)
    assert landing.circle is None
    high, _ = on_final(300.0, 24.0, course=0.5)
    assert high.circle is not None


def test_more_crosswind_than_it_may_land_in_keeps_it_on_the_circle():
    params, at_exit = replace_params(crosswind_max=6.0), joining()
    higher = ((at_exit.height - 5.0) / 10.0) ** (1 / 7)  # than 10 m over the strip: so much more wind
    landing, _ = on_final(300.0, 24.0, params=params, wind_north=7.0 * higher)
    assert landing.circle is not None
    assert landing.told == "it waits on the circle: 7.0 m/s of crosswind, crosswind_max is 6 m/s"
    landing.told = ""
    landing.step(replace(at_exit, wind_north=5.8 * higher), params, 0.02)  # not enough less to change its mind
    assert landing.circle is not None and not landing.told
    landing.step(replace(at_exit, wind_north=5.3 * higher), params, 0.02)
    assert landing.circle is None and landing.told == "it lands: 5.3 m/s of crosswind"


def lanes_in(wind, seconds=120.0):
    """Times [s] at which the landing has turned to another circle, in a wind [m/s, to the east] by the time [s]."""
    landing = LandingMode(cruising(), lambda now: lane_for(Place(0.0, 0.0, 0.0), [STRIP], now), FlightContext(), PARAMS)
    circles = [(0.0, landing.circle)]
    for t in np.arange(0.0, seconds, 0.1):
        landing.step(cruising(east=200.0, wind_east=wind(t)), PARAMS, 0.1)
        circles.append((t, landing.circle))
    return [t for (_, before), (t, circle) in pairwise(circles) if circle != before]


def test_turbulence_does_not_turn_the_lane_and_a_wind_that_is_found_out_does():
    assert lanes_in(lambda t: 3.0 * math.sin(math.tau * t / 30.0)) == []
    (found_out,) = lanes_in(lambda t: 5.0 * (t > 1.0))
    assert 2.0 < found_out < 8.0
    (later,) = lanes_in(lambda t: 5.0 * (t > 60.0))
    assert 65.0 < later < 85.0


def test_a_wind_along_the_lane_and_a_failsafe_do_not_wait():
    params = replace_params(crosswind_max=6.0)
    assert on_final(300.0, 24.0, params=params, wind_east=-9.0)[0].circle is None
    assert on_final(300.0, 24.0, params=params, wind_north=9.0, must_land=True)[0].circle is None


def on_path(distance):
    """Height [m] of the wheels in still air."""
    return flare(distance, 19.0, SLOPE)[0]


def test_in_gusty_wind_the_path_ends_before_the_point_to_touch_at():
    landing, now = on_final(200.0, on_path(200.0 - EARLY * 19.0), wind_north=GUSTY)
    assert landing.step(now, PARAMS, 0.02).asked.climb == pytest.approx(-SLOPE * 19.0, abs=0.05)


def test_it_follows_the_slope():
    landing, now = on_final(200.0, on_path(200.0))
    track = landing.step(now, PARAMS, 0.02).asked
    assert track.climb == pytest.approx(-SLOPE * 19.0, abs=0.05)
    assert track.airspeed == PARAMS.min_airspeed


def test_a_range_finder_corrects_the_height():
    landing, now = on_final(100.0, on_path(100.0), clearance=on_path(100.0) + 1.0)
    for _ in range(300):
        track = landing.step(now, PARAMS, 0.02).asked
    assert track.climb == pytest.approx(-SLOPE * 19.0 - PARAMS.altitude_p, abs=0.02)


def test_in_wind_it_approaches_a_little_faster():
    landing, now = on_final(200.0, 16.0, wind_east=-8.0)
    assert PARAMS.min_airspeed < landing.step(now, PARAMS, 0.02).asked.airspeed <= 1.2 * PARAMS.min_airspeed


@pytest.mark.parametrize(
    ("changed", "why"),
    [
        ({"height": 9.0}, "too high"),
        ({"distance": 120.0, "height": 2.2}, "too low"),
        ({"right": 7.0}, "aside"),
        ({"airspeed": 27.0}, "too fast"),
    ],
)
def test_an_approach_that_is_not_stable_is_given_up_for_another(changed, why):
    landing, now = on_final(**{"distance": 80.0, "height": flare(80.0, 19.0, SLOPE)[0], **changed})
    landing.step(now, PARAMS, 0.02)
    assert why in landing.told
    climbing = landing.step(now, PARAMS, 0.02)
    assert (climbing.asked.throttle, climbing.flap) == (1.0, 0.0)


def test_half_of_the_strip_without_touching_is_enough():
    landing, now = on_final(-125.0, 0.8)
    landing.step(now, PARAMS, 0.02)
    assert "half of the strip" in landing.told


def test_after_a_climb_it_approaches_again():
    landing, now = on_final(200.0, 16.0)
    landing.around("asked by test")
    landing.step(now, PARAMS, 0.02)
    assert landing.circle is None
    landing.step(cruising(east=300.0, height=60.0), PARAMS, 0.02)
    assert landing.circle is not None


def test_wheels_down_the_motor_is_off_and_at_rest_it_is_done():
    landing, now = on_final(2.0, 0.05, clearance=0.05)
    for _ in range(10):
        landing.step(now, PARAMS, 0.02)
    assert landing.rolls
    lowering = [landing.step(now, PARAMS, 0.02).asked for _ in range(40)]
    assert isinstance(lowering[0], AttitudeSetpoint) and lowering[0].throttle == 0.0
    assert lowering[0].pitch > lowering[-1].pitch > 0.0, "the nose comes down gently"
    for _ in range(20):
        braking = landing.step(replace(now, airspeed=10.0), PARAMS, 0.02).asked
    assert isinstance(braking, Surfaces)
    assert braking.brake > 0
    for _ in range(100):
        landing.step(cruising(ground_speed=0.2, airspeed=3.0, yaw=math.pi / 2), PARAMS, 0.02)
    assert (landing.ended, landing.disarms) == ("landed", True)


def test_without_a_range_finder_it_feels_that_it_sinks_no_more():
    landing, now = on_final(-5.0, -0.2, climb=0.0)
    for _ in range(60):
        landing.step(now, PARAMS, 0.02)
    assert landing.rolls


def test_a_gust_that_holds_it_up_is_not_taken_for_the_ground():
    landing, now = on_final(-5.0, 0.5, climb=0.0)
    for i in range(100):
        landing.step(replace(now, climb=0.3 * math.sin(0.2 * i)), PARAMS, 0.02)
    assert not landing.rolls


def test_without_a_range_finder_it_goes_on_sinking_below_where_it_takes_the_ground_to_be():
    landing, now = on_final(-1.0, -0.6, climb=-0.4)
    assert landing.step(now, PARAMS, 0.02).asked.climb == pytest.approx(-TOUCH_SINK)


def test_over_the_strip_the_nose_is_not_lowered_below_that_of_touching():
    landing, now = on_final(10.0, 0.4, clearance=0.4)
    floor = landing.step(now, PARAMS, 0.02).asked.lowest_pitch
    alpha = PARAMS.alpha_zero_lift + PARAMS.alpha_per_load * 9.80665 / 19.0**2
    assert floor == pytest.approx(alpha - TOUCH_SINK / 19.0 - 0.04, abs=0.005)
    high, above = on_final(100.0, 8.0)
    assert high.step(above, PARAMS, 0.02).asked.lowest_pitch == -math.inf


def test_a_tail_dragger_that_is_fast_touches_with_its_nose_level_for_the_propellers_sake():
    def lowest(gear):
        landing, now = on_final(3.0, 0.3, airspeed=28.0, params=replace_params(gear=gear))
        return landing.step(now, replace_params(gear=gear), 0.02).asked.lowest_pitch

    assert lowest("nose_wheel") < 0.0 == lowest("tail_wheel")


def test_the_headwind_that_is_lost_near_the_ground_is_made_up_for_before_it_is_gone():
    def asked(height, wind_east, params=PARAMS):
        landing, now = on_final(6.0, height, ground_speed=12.0, wind_east=wind_east, params=params)
        return landing.step(now, params, 0.02).asked

    calm, windy = (asked(0.6, wind) for wind in (0.0, -5.0))
    here, there = (logarithmic(height + PARAMS.gear_height, STRIP_ROUGHNESS, 10.0) for height in (0.6, 0.6 - 0.5 * TOUCH_SINK))
    lost = 5.0 * (1 - there / here)  # half a second later, sinking as it is meant to
    assert windy.airspeed == pytest.approx(calm.airspeed + 0.4 * 5.0 + lost)
    lift = PARAMS.alpha_per_load * GRAVITY / 19.0**2 * ((1 - lost / 19.0) ** -2 - 1)  # rad
    assert (windy.climb - calm.climb) * (1 + PARAMS.final_climb_p) / 19.0 == pytest.approx(lift, rel=0.15)
    assert asked(0.6, 5.0).climb == calm.climb  # a wind from behind gives airspeed
    no_gear = replace_params(gear_height=0.0)
    assert asked(-0.4, -5.0, no_gear).climb == asked(-0.4, 0.0, no_gear).climb  # on the ground there is no more to lose


def test_flaps_answer_the_lift_that_a_gust_takes_at_once_and_a_climb_that_is_wanting():
    def lift(specific_force_up, climb=0.0):
        context = FlightContext(specific_force_up=specific_force_up)
        landing, now = on_final(10.0, on_path(10.0), climb=climb)
        landing._senses = context
        return landing.step(now, PARAMS, 0.02).lift

    assert lift(GRAVITY - 0.5) == pytest.approx(lift(GRAVITY) + LIFT_A * 0.5)
    assert lift(GRAVITY, climb=-1.0) == pytest.approx(lift(GRAVITY) + LIFT_P * 1.0, abs=0.2)


def test_carried_on_beyond_the_point_it_sinks_faster():
    assert late(5.0) == 0.0
    assert 0.0 < late(-5.0) < late(-10.0) == late(-30.0)


@pytest.mark.parametrize(("airspeed", "flies"), [(18.0, True), (9.0, False)])
def test_lifted_again_by_a_bounce_or_a_gust_it_flares_once_more_as_long_as_it_flies(airspeed, flies):
    landing, now = on_final(2.0, 0.05, clearance=0.05)
    for _ in range(10):
        landing.step(now, PARAMS, 0.02)
    assert landing.rolls
    landing._senses.update(FlightContext(clearance=0.6))
    landing.step(replace(now, airspeed=airspeed, height=now.height + 0.5), PARAMS, 0.02)
    assert landing.rolls != flies


def test_while_it_rolls_it_does_not_go_around():
    landing, now = on_final(2.0, 0.05, clearance=0.05)
    for _ in range(10):
        landing.step(now, PARAMS, 0.02)
    landing.around("asked by test")
    assert landing.rolls
