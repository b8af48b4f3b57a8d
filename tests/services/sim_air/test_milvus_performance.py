"""Steady flights of the running Milvus are those that a hand calculation from its coefficients gives."""

import math
from dataclasses import replace

import msgspec
import numpy as np
import pytest

from benchmarks.sim.air.milvus.coefficients import FOLDER, TANGENT
from benchmarks.sim.air.milvus.performance import ALTITUDES, SPEEDS, Running, density, level_by_hand, performance, trims
from services.sim_air.actuators import Actuators
from services.sim_air.aircraft import Aircraft
from services.sim_air.engine.airframe import Airframe
from services.sim_air.engine.states import InitialState
from tests import aerosonde
from uvf.models.vehicle.file import load_vehicle
from uvf.models.yaml_data import BadInput


@pytest.fixture(scope="module")
def flights():
    return performance(None)


def test_it_trims_at_three_speeds_and_three_altitudes_as_by_hand():
    rows = trims(None)
    assert len(rows) == len(SPEEDS) * len(ALTITUDES) == 9
    for name, row in rows.items():
        assert row["residual"] < 1e-6, name
        assert row["alpha deg"] == pytest.approx(row["by hand"], abs=0.02), name
        assert row["elevator deg"] == pytest.approx(row["by hand "], abs=0.05), name
        assert row["throttle"] == pytest.approx(row["by hand  "], abs=1e-3), name


def test_slowest_flight_glide_climb_and_endurance_are_those_by_hand_within_half_a_percent(flights):
    off = {name: row["off %"] for name, row in flights.items()}
    assert len(off) == 10
    assert max(off.values()) < 0.5, off


def test_the_elevator_gives_out_before_the_wing_does(flights):
    """At its stop it holds alpha = (C_m_0 + 0.99 x 0.52) / 2.74 = 0.193 rad, far from the 0.42 rad of the wing's largest lift."""
    slowest = Running().steady(flights["slowest level flight, m/s"]["running"], 100.0, climb=0.0)
    assert slowest.alpha == pytest.approx((0.0135 + 0.99 * 0.52) / 2.74, rel=0.002)
    assert math.degrees(slowest.alpha) < 12


def test_the_battery_counts_what_the_motor_draws():
    running = Running()
    running.steady(25.0, 100.0, climb=0.0)
    assert running.airframe.motor_power == running.electric_power()
    assert running.airframe.motor_power == pytest.approx(level_by_hand(25.0, density(100.0))[1], rel=0.005)


def flying_on(battery):
    file = load_vehicle(FOLDER.parent, "milvus")
    pack = msgspec.structs.replace(file.air.battery, **battery)
    file = msgspec.structs.replace(file, air=msgspec.structs.replace(file.air, battery=pack))
    airframe = Airframe(FOLDER, file.air, TANGENT)
    trim = airframe.start(InitialState(np.array((0.0, 0.0, 100.0)), 0.0, 25.0, np.zeros(3)))
    return Aircraft("milvus", file, airframe, Actuators(trim.controls, file.air), trim.controls)


def test_the_battery_empties_by_what_motor_and_avionics_draw_and_then_the_motor_stops():
    aircraft = flying_on({"energy": 4000.0, "resistance": 0.0})
    aircraft.fly_to(5.0)
    used = 4000.0 * (1 - aircraft.charge.remaining)
    power = level_by_hand(25.0, density(400.0))[1] + 15.0
    assert used == pytest.approx(power * 5.0, rel=0.005)
    assert aircraft.charge.current == pytest.approx(power / aircraft.charge.voltage, rel=0.005)
    aircraft.fly_to(15.0)
    assert aircraft.charge.remaining == 0.0
    assert aircraft.body.motor_power == 0.0
    assert aircraft.motion.velocity[2] < -1.0


def test_on_a_weak_battery_full_throttle_draws_what_the_motor_draws_at_the_batterys_voltage():
    aircraft = flying_on({"full": 42.1})
    aircraft.command = replace(aircraft.command, throttle=1.0)
    aircraft.fly_to(6.0)
    voltage, motion = aircraft.charge.voltage, aircraft.motion
    assert aircraft.throttle == pytest.approx(voltage / 44.4, abs=1e-3)
    assert voltage == pytest.approx(42.1 - 0.06 * aircraft.charge.current, abs=0.05)
    rho = density(400.0 + motion.position[2] - 100.0)
    assert aircraft.body.motor_power == pytest.approx(aerosonde.motor_power(motion.airspeed, voltage / 44.4, rho), rel=0.02)


def test_a_power_that_the_model_does_not_tell_is_named():
    with pytest.raises(BadInput, match=r"battery: power: .*electric/pover-w"):
        flying_on({"power": "electric/pover-w"})
