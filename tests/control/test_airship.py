"""The law of airships: the rudder turns, throttle holds the airspeed, nothing winds up, and a change of law has no bump."""

import math

import msgspec
import pytest

from tests.services.autopilot.air.point_mass import DT
from tests.services.autopilot.air.states import cruising
from uvf.control.airship import AirshipAttitude, AirshipPath
from uvf.control.commands import AltitudeAirspeedSetpoint, AttitudeSetpoint
from uvf.control.cycle import Cycle
from uvf.control.servos import SERVOS
from uvf.maths.geodesy import GRAVITY
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle
from uvf.models.vehicle.flight_params import AirParams

PARAMS = msgspec.convert(load_vehicle(ROOT / "vehicles", "nas10").params["autopilot_air"], AirParams)


def flying(**other):
    return Cycle(cruising(**{"airspeed": 7.0, "lift": GRAVITY, "height": 50.0, **other}), PARAMS, DT)


def path(height=50.0, airspeed=7.0, throttle=None):
    return AltitudeAirspeedSetpoint(0.0, height, 0.0, airspeed, throttle)


@pytest.mark.parametrize("bank", [0.15, -0.15])
def test_a_bank_asked_for_is_a_turn_rate_of_the_rudder(bank):
    law, r = AirshipAttitude(SERVOS), 0.0
    for _ in range(3000):
        rudder = law.step(flying(r=r), AttitudeSetpoint(bank, 0.0, 0.5)).rudder
        r += DT * (-1.0 * rudder - 0.6 * r)  # of a hull that the rudder turns and the air damps
    assert r == pytest.approx(GRAVITY / 7.0 * math.tan(bank), rel=0.02)


def test_there_is_no_aileron_and_a_rudder_that_is_given_is_the_whole_of_it():
    found = AirshipAttitude(SERVOS).step(flying(r=0.3), AttitudeSetpoint(0.1, 0.0, 0.5, rudder=0.2))
    assert (found.aileron, found.rudder) == (0.0, 0.2)


def test_at_half_the_airspeed_the_same_error_moves_the_rudder_four_times_as_far():
    turning = [AirshipAttitude(SERVOS).step(flying(r=0.05, airspeed=v), AttitudeSetpoint(0.0, 0.0, 0.5)).rudder for v in (7.0, 3.5)]
    assert turning[1] / turning[0] == pytest.approx(4.0, rel=0.05)


@pytest.mark.parametrize(("height", "climb"), [(500.0, PARAMS.climb_max), (-500.0, -PARAMS.sink_max)])
def test_it_climbs_and_sinks_no_faster_than_its_limits(height, climb):
    pitch, _ = AirshipPath().step(flying(climb=climb), path(height=height))
    assert pitch == pytest.approx(math.asin(climb / 7.0), abs=0.01)


def test_throttle_does_not_wind_up_at_its_stop():
    law = AirshipPath()
    for _ in range(2000):
        _, throttle = law.step(flying(airspeed=4.0), path(airspeed=9.0))
    assert throttle == 1.0
    assert law.step(flying(airspeed=7.0), path(airspeed=7.0))[1] == pytest.approx(PARAMS.trim_throttle, abs=0.02)


def test_throttle_learns_a_drag_that_is_larger_than_the_parameters_say():
    law = AirshipPath()
    first = law.step(flying(airspeed=6.9), path())[1]
    for _ in range(500):
        _, throttle = law.step(flying(airspeed=6.9), path())
    assert throttle > first + 0.02


def test_pitch_learns_a_heaviness_and_does_not_wind_up_while_it_is_at_its_limit():
    law = AirshipPath()
    first = law.step(flying(climb=-0.1), path())[0]
    for _ in range(500):
        pitch, _ = law.step(flying(climb=-0.1), path())
    assert pitch > first + 0.005
    steep, held = AirshipPath(), msgspec.structs.replace(PARAMS, pitch_limit=0.1)
    sinking = Cycle(cruising(airspeed=7.0, lift=GRAVITY, height=50.0, climb=-3.0), held, DT)
    assert steep.step(sinking, path(height=500.0))[0] == 0.1
    for _ in range(5000):
        steep.step(sinking, path(height=500.0))
    assert steep.step(Cycle(cruising(airspeed=7.0, lift=GRAVITY, height=50.0), held, DT), path())[0] == pytest.approx(0.0, abs=0.01)


def test_a_throttle_that_is_given_is_kept():
    assert AirshipPath().step(flying(airspeed=5.0), path(throttle=0.3))[1] == 0.3


def test_it_takes_over_without_a_bump():
    law = AirshipPath()
    law.begin(flying(), path(), 0.05, 0.7)
    assert law.step(flying(), path()) == pytest.approx((0.05, 0.7), abs=0.01)
