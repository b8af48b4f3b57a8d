"""Banks, loads and angles of attack that the wing can carry; integrators that wait for their servos."""

import math

import msgspec
import pytest

from tests.services.autopilot.air.point_mass import DT, PARAMS
from tests.services.autopilot.air.states import cruising
from uvf.control.commands import AttitudeSetpoint
from uvf.control.cycle import Cycle
from uvf.control.flight_control import FlightControl
from uvf.control.servos import SERVOS, ServoLimits, Servos, SurfaceTrim

G = 9.80665


def cycle(**changes):
    return Cycle(cruising(**changes), PARAMS, DT)


def hold(now, wanted, control=None):
    return (control or FlightControl(SERVOS)).hold(now, wanted, PARAMS, DT)


def stall_speed(load):
    return math.sqrt(PARAMS.alpha_per_load * load * G / (PARAMS.alpha_max - PARAMS.alpha_zero_lift))


@pytest.mark.parametrize("airspeed", [17.0, 19.0, 21.0, 23.0])
def test_the_stall_speed_in_the_steepest_turn_is_not_above_the_airspeed(airspeed):
    limit = cycle(airspeed=airspeed).bank_with(0.0)
    assert stall_speed(1 / math.cos(limit)) <= airspeed + 1e-9


def test_the_bank_is_limited_by_the_parameter_when_fast_and_to_wings_level_below_the_stall():
    assert cycle(airspeed=30.0).bank_with(0.0) == PARAMS.bank_limit
    assert cycle(airspeed=14.0).bank_with(0.0) == 0.0


def test_a_turn_stays_within_the_load_factor():
    strict = type(PARAMS)(**{name: getattr(PARAMS, name) for name in PARAMS.__struct_fields__} | {"load_max": 1.5})
    assert 1 / math.cos(Cycle(cruising(airspeed=30.0), strict, DT).bank_with(0.0)) == pytest.approx(1.5)


def test_near_the_largest_angle_of_attack_the_nose_is_not_raised_further_and_beyond_it_is_lowered():
    up = AttitudeSetpoint(0.0, 0.4, 0.5)
    slow = cruising(airspeed=16.0, pitch=0.2, lift=G)  # carries its weight at about alpha_max
    mushing = cruising(airspeed=13.0, pitch=0.3, lift=G)
    assert Cycle(slow, PARAMS, DT).highest_pitch == pytest.approx(slow.pitch, abs=0.02)
    assert hold(mushing, up) == hold(mushing, AttitudeSetpoint(0.0, Cycle(mushing, PARAMS, DT).highest_pitch, 0.5))
    assert Cycle(mushing, PARAMS, DT).highest_pitch < mushing.pitch - 0.05


def test_a_pull_is_no_harder_than_the_wing_carries():
    far_up = AttitudeSetpoint(0.0, 0.45, 0.5)
    slow, fast = (hold(cruising(airspeed=v, lift=G), far_up).elevator for v in (18.0, 25.0))
    balance = [PARAMS.elev_zero_alpha + PARAMS.elev_per_alpha * Cycle(cruising(airspeed=v), PARAMS, DT).alpha for v in (18.0, 25.0)]
    assert balance[0] - slow < balance[1] - fast


def test_at_its_stop_a_surface_does_not_wind_up():
    trim = SurfaceTrim(ServoLimits(0.3))
    for _ in range(500):
        assert trim.step(moving=0.5, effect=1.0, rate=0.4, dt=DT) == 0.3
    assert trim.value == 0.0


def test_at_its_stop_the_integrator_still_comes_back():
    trim = SurfaceTrim(ServoLimits(0.3))
    trim.step(moving=0.5, effect=1.0, rate=-0.4, dt=DT)
    assert trim.value < 0.0


def test_while_the_servo_is_behind_its_integrator_waits():
    slow, quick = SurfaceTrim(ServoLimits(0.4, rate=0.5)), SurfaceTrim(ServoLimits(0.4))
    for trim in (slow, quick):
        trim.step(0.0, 1.0, 0.0, DT)
        for _ in range(10):
            trim.step(0.3, 1.0, 0.2, DT)
    assert slow.value == 0.0
    assert quick.value == pytest.approx(10 * DT * 0.2)


def test_the_stops_of_the_vehicle_are_those_of_the_commands():
    servos = Servos(ServoLimits(0.2), ServoLimits(0.25), ServoLimits(0.15))
    wild = cruising(airspeed=14.0, p=-3.0, q=-3.0, r=3.0)
    surfaces = FlightControl(servos).hold(wild, AttitudeSetpoint(1.0, 0.4, 0.5), PARAMS, DT)
    assert surfaces.aileron == 0.2
    assert abs(surfaces.elevator) <= 0.25
    assert abs(surfaces.rudder) == 0.15


def test_an_integrator_does_not_wait_for_a_servo_that_keeps_up():
    trim, plain = SurfaceTrim(ServoLimits(0.4, rate=5.0)), 0.0
    for k in range(200):
        asked = 0.02 * math.sin(0.37 * k)
        trim.step(asked, 1.0, 0.01 * math.cos(0.11 * k), 0.02)
        plain += 0.01 * math.cos(0.11 * k) * 0.02
    assert trim.value == pytest.approx(plain, rel=1e-9)


@pytest.mark.parametrize("no_wing", [{"alpha_per_load": 0.0}, {"alpha_max": 0.05, "alpha_zero_lift": 0.3}])
def test_parameters_that_make_no_wing_leave_limits_that_are_numbers(no_wing):
    cycle = Cycle(cruising(), msgspec.structs.replace(PARAMS, **no_wing), DT)
    assert all(map(math.isfinite, (cycle.load_limit, cycle.bank_with(0.0), cycle.stalled, cycle.highest_pitch)))
