"""What the running aircraft can do against the hand calculation from its coefficients."""

from math import cos, pi, sin, sqrt
from pathlib import Path

import numpy as np
import pytest

from services.sim_air.analysis.linear import held_still
from services.sim_air.analysis.performance import climb_rate, glide_ratio, performance
from services.sim_air.engine.airframe import Airframe
from tests import aerosonde as a
from uvf.maths import atmosphere
from uvf.maths.geodesy import LocalTangent
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle

FOLDER = Path(ROOT) / "vehicles" / "milvus"
BODY = load_vehicle(FOLDER.parent, "milvus").air
ALTITUDE = 100.0
RHO = atmosphere.density(atmosphere.pressure(ALTITUDE), atmosphere.T0 - atmosphere.LAPSE * ALTITUDE)
G = 9.8059  # m/s^2 at 45 deg
LIMIT = BODY.controls.elevator.limit
ALPHAS = [x for x in np.linspace(0.0, 0.45, 2000) if abs(a.balanced(x)[2]) <= LIMIT]


@pytest.fixture(scope="module")
def found():
    with held_still(Airframe(FOLDER, BODY, LocalTangent.from_degrees(45.0, 0.0, 0.0))) as airframe:
        return performance(airframe, BODY, ALTITUDE)


def test_the_best_glide_is_the_largest_lift_over_drag_that_the_elevator_balances(found):
    assert glide_ratio(found.glide) == pytest.approx(max(a.balanced(x)[0] / a.balanced(x)[1] for x in ALPHAS), rel=0.01)


def test_the_closed_form_without_an_elevator_glides_a_little_better(found):
    """(L / D) max = 1 / (2 sqrt(K C_D_p))."""
    assert 0.8 < glide_ratio(found.glide) * 2 * sqrt(a.K * a.CDP) < 1.0


def test_the_slowest_flight_has_the_elevator_at_its_stop(found):
    assert found.slowest.elevator == pytest.approx(-LIMIT, abs=1e-6)
    alpha = -(a.CM0 - a.CME * LIMIT) / a.CMA
    assert found.slowest.alpha == pytest.approx(alpha, abs=0.002)
    weight = a.M * G * cos(found.slowest.climb)
    assert found.slowest.airspeed == pytest.approx(sqrt(2 * weight / (RHO * a.S * a.balanced(alpha)[0])), rel=0.01)


def test_the_wing_stalls_where_its_lift_is_largest(found):
    alpha = max(np.linspace(0.0, pi / 4, 2000), key=a.lift)
    assert found.stall_alpha == pytest.approx(alpha, abs=0.01)
    assert found.stall_speed == pytest.approx(sqrt(2 * a.M * G / (RHO * a.S * a.lift(alpha))), rel=0.01)


def test_the_best_climb_is_what_full_throttle_leaves_over(found):
    climbs = [airspeed * sin(climb) for airspeed, climb in (a.climbing(x, RHO, G) for x in ALPHAS[::10])]
    assert climb_rate(found.climb) == pytest.approx(max(climbs), rel=0.02)


def test_endurance_is_the_batterys_energy_over_the_least_power(found):
    flight = a.trimmed(found.cruise.airspeed, RHO, G)
    power = a.motor_power(flight.airspeed, flight.throttle, RHO) + BODY.battery.avionics
    assert found.power == pytest.approx(power, rel=0.03)
    assert found.endurance == pytest.approx(BODY.battery.energy / power, rel=0.03)


def test_nothing_that_was_found_is_beyond_its_controls(found):
    for flight in (found.glide, found.sink, found.slowest, found.climb, found.cruise):
        assert abs(flight.elevator) <= LIMIT + 1e-9
        assert 0 <= flight.throttle <= 1
