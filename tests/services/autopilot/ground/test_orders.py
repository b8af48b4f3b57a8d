"""Orders to a ground vehicle: speed and home; beginning anew; what it has not."""

import math

import pytest

from schemas.messages import (
    ArmRequest,
    HomeCommand,
    PictureCommand,
    RebootCommand,
    SpeedCommand,
    TakeoffCommand,
    Vector3,
    VehicleCommandRequest,
)
from tests.services.autopilot.ground.test_service import BODY, WAYPOINTS, Bench


def asked(bench, **order):
    bench.step(order=[VehicleCommandRequest(source="test", **order)], pose=(7.0, 8.0))
    return bench.said["order"][0].reason


def test_it_drives_no_faster_than_asked_until_cruise_is_asked_for():
    bench = Bench(items=WAYPOINTS)
    assert asked(bench, speed=SpeedCommand(speed=0.2)) == ""
    assert bench.step(60, linear=0.5).speed == pytest.approx(0.2)
    assert asked(bench, speed=SpeedCommand()) == ""
    assert bench.step(60, linear=0.5).speed == pytest.approx(0.5)


@pytest.mark.parametrize("speed", [-0.1, BODY.max_linear + 0.1, math.nan, math.inf])
def test_a_speed_outside_of_its_limits_is_refused_with_them(speed):
    assert "up to 0.5 m/s can" in asked(Bench(), speed=SpeedCommand(speed=speed))


def test_home_is_told_at_its_new_place_or_here():
    bench = Bench()
    assert asked(bench, home=HomeCommand(position=Vector3(x=1.0, y=2.0))) == ""
    home = bench.step(6).said["status"].home
    assert (home.x, home.y) == (1.0, 2.0)
    assert asked(bench, home=HomeCommand()) == ""
    home = bench.step(6).said["status"].home
    assert (home.x, home.y) == (7.0, 8.0)
    assert "not finite" in asked(bench, home=HomeCommand(position=Vector3(x=math.inf)))


def test_what_only_aircraft_do_is_refused():
    for order in ({"takeoff": TakeoffCommand(altitude=50.0)}, {"picture": PictureCommand()}, {}):
        assert asked(Bench(), **order)


def test_begun_anew_it_stands_disarmed_with_its_plan():
    bench = Bench(items=WAYPOINTS).step(40, linear=0.4)
    assert "disarm" in asked(bench, reboot=RebootCommand())
    bench.step(arm=[ArmRequest(arm=False)])
    assert asked(bench, reboot=RebootCommand()) == ""
    bench.step(60, linear=0.4)
    assert bench.speed == 0.0 and not bench.said["status"].armed
    assert len(bench.said["mission"].items) == len(WAYPOINTS)


def test_what_changes_is_told_in_the_same_step():
    bench = Bench()
    bench.step(3)
    bench.step(arm=[ArmRequest(arm=False)])
    assert not bench.said["status"].armed
