"""How steeply turns are planned: by what the elevator holds and the wing carries."""

import math
from dataclasses import replace

import msgspec
import pytest

from launch.vehicles.aircraft_rules import SEA_LEVEL
from launch.vehicles.aircraft_trial import level
from launch.vehicles.autopilot_guess import planned_bank, sustained_bank
from services.sim_air.engine.airframe import Airframe
from uvf.maths.geodesy import GRAVITY
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle
from uvf.models.vehicle.flight_params import AirParams

FIGURES = {
    "alpha_zero_lift": -0.0232,
    "alpha_per_load": 2.29,
    "alpha_max": 0.25,
    "elev_zero_alpha": -0.0328,
    "elev_per_alpha": -0.852,
    "pitch_ff": 0.118,
    "trim_throttle": 0.637,
    "throttle_climb": 0.039,
    "throttle_load": 0.0108,
}
"""Of stick25, as tune finds them."""


def stick25(limit):
    body = load_vehicle(ROOT / "vehicles", "stick25").air
    elevator = msgspec.structs.replace(body.controls.elevator, limit=limit)
    return msgspec.structs.replace(body, controls=msgspec.structs.replace(body.controls, elevator=elevator))


def test_an_elevator_with_enough_way_turns_as_steeply_as_usual():
    assert planned_bank(stick25(0.436), FIGURES) == AirParams().turn_bank


def test_with_less_of_it_turns_are_flatter_and_a_steady_turn_of_the_model_leaves_a_share():
    bank, body = planned_bank(stick25(0.18), FIGURES), load_vehicle(ROOT / "vehicles", "stick25").air
    assert 0.35 < bank < 0.85
    airframe, speed = Airframe(ROOT / "vehicles" / "stick25", body, SEA_LEVEL), body.trim_speed
    straight, turning = (airframe.start(_turn(speed, angle)).elevator for angle in (0.0, bank))
    assert (straight - turning) / (straight + 0.18) == pytest.approx(0.6, abs=0.08)


def _turn(speed, bank):
    return replace(level(speed), turn_rate=GRAVITY / speed * math.tan(bank))


def test_one_that_hardly_holds_level_flight_turns_gently():
    assert planned_bank(stick25(0.085), FIGURES) == pytest.approx(0.3)


def test_a_wing_that_carries_little_more_than_the_weight_turns_gently():
    assert planned_bank(stick25(0.436), FIGURES | {"alpha_max": 0.06}) == pytest.approx(0.3, abs=0.02)
    assert 0.5 < planned_bank(stick25(0.436), FIGURES | {"alpha_max": 0.09}) < 0.85


def test_with_little_throttle_to_spare_turns_are_flatter_and_the_bank_is_limited_to_what_full_throttle_sustains():
    weak = FIGURES | {"trim_throttle": 0.855, "throttle_load": 0.0821}
    full = sustained_bank(weak, 1.0)
    assert 0.0821 * (1 / math.cos(full) ** 2 - 1) == pytest.approx(1 - 0.855)
    assert 0.6 < planned_bank(stick25(0.436), weak) < full - 0.1
    assert sustained_bank(FIGURES, 1.0) == AirParams().bank_limit
    assert sustained_bank(weak | {"throttle_climb": 0.0}, 1.0) == AirParams().bank_limit  # a glider has another way to pay
