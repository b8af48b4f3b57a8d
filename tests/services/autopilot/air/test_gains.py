"""The parameters in vehicle.yaml are those that the design gives for the published coefficients."""

from pathlib import Path

import pytest

from uvf.control.design.coefficients import AirframeCoefficients, gains
from uvf.maths.atmosphere import RHO0
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle
from uvf.models.vehicle.flight_params import AirParams
from uvf.models.yaml_data import convert

MILVUS = load_vehicle(Path(ROOT) / "vehicles", "milvus")
PARAMS = convert(MILVUS.params["autopilot_air"], AirParams, "milvus")
AEROSONDE = AirframeCoefficients(
    mass=11.0,
    wing_area=0.55,
    chord=0.18994,
    span=2.8956,
    lift_0=0.23,
    lift_alpha=5.61,
    lift_elevator=0.13,
    pitch_0=0.0135,
    pitch_alpha=-2.74,
    pitch_q=-38.21,
    pitch_elevator=-0.99,
    roll_p=-0.51,
    roll_aileron=0.17,
    lift_flap=0.96,
    pitch_flap=-0.11,
)


def test_the_file_holds_the_designed_values():
    for name, value in gains(AEROSONDE, PARAMS.trim_airspeed).items():
        assert getattr(PARAMS, name) == pytest.approx(value, rel=0.01), name


def test_the_designed_elevator_and_alpha_balance_level_flight():
    designed = gains(AEROSONDE, 25.0)
    alpha = designed["alpha_zero_lift"] + designed["alpha_per_load"] * 9.80665 / 25.0**2
    elevator = designed["elev_zero_alpha"] + designed["elev_per_alpha"] * alpha
    lift = 0.5 * RHO0 * 25.0**2 * 0.55 * (0.23 + 5.61 * alpha + 0.13 * elevator)
    assert lift == pytest.approx(11.0 * 9.80665)
    assert 0.0135 - 2.74 * alpha - 0.99 * elevator == pytest.approx(0.0, abs=1e-9)


def test_parameter_names_fit_into_a_mavlink_message():
    assert max(map(len, AirParams.__struct_fields__)) <= 16


def test_the_defaults_are_within_their_own_limits():
    assert convert({name: getattr(AirParams(), name) for name in AirParams.__struct_fields__}, AirParams, "defaults") == AirParams()
