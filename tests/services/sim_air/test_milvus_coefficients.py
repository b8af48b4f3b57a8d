"""The running Milvus has the coefficients that the book states, surface by surface, and over the whole circle of alpha."""

import math

import numpy as np
import pytest

from benchmarks.sim.air.milvus.coefficients import (
    BODY,
    FOLDER,
    STATED,
    TANGENT,
    HeldMilvus,
    Point,
    measured,
    stated_drag,
    stated_lift,
    stated_pitch,
)
from services.sim_air.engine.airframe import Airframe
from services.sim_air.engine.states import Held, InitialState
from services.sim_air.engine.wiring import Controls
from uvf.maths import atmosphere

SURFACES = ("left_aileron", "right_aileron", "left_flap", "right_flap", "left_rudder", "right_rudder", "elevator")


@pytest.fixture(scope="module")
def held():
    return HeldMilvus()


def test_every_derivative_is_the_stated_one_within_a_thousandth():
    assert measured() == pytest.approx(STATED, rel=1e-3)


@pytest.mark.parametrize("degrees", [-175, -90, -30, -25, -10, 0, 5, 15, 24, 27, 30, 60, 90, 150, 178])
def test_lift_drag_and_pitching_moment_hold_from_attached_flow_to_the_flat_plate(held, degrees):
    alpha = math.radians(degrees)
    lift, drag, pitch = held.coefficients(Point(alpha=alpha, elevator=0.0))[:3]
    assert (lift, drag, pitch) == pytest.approx([f(np.float64(alpha)) for f in (stated_lift, stated_drag, stated_pitch)], abs=2e-3)


def test_the_elevators_drag_grows_with_its_deflection_either_way(held):
    drag = [held.coefficients(Point(alpha=0.0, elevator=elevator))[1] for elevator in (-0.4, 0.0, 0.4)]
    assert drag[0] - drag[1] == pytest.approx(0.0135 * 0.4, rel=0.01)
    assert drag[2] - drag[1] == pytest.approx(0.0135 * 0.4, rel=0.01)


def test_flaps_cost_drag_of_their_own_and_of_their_lift(held):
    clean, full = (held.coefficients(Point(alpha=0.05, elevator=0.0, flap=flap))[1] for flap in (0.0, 0.6))
    lift = 0.23 + 5.61 * 0.05
    induced = ((lift + 0.96 * 0.6) ** 2 - lift**2) / (math.pi * 0.9 * 2.8956**2 / 0.55)
    assert full - clean == pytest.approx(0.058 * 0.6 + induced, rel=0.01)


def test_flaps_lift_nothing_once_the_flow_has_left_the_wing(held):
    clean, full = (held.coefficients(Point(alpha=0.8, elevator=0.0, flap=flap))[0] for flap in (0.0, 0.6))
    assert full == pytest.approx(clean, abs=1e-3)


def joints_after(controls):
    airframe = Airframe(FOLDER, BODY, TANGENT)
    airframe.stand(InitialState(np.zeros(3), 0.0, 0.0, np.zeros(3)))
    airframe.command(controls)
    airframe.step()
    return {joint.name: joint.position for joint in airframe.joints()}


def test_each_surface_is_told_on_its_own_with_the_sides_where_they_belong():
    found = joints_after(Controls(aileron=0.2, elevator=-0.1, rudder=0.15, flap=0.3))
    expected = (0.2, -0.2, 0.3, 0.3, 0.15, 0.15, -0.1)
    assert [found[name] for name in SURFACES] == pytest.approx(expected)


@pytest.mark.parametrize(
    ("side", "by"),
    [
        ("left-aileron", {"CL": 0.225, "CY": 0.0375, "Cl": 0.085, "Cn": -0.0055}),
        ("right-aileron", {"CL": 0.225, "CY": -0.0375, "Cl": -0.085, "Cn": 0.0055}),
        ("left-flap", {"CL": 0.48, "Cm": -0.055, "Cl": 0.084}),
        ("right-flap", {"CL": 0.48, "Cm": -0.055, "Cl": -0.084}),
        ("left-rudder", {"CL": -0.115, "Cm": 0.64, "CY": 0.095, "Cl": 0.0012, "Cn": -0.0345}),
        ("right-rudder", {"CL": 0.115, "Cm": -0.64, "CY": 0.095, "Cl": 0.0012, "Cn": -0.0345}),
    ],
)
def test_one_side_alone_does_half_and_what_the_pair_hides(side, by):
    """What a jammed surface does: ailerons and flaps lift and roll, one panel of the inverted V pitches."""
    held = HeldMilvus()
    before = held.coefficients(Point())
    held.airframe._fdm[f"fcs/{side}-offset-rad"] = 0.01
    change = dict(zip(("CL", "CD", "Cm", "CY", "Cl", "Cn"), (held.coefficients(Point()) - before) / 0.01, strict=True))
    del change["CD"]
    assert change == pytest.approx({name: by.get(name, 0.0) for name in change}, abs=1e-3)


def book_motor(airspeed, throttle, rho):
    """Thrust [N], torque [N m] and current [A]: equations 4.17 to 4.22, solved for omega by hand."""
    kq, ohm, idle, size = 60 / (2 * math.pi * 145), 0.042, 1.5, 0.508
    volts = 44.4 * throttle
    a = rho * size**5 / (2 * math.pi) ** 2 * 0.005230
    b = rho * size**4 / (2 * math.pi) * 0.004970 * airspeed + kq**2 / ohm
    c = -rho * size**3 * 0.01664 * airspeed**2 - kq * volts / ohm + kq * idle
    turns = (-b + math.sqrt(b * b - 4 * a * c)) / (2 * a) / (2 * math.pi)
    advance = airspeed / (turns * size)
    thrust = rho * turns**2 * size**4 * (0.09357 - 0.06044 * advance - 0.1079 * advance**2)
    torque = rho * turns**2 * size**5 * (0.005230 + 0.004970 * advance - 0.01664 * advance**2)
    return thrust, torque, (volts - kq * turns * 2 * math.pi) / ohm


@pytest.mark.parametrize(("airspeed", "throttle"), [(0.0, 1.0), (15.0, 0.7), (20.0, 1.0), (25.0, 0.8), (30.0, 1.0)])
def test_thrust_torque_and_current_are_the_books(airspeed, throttle):
    airframe = Airframe(FOLDER, BODY, TANGENT)
    airframe.hold_still(True)
    height = 1000.0
    moved = airframe.accelerations_held(Held(np.array((airspeed, 0.0, 0.0)), np.zeros(3), np.zeros(3), height), Controls(throttle=throttle))
    rho = atmosphere.density(atmosphere.pressure(height), atmosphere.T0 - atmosphere.LAPSE * height)
    thrust, torque, current = book_motor(airspeed, throttle, rho)
    assert airframe.propulsive_force == pytest.approx(thrust, rel=0.005, abs=0.02)
    assert airframe._fdm["propulsion/engine/propeller-torque-ftlb"] * 1.3558 == pytest.approx(-torque, rel=0.01)
    assert airframe._fdm["electric/power-w"] == pytest.approx(44.4 * throttle * current, rel=0.01)
    assert 0.8244 * moved[3] - 0.1204 * moved[5] == pytest.approx(-torque, rel=0.02)  # the body turns against its propeller
