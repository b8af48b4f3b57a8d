"""Whoever is followed leaves a reserve: gusts pass, and turns can be flown at a follower's highest airspeed."""

import math
from dataclasses import replace

import pytest

from services.autopilot.air.build import hosts
from services.autopilot.air.modes.airspeed import LeaderSpeedFilter, reserved
from services.autopilot.air.setpoints import PathSetpoint, Setpoint
from tests.services.autopilot.air.states import PARAMS, cruising
from uvf.control.commands import AltitudeAirspeedSetpoint
from uvf.guidance.vector_field import PathReference, turn_radius
from uvf.models.scenario import ROOT, load_scenario

DT = 0.02
TRACK = PathSetpoint(PathReference(0.0, 0.0, 0.0, 0.04, 1.0), 60.0, 0.0, 25.0)


def steadied(asked=TRACK, **gust):
    """What is asked for after half a minute in calm air, when a gust is met."""
    lead = LeaderSpeedFilter()
    for _ in range(1500):
        lead.step(Setpoint(asked), cruising(), PARAMS, DT)
    return lead.step(Setpoint(asked), cruising(**gust), PARAMS, DT).asked


@pytest.mark.parametrize("known", [0.0, -3.0])
def test_a_gust_from_ahead_does_not_slow_it_down_over_ground(known):
    """Whether the estimated wind has followed the gust already or not."""
    assert steadied(airspeed=28.0, wind_north=known).airspeed == pytest.approx(28.0, abs=0.01)


def test_another_speed_over_ground_is_mended():
    assert steadied(ground_speed=23.0, airspeed=23.0).airspeed == pytest.approx(25.0)


@pytest.mark.parametrize(("airspeed", "asked"), [(40.0, PARAMS.max_airspeed), (10.0, PARAMS.min_airspeed)])
def test_airspeed_stays_within_its_limits(airspeed, asked):
    assert steadied(airspeed=airspeed).airspeed == asked


@pytest.mark.parametrize("asked", [replace(TRACK, throttle=1.0), AltitudeAirspeedSetpoint(0.0, 60.0, 0.0, 25.0)])
def test_a_throttle_or_a_bank_that_is_given_is_left_alone(asked):
    assert steadied(asked, airspeed=28.0) is asked


def test_a_wind_that_lasts_is_flown_in_at_the_airspeed_asked_for():
    lead, now = LeaderSpeedFilter(), cruising(ground_speed=15.0, wind_north=-10.0)
    for _ in range(3000):
        asked = lead.step(Setpoint(TRACK), now, PARAMS, DT).asked
    assert asked.airspeed == pytest.approx(25.0)


def test_its_turns_leave_bank_to_a_follower_at_its_highest_airspeed():
    radius = turn_radius(PARAMS.trim_airspeed, reserved(PARAMS).turn_bank)
    assert math.atan(PARAMS.max_airspeed**2 / (9.80665 * radius)) == pytest.approx(0.95 * PARAMS.bank_limit)


def test_only_whoever_is_followed_leaves_a_reserve():
    services = {host.vehicle: host.make() for host in hosts(load_scenario(ROOT / "missions" / "formation.yaml"))}
    assert {name: s._mode_manager.leads is not None for name, s in services.items()} == {
        "milvus1": True,
        "milvus2": False,
        "milvus3": False,
    }
    assert services["milvus1"].params.turn_bank < services["milvus2"].params.turn_bank
