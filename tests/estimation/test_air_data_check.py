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
    """m/s, the gap held against the pitot after three seconds in which ground speed and wind of before expect ``ground``.

    In another wind the lift is another one too, until the aircraft has turned its nose.
    """
    check, t = AirDataCheck(), 0
    for airspeed, over_ground, read, seconds in ((25.0, 25.0, 25.0, AGREES + 2.0), (true, ground, reads, 3.0)):
        for k in range(round(seconds / DT)):
            t += 1
            lift = G * (1 + ((airspeed / 25.0) ** 2 - 1) * math.exp(-k * DT / 0.2))
            static = STATIC + 0.1 * (t % 7)
            said = Pressures(static, 0.5 * RHO0 * read**2 + 1e-6 * t, 288.15)
            check.step((t, said), FlightState(flying_at(airspeed, ground_speed=over_ground, lift=lift), 0.0, True), PARAMS, DT)
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


def test_a_wind_that_has_changed_while_there_was_no_fix_is_no_jump():
    check, said_gap = AirDataCheck(), []
    for t in range(round(60.0 / DT)):
        fixed = not 10.0 < t * DT < 40.0
        read = 25.0 if t * DT < 10.0 else 20.0
        said = Pressures(STATIC + 0.1 * (t % 7), 0.5 * RHO0 * read**2 + 1e-6 * t, 288.15)
        now = flying_at(read, ground_speed=25.0, wind_north=25.0 - read)
        check.step((t, said), FlightState(now, 0.0 if fixed else 5.0, True), PARAMS, DT)
        said_gap.append(check.gap)
    assert not any(said_gap)


def test_a_tube_that_is_clear_again_is_believed_and_its_jump_back_is_no_fault():
    check, gaps = AirDataCheck(), []
    for t in range(round(40.0 / DT)):
        read = 17.7 if 10.0 < t * DT < 20.0 else 25.0
        said = Pressures(STATIC + 0.1 * (t % 7), 0.5 * RHO0 * read**2 + 1e-6 * t, 288.15)
        check.step((t, said), FlightState(flying_at(25.0, ground_speed=25.0), 0.0, True), PARAMS, DT)
        gaps.append(check.gap)
    told = np.array(gaps)
    assert told.min() < -6.0 and told.max() <= 0.0
    assert not told[round(27.0 / DT) :].any()


@pytest.mark.parametrize("size", [0.5, 2.0, 3.0])
@pytest.mark.parametrize(("then", "gap"), [(0.0, -15.0), (17.7, -5.0)])
def test_gusts_are_no_fault_and_a_dead_tube_or_half_the_pressure_is_found_in_them(size, then, gap):
    gaps, after = in_gusts(size, 600.0, then)
    assert not any(gaps)
    assert after < gap


@pytest.mark.parametrize("descended", [0.0, 60.0])
def test_shear_is_granted_for_the_height_that_was_flown_not_for_the_wind(descended):
    """A tube that gradually reads a third less, in 14 m/s of wind: told in level flight; a descent may have left the wind behind."""
    check = AirDataCheck()
    for t in range(round(20.0 / DT)):
        share = min(max(t * DT - 10.0, 0.0) / 5.0, 1.0)
        said = Pressures(STATIC + 0.1 * (t % 7), 0.5 * RHO0 * (25.0 * (1 - 0.35 * share)) ** 2 + 1e-6 * t, 288.15)
        now = flying_at(25.0, ground_speed=11.0, wind_north=-14.0, height=100.0 - descended * share)
        check.step((t, said), FlightState(now, 0.0, True), PARAMS, DT)
    assert bool(check.gap) == (descended == 0.0)
