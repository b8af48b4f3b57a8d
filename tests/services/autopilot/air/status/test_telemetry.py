"""What is steered at and how good the estimate is, as it is told."""

import math

import pytest

from schemas.messages import Mode, ModeRequest, OrbitRequest, SurfaceCommand, Vector3
from tests.services.autopilot.air.sensing import Bench
from uvf.models.vehicle.flight_params import AirParams
from uvf.runtime.messages.convert import stamp


def newest(bench, name):
    return next(out[name] for out in reversed(bench.outputs) if name in out)


def test_in_a_mission_it_is_the_waypoint_with_the_attitude_that_leads_there():
    bench = Bench()
    bench.run(cycles=100)
    told = newest(bench, "targets")
    assert (told.place.x, told.place.y, told.place.z, told.radius) == (900.0, 0.0, 60.0, 0.0)
    assert (told.altitude, told.airspeed) == pytest.approx((60.0, AirParams().trim_airspeed))
    assert abs(told.bank) < 0.05 and 0.0 < told.pitch < 0.2


def test_on_a_circle_it_is_the_centre_and_the_radius_with_its_sign():
    bench = Bench()
    bench.run(cycles=50)
    bench.run(orbit=[OrbitRequest(centre=Vector3(x=25.0, y=-150.0, z=80.0), radius=150.0)])
    bench.run(cycles=100)
    told = newest(bench, "targets")
    assert (told.place.x, told.place.y, told.radius, told.altitude) == pytest.approx((25.0, -150.0, 150.0, 80.0))
    assert told.bank > 0.1, "clockwise round a centre to the south, going east: to the right"


def test_by_hand_nothing_is_held():
    bench = Bench()
    bench.run(cycles=50)
    hand = SurfaceCommand(timestamp=stamp(1.0), throttle=0.5)
    bench.run(mode=[ModeRequest(mode=Mode.MODE_MANUAL)], teleop=hand)
    for n in range(20):
        bench.run(teleop=SurfaceCommand(timestamp=stamp(1.0 + 0.02 * n), throttle=0.5))
    told = newest(bench, "targets")
    assert not any(told.HasField(name) for name in ("place", "altitude", "airspeed", "bank", "pitch"))


def test_the_estimate_is_known_while_its_sensors_are_there_and_worse_without():
    bench = Bench()
    bench.run(cycles=100)
    good = newest(bench, "quality")
    assert good.position_known and good.height_known and good.airspeed_known
    assert all(math.isfinite(v) for _, v in good.ListFields()[4:]) and 0 < good.position_ratio < 1
    bench.run(cycles=500, gnss=None)
    lost = newest(bench, "quality")
    assert not lost.position_known and lost.height_known and lost.position_sigma > 1.5 * good.position_sigma
