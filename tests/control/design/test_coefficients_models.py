"""The gains that come from coefficients on paper are those that the running aircraft's linear model gives."""

import pytest

from launch.vehicles.linearize import linear_models
from tests import aerosonde
from uvf.control.design.coefficients import gains
from uvf.maths.geodesy import GRAVITY
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle
from uvf.models.vehicle.flight_params import AirParams
from uvf.models.yaml_data import convert

FOLDER = ROOT / "vehicles" / "milvus"
PARAMS = convert(load_vehicle(FOLDER.parent, "milvus").params["autopilot_air"], AirParams, "milvus")


@pytest.fixture(scope="module")
def models():
    """At sea level, where indicated airspeed is the true one."""
    return linear_models(FOLDER, PARAMS.trim_airspeed, 0.0)


@pytest.fixture(scope="module")
def designed():
    return gains(aerosonde.DESIGN, PARAMS.trim_airspeed)


def test_the_aileron_that_holds_a_roll_rate_is_a_phi1_over_a_phi2(models, designed):
    assert designed["roll_ff"] == pytest.approx(models.design.a_phi1 / models.design.a_phi2, rel=0.02)


def test_the_elevator_that_holds_a_pitch_rate_is_a_theta1_over_a_theta3(models, designed):
    assert designed["pitch_ff"] == pytest.approx(-models.design.a_theta1 / models.design.a_theta3, rel=0.01)


def test_the_elevator_that_holds_an_angle_of_attack_is_a_theta2_over_a_theta3(models, designed):
    assert designed["elev_per_alpha"] == pytest.approx(models.design.a_theta2 / models.design.a_theta3, rel=0.01)


def test_the_designed_level_flight_is_the_trim(models, designed):
    alpha = designed["alpha_zero_lift"] + designed["alpha_per_load"] * GRAVITY / PARAMS.trim_airspeed**2
    assert alpha == pytest.approx(models.trim.alpha, abs=0.003)  # rad; thrust carries a little of the weight
    assert designed["elev_zero_alpha"] + designed["elev_per_alpha"] * alpha == pytest.approx(models.trim.elevator, abs=0.008)


def test_the_throttle_of_level_flight_is_that_of_the_file(models):
    assert pytest.approx(models.trim.throttle, abs=0.02) == PARAMS.trim_throttle


def test_throttle_for_speed_and_climb_are_about_those_of_the_airspeed_loop(models):
    """a_V1 / a_V2, and g / (V a_V2), on the spot; the file's hold over the range of flight, where thrust grows faster than by the slope."""
    d = models.design
    assert PARAMS.throttle_speed == pytest.approx(d.a_V1 / d.a_V2, rel=0.25)
    assert PARAMS.throttle_climb == pytest.approx(d.a_V3 / (PARAMS.trim_airspeed * d.a_V2), rel=0.25)
