"""Orders beside the mode: a height for the take-off, speed, altitude, home, pictures, beginning anew."""

import math

import pytest

from schemas.messages import (
    AltitudeCommand,
    ArmRequest,
    HomeCommand,
    Mission,
    MissionRequest,
    PictureCommand,
    RebootCommand,
    SpeedCommand,
    TakeoffCommand,
    Vector3,
    VehicleCommandRequest,
)
from services.autopilot.air.mission.orders import carry_out
from services.autopilot.air.mode_manager import ModeManager
from services.autopilot.air.mode_table import FlightMode
from services.autopilot.air.modes.airspeed import airspeed_over_ground
from services.autopilot.air.modes.paths import LoiterOptions
from services.autopilot.air.setpoints import FlightContext
from tests.services.autopilot.air.sensing import WAYPOINTS, resting
from tests.services.autopilot.air.states import PARAMS, cruising
from uvf.guidance.flight_plan import ItemKind, PlanItem
from uvf.guidance.route import Circle, Place

M = FlightMode
FAR = [
    PlanItem(ItemKind.WAYPOINT, Place(900.0, 0.0, 70.0)),
    PlanItem(ItemKind.SPEED, Place(0.0, 0.0, 0.0), speed=21.0),
    PlanItem(ItemKind.WAYPOINT, Place(900.0, 900.0, 70.0)),
]
CRUISE = PARAMS.trim_airspeed


def flying(items=(), **now):
    mode_manager = ModeManager(items)
    mode_manager.step(cruising(**now), PARAMS, 0.02)
    return mode_manager


def asked(mode_manager, now=None, **order):
    return carry_out(VehicleCommandRequest(source="test", **order), mode_manager, now or cruising(), PARAMS)


def speed_of(mode_manager, now=None):
    """m/s, airspeed flown in the next cycle."""
    mode_manager.step(now or cruising(), PARAMS, 0.02)
    return (mode_manager.circling.airspeed if mode_manager.circling else mode_manager.navigator.speed) or CRUISE


@pytest.mark.parametrize("items", [(), FAR])
def test_an_airspeed_holds_until_another_one_cruise_or_another_mode_is_asked_for(items):
    mode_manager = flying(items)
    assert asked(mode_manager, speed=SpeedCommand(speed=29.0)) == ""
    assert [speed_of(mode_manager) for _ in range(3)] == [29.0] * 3
    assert asked(mode_manager, speed=SpeedCommand(speed=22.0)) == ""
    assert speed_of(mode_manager) == 22.0
    assert asked(mode_manager, speed=SpeedCommand(speed=0.0)) == ""
    assert speed_of(mode_manager) == CRUISE
    asked(mode_manager, speed=SpeedCommand(speed=29.0))
    mode_manager.change_mode(M.RETURN, "test")
    assert speed_of(mode_manager) == CRUISE


def test_a_goal_in_the_same_mode_keeps_the_speed_and_one_with_a_speed_of_its_own_replaces_it():
    mode_manager = flying()
    asked(mode_manager, speed=SpeedCommand(speed=29.0))
    mode_manager.go_to(Place(0.0, 300.0, 80.0), "test", PARAMS)
    assert speed_of(mode_manager) == 29.0
    mode_manager.go_to(Place(0.0, 300.0, 80.0), "test", PARAMS, LoiterOptions(-120.0, 22.0))
    assert (speed_of(mode_manager), mode_manager.circle.radius) == (22.0, -120.0)


def test_an_item_of_the_mission_that_sets_a_speed_ends_what_was_asked_for():
    mode_manager = flying(FAR)
    asked(mode_manager, speed=SpeedCommand(speed=29.0))
    assert speed_of(mode_manager) == 29.0
    mode_manager.set_current(2)
    assert [speed_of(mode_manager) for _ in range(2)] == [21.0] * 2


@pytest.mark.parametrize(
    ("speed", "over_ground", "accepted"), [(18.0, False, False), (33.0, False, False), (14.0, True, True), (8.0, True, False)]
)
def test_speeds_outside_of_the_limits_are_refused_with_them(speed, over_ground, accepted):
    now = cruising(wind_north=-6.0)
    why = asked(flying(), now, speed=SpeedCommand(speed=speed, over_ground=over_ground))
    assert (why == "") == accepted and ("m/s can" in why) != accepted


def test_a_speed_over_ground_is_flown_through_the_wind():
    mode_manager, now = flying(), cruising(wind_north=-6.0, course=0.0)
    asked(mode_manager, now, speed=SpeedCommand(speed=20.0, over_ground=True))
    assert speed_of(mode_manager, now) == pytest.approx(26.0)
    assert airspeed_over_ground(cruising(wind_north=6.0, wind_east=8.0), 21.0, PARAMS) == PARAMS.min_airspeed
    assert airspeed_over_ground(cruising(wind_east=8.0), 21.0, PARAMS) == pytest.approx(math.hypot(21.0, 8.0))


def test_speed_and_height_are_not_free_by_hand_and_on_the_ground():
    mode_manager = flying(FAR)
    assert "Hold, Orbit and Return" in asked(mode_manager, altitude=AltitudeCommand(altitude=90.0))
    mode_manager.change_mode(M.MANUAL, "test")
    assert "the speed is not free" in asked(mode_manager, speed=SpeedCommand(speed=25.0))
    mode_manager.context.airborne = False
    for order in ({"speed": SpeedCommand(speed=25.0)}, {"altitude": AltitudeCommand(altitude=90.0)}):
        assert "on the ground" in asked(mode_manager, **order)


@pytest.mark.parametrize("mode", [M.HOLD, M.RETURN, M.ORBIT])
def test_a_circle_is_flown_higher_in_its_place(mode):
    mode_manager = flying()
    mode_manager.orbit(Circle(Place(200.0, 100.0, 80.0), -120.0), 0.0, "test", PARAMS) if mode is M.ORBIT else mode_manager.change_mode(
        mode, "test"
    )
    mode_manager.step(cruising(), PARAMS, 0.02)
    before = mode_manager.circle
    assert asked(mode_manager, altitude=AltitudeCommand(altitude=130.0)) == ""
    assert mode_manager.step(cruising(), PARAMS, 0.02).level.height == 130.0
    assert (mode_manager.mode, mode_manager.circle.centre.point, mode_manager.circle.radius) == (mode, before.centre.point, before.radius)


@pytest.mark.parametrize("altitude", [PARAMS.min_altitude - 1.0, math.nan, math.inf, -math.inf])
def test_a_height_that_is_none_or_too_low_is_refused(altitude):
    assert "too low" in asked(flying(), altitude=AltitudeCommand(altitude=altitude))


def standing(ground=0.0):
    mode_manager = ModeManager((), ground)
    mode_manager.hear(FlightContext(airborne=False, armed=False), 0.02)
    mode_manager.step(cruising(height=ground, airspeed=0.0, ground_speed=0.0), PARAMS, 0.02)
    return mode_manager


def test_a_take_off_ends_at_the_height_that_was_asked_for():
    mode_manager = standing(ground=12.0)
    assert asked(mode_manager, takeoff=TakeoffCommand(altitude=100.0)) == ""
    mode_manager.hear(FlightContext(airborne=True), 0.02)
    mode_manager.step(cruising(height=99.0), PARAMS, 0.02)
    assert mode_manager.mode is M.TAKEOFF
    mode_manager.step(cruising(height=100.5), PARAMS, 0.02)
    mode_manager.step(cruising(height=100.5), PARAMS, 0.02)
    assert (mode_manager.mode, mode_manager.reason) == (M.HOLD, "take-off complete")


def test_a_take_off_to_a_height_below_the_trees_or_in_the_air_is_refused():
    assert "too low" in asked(standing(ground=12.0), takeoff=TakeoffCommand(altitude=16.0))
    assert "the altitude is none" in asked(standing(), takeoff=TakeoffCommand(altitude=math.nan))
    assert "flying" in asked(flying(), takeoff=TakeoffCommand(altitude=100.0))


def test_the_next_take_off_goes_to_its_usual_height_again():
    mode_manager = standing()
    asked(mode_manager, takeoff=TakeoffCommand(altitude=400.0))
    mode_manager.change_mode(M.HOLD, "test")
    mode_manager.change_mode(M.TAKEOFF, "test")
    mode_manager.hear(FlightContext(airborne=True), 0.02)
    for _ in range(2):
        mode_manager.step(cruising(height=PARAMS.takeoff_alt + 1.0), PARAMS, 0.02)
    assert mode_manager.mode is M.HOLD


def test_return_turns_to_a_new_home_on_its_way():
    mode_manager = flying()
    mode_manager.change_mode(M.RETURN, "test")
    mode_manager.step(cruising(), PARAMS, 0.02)
    assert asked(mode_manager, home=HomeCommand(position=Vector3(x=500.0, y=-300.0, z=7.0))) == ""
    mode_manager.step(cruising(), PARAMS, 0.02)
    assert mode_manager.circle.centre.point == (-300.0, 500.0)
    assert mode_manager.home == Place(-300.0, 500.0, 7.0)


def test_home_here_lies_below_the_aircraft_and_needs_a_position():
    mode_manager = flying()
    assert asked(mode_manager, cruising(north=40.0, east=9.0, height=90.0), home=HomeCommand()) == ""
    assert mode_manager.home == Place(40.0, 9.0, 0.0)
    mode_manager.fly_blind(True)
    assert "GNSS is lost" in asked(mode_manager, home=HomeCommand())
    assert "not finite" in asked(mode_manager, home=HomeCommand(position=Vector3(x=math.nan)))


def test_pictures_are_taken_once_or_each_so_many_metres_in_any_mode():
    mode_manager = flying()
    assert asked(mode_manager, picture=PictureCommand()) == ""
    mode_manager.step(cruising(), PARAMS, 0.02)
    assert mode_manager.shutter.pictures == 1
    assert asked(mode_manager, picture=PictureCommand(distance=50.0)) == ""
    for north in range(0, 201, 10):
        mode_manager.step(cruising(north=float(north)), PARAMS, 0.02)
    assert mode_manager.shutter.pictures == 1 + 5
    assert asked(mode_manager, picture=PictureCommand(distance=0.0)) == ""
    mode_manager.step(cruising(north=900.0), PARAMS, 0.02)
    assert mode_manager.shutter.pictures == 6
    assert "none" in asked(mode_manager, picture=PictureCommand(distance=-1.0))


def test_an_empty_order_is_refused():
    assert "nothing" in asked(flying())


def test_begun_anew_it_is_disarmed_with_its_plan_and_knows_nothing_of_where_it_was():
    bench = resting(WAYPOINTS)
    plan = bench.service._plans.mission.id
    bench.run(arm=[ArmRequest(arm=True, force=True)], speed=0.0)
    assert "disarm it" in bench.run(order=[VehicleCommandRequest(reboot=RebootCommand())], speed=0.0)["order"][0].reason
    bench.run(arm=[ArmRequest(arm=False)], mission=[MissionRequest(mission=Mission(items=WAYPOINTS[:1]))], speed=0.0)
    assert bench.run(order=[VehicleCommandRequest(reboot=RebootCommand())], speed=0.0)["order"][0].accepted
    bench.run(speed=0.0)
    assert bench.service._plans.mission.id not in (0, plan)
    assert not bench.service._armed and bench.service._cycles <= 1
