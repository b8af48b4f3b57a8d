"""How turns are planned and begun: by what the elevator holds, the wing carries and the engine sustains, with the rudder of a roll."""

import math
from dataclasses import replace

import msgspec
import numpy as np
import pytest

from launch.vehicles.aircraft_rules import HEIGHT, SEA_LEVEL
from launch.vehicles.aircraft_trial import ABOVE_STALL, _clear_of_stall, level
from launch.vehicles.autopilot_guess import STEEPEST_BANK, autopilot_figures, planned_bank, sustained_bank
from services.sim_air.analysis.linear import held_still
from services.sim_air.analysis.performance import stall
from services.sim_air.engine.airframe import Airframe
from uvf.control.design.flight_condition import FlightCondition
from uvf.control.design.lateral_loops import rudder_of_roll
from uvf.maths.geodesy import GRAVITY
from uvf.maths.state_space import StateSpace
from uvf.models.scenario import ROOT
from uvf.models.vehicle.air import Surface
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
    assert sustained_bank(FIGURES, 1.0) == STEEPEST_BANK
    assert sustained_bank(weak | {"throttle_climb": 0.0}, 1.0) == STEEPEST_BANK  # a glider pays by its height


def test_the_rudder_goes_with_the_ailerons_so_that_a_steady_roll_does_not_yaw():
    """As of a glider: its ailerons yaw it a little with the roll, the rate of the roll much more against it."""
    a, b = np.zeros((5, 5)), np.zeros((5, 2))
    a[1, 1], a[2, 1], b[1, 0], b[2] = -7.07, -1.26, 13.8, (0.84, -2.47)
    side = StateSpace(a, b, ("v", "p", "r", "phi", "psi"), ("delta_a", "delta_r"))
    flight = FlightCondition(26.0, 26.0, 0.05, side, side, 26.0, 12.0)
    rolling = 13.8 / 7.07  # rad/s per rad of aileron
    assert 0.84 - 1.26 * rolling - 2.47 * rudder_of_roll(flight) == pytest.approx(0.0, abs=1e-9)


def test_a_speed_is_looked_for_that_is_clear_of_the_stall():
    airframe = Airframe(ROOT / "vehicles" / "stick25", load_vehicle(ROOT / "vehicles", "stick25").air, SEA_LEVEL)
    with held_still(airframe):
        _, stalled = stall(airframe, 17.0, HEIGHT)
    assert 6.0 < stalled < 8.0
    assert _clear_of_stall(airframe, 1.2 * stalled) == pytest.approx(1.2, abs=0.01)
    assert _clear_of_stall(airframe, 17.0) == ABOVE_STALL


@pytest.mark.parametrize("model", ["milvus", "stick25"])
def test_what_holds_a_turn_is_that_of_the_steady_turn(model):
    """Ailerons and rudder of a turn, added to those of level flight, hold another turn than the one that they are from."""
    body = load_vehicle(ROOT / "vehicles", model).air
    airframe, speed = Airframe(ROOT / "vehicles" / model, body, SEA_LEVEL), body.trim_speed
    figures = autopilot_figures(airframe, body)
    straight, turn = airframe.start(level(speed)), airframe.start(_turn(speed, 0.5))
    yawing = -GRAVITY / speed * math.sin(0.5)  # to the left
    for name in ("aileron", "rudder"):
        held = getattr(straight, name) + figures[f"{name}_turn"] * yawing
        assert held == pytest.approx(getattr(turn, name), abs=0.006), name
        assert abs(held - getattr(straight, name)) > 0.005, name


def test_an_aircraft_without_a_rudder_flies_level_and_turns():
    body = load_vehicle(ROOT / "vehicles", "stick25").air
    wing = msgspec.structs.replace(body, controls=msgspec.structs.replace(body.controls, rudder=Surface(limit=0.0)))
    airframe = Airframe(ROOT / "vehicles" / "stick25", wing, SEA_LEVEL)
    figures = autopilot_figures(airframe, wing)
    assert figures["rudder_turn"] == 0.0
    trim = airframe.start(_turn(body.trim_speed, 0.5))
    assert trim.rudder == 0.0
    assert trim.converged
