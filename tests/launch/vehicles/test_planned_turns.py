"""How steeply turns are planned, by what the elevator holds."""

import math

import msgspec
import pytest

from launch.vehicles.autopilot_guess import planned_bank
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle
from uvf.models.vehicle.flight_params import AirParams

FIGURES = {"alpha_zero_lift": -0.023, "alpha_per_load": 2.29, "elev_zero_alpha": -0.033, "elev_per_alpha": -0.85, "pitch_ff": 0.118}


def stick25(limit):
    body = load_vehicle(ROOT / "vehicles", "stick25").air
    return msgspec.structs.replace(
        body, controls=msgspec.structs.replace(body.controls, elevator=msgspec.structs.replace(body.controls.elevator, limit=limit))
    )


def test_an_elevator_with_enough_way_turns_as_steeply_as_usual():
    assert planned_bank(stick25(0.436), FIGURES) == AirParams().turn_bank


def test_with_less_of_it_turns_are_flatter_and_leave_a_share_for_their_beginning():
    bank, speed, load = planned_bank(stick25(0.18), FIGURES), stick25(0.18).trim_speed, 0.0
    assert 0.35 < bank < 0.85
    level, turning = (_elevator(speed, 1 / math.cos(b)) for b in (load, bank))
    assert (level - turning) / (level + 0.18) == pytest.approx(0.6, abs=0.03)


def test_one_that_hardly_holds_level_flight_turns_gently():
    assert planned_bank(stick25(0.085), FIGURES) == pytest.approx(0.3)


def _elevator(speed, load):
    alpha = FIGURES["alpha_zero_lift"] + FIGURES["alpha_per_load"] * load * 9.80665 / speed**2
    rate = 9.80665 / speed * (load - 1 / load)
    return FIGURES["elev_zero_alpha"] + FIGURES["elev_per_alpha"] * alpha - FIGURES["pitch_ff"] * rate
