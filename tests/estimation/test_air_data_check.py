"""The airspeed that the lift tells of, which speaks for a pitot tube when the wind has changed."""

import math

import numpy as np
import pytest

from tests.services.autopilot.air.states import PARAMS, G, cruising
from uvf.estimation.air_data_check import AGREES, AirDataCheck, FlightState, lift_airspeed
from uvf.estimation.sensor_inputs import Pressures
from uvf.maths.atmosphere import RHO0

DT = 0.02
STATIC = 101325.0  # Pa


def flying_at(airspeed, bank=0.0, **changes):
    """Level, with the angle of attack that this airspeed [m/s] takes in a turn of this bank."""
    lift = G / math.cos(bank)
    alpha = PARAMS.alpha_zero_lift + PARAMS.alpha_per_load * lift / airspeed**2
    return cruising(**{"airspeed": airspeed, "lift": lift, "roll": bank, "pitch": alpha * math.cos(bank), **changes})


@pytest.mark.parametrize("airspeed", [19.0, 25.0, 32.0])
@pytest.mark.parametrize("bank", [0.0, 0.6, -0.8])
def test_lift_and_angle_of_attack_tell_the_airspeed(airspeed, bank):
    found = lift_airspeed(flying_at(airspeed, bank), PARAMS)
    assert found == pytest.approx(airspeed, rel=0.05)


@pytest.mark.parametrize("now", [flying_at(25.0, roll=1.2), flying_at(25.0, pitch=-0.2), flying_at(25.0, lift=-3.0)])
def test_upside_down_or_without_lift_it_tells_nothing(now):
    assert lift_airspeed(now, PARAMS) is None


def judged(true, reads, ground):
    """m/s, the gap held against the pitot after three seconds in which ground speed and wind of before expect ``ground``."""
    check, t = AirDataCheck(), 0
    for airspeed, over_ground, read, seconds in ((25.0, 25.0, 25.0, AGREES + 2.0), (true, ground, reads, 3.0)):
        for _ in range(round(seconds / DT)):
            t += 1
            static = STATIC + 0.1 * (t % 7)
            said = Pressures(static, 0.5 * RHO0 * read**2 + 1e-6 * t, 288.15)
            check.step((t, said), FlightState(flying_at(airspeed, ground_speed=over_ground), 0.0, True), PARAMS, DT)
    return check.gap


def test_a_front_of_wind_is_no_fault_and_a_tube_that_reads_too_little_is():
    assert judged(true=18.0, reads=18.0, ground=26.0) == 0.0
    assert judged(true=26.0, reads=17.0, ground=26.0) < -7.0
    assert judged(true=25.0, reads=0.0, ground=25.0) < -20.0


def in_gusts(size, seconds, then):
    """(gaps of every cycle in gusts of ``size`` [m/s, RMS], the gap two seconds after the tube reads ``then`` [m/s])."""
    check, rng, gust, gaps = AirDataCheck(), np.random.default_rng(3), 0.0, []
    for t in range(round((seconds + 2.0) / DT)):
        gust += (-gust * DT + size * math.sqrt(2 * DT) * rng.standard_normal()) / 2.0
        felt = 25.0 + gust
        read = felt if t * DT < seconds else then
        static = STATIC + 0.1 * (t % 7)
        said = Pressures(static, 0.5 * RHO0 * read**2 + 1e-6 * t, 288.15)
        now = flying_at(felt, ground_speed=25.0, pitch=0.1 + 0.06 * math.sin(0.3 * t * DT))
        check.step((t, said), FlightState(now, 0.0, True), PARAMS, DT)
        gaps.append(check.gap)
    return gaps[: round(seconds / DT)], gaps[-1]


@pytest.mark.parametrize("size", [0.5, 2.0, 3.0])
def test_gusts_are_no_fault_and_a_dead_tube_is_found_in_them(size):
    gaps, after = in_gusts(size, 600.0, then=0.0)
    assert not any(gaps)
    assert after < -15.0
