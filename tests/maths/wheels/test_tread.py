"""Treads stick until the ground holds no more, and then oppose the slip whatever its direction."""

import numpy as np
import pytest

from uvf.maths.wheels.tread import tread_forces, wheel_frame

LOAD, DT = np.array((50.0,)), 0.005
ROLLED = np.zeros(1)  # it slides and does not roll
GRIP = np.array(((0.8, 0.8),))


def slide(slip, steps=400, grip=GRIP, load=LOAD):
    deflections = np.zeros((1, 2))
    for _ in range(steps):
        forces = tread_forces(deflections, np.array((slip,)), load, grip, ROLLED, DT)
    return forces[0]


@pytest.mark.parametrize("angle", np.linspace(0.0, 2 * np.pi, 13))
def test_what_slips_is_opposed_by_the_whole_friction(angle):
    direction = np.array((np.cos(angle), np.sin(angle)))
    assert slide(0.3 * direction) == pytest.approx(-40.0 * direction, abs=1e-3)


def test_a_body_that_is_pushed_less_than_friction_holds_comes_to_a_stand():
    deflections, velocity, place, mass = np.zeros((1, 2)), np.zeros(2), np.zeros(2), LOAD[0] / 9.81
    for _ in range(2000):
        force = tread_forces(deflections, velocity[None], LOAD, GRIP, ROLLED, DT)[0] + np.array((0.0, 30.0))
        velocity = velocity + force / mass * DT
        place = place + velocity * DT
    assert np.linalg.norm(velocity) < 1e-6
    assert 0.0005 < place[1] < 0.003


def test_a_body_that_is_pushed_more_slides_as_coulomb_says():
    deflections, velocity, mass = np.zeros((1, 2)), np.zeros(2), LOAD[0] / 9.81
    for _ in range(400):
        velocity = velocity + (tread_forces(deflections, velocity[None], LOAD, GRIP, ROLLED, DT)[0] + np.array((60.0, 0.0))) / mass * DT
    assert velocity[0] == pytest.approx((60.0 - 40.0) / mass * 2.0, rel=0.02)


def test_nothing_holds_a_wheel_in_the_air_or_along_its_rollers():
    assert slide((0.3, 0.3), load=np.zeros(1)) == pytest.approx((0.0, 0.0))
    assert slide((0.3, 0.3), grip=np.array(((0.8, 0.0),))) == pytest.approx((-40.0, 0.0))


def test_along_and_across_a_wheel():
    frame = wheel_frame(np.array((0.0, 1.0, 0.0)), np.array((0.0, 0.0, 1.0)))
    assert frame == pytest.approx(np.array(((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))))


def test_rolling_takes_the_deflection_across_away_and_leaves_that_along():
    deflections = np.array(((1e-3, 1e-3),))
    tread_forces(deflections, np.zeros((1, 2)), np.array((100.0,)), np.ones((1, 2)), np.array((0.25,)), DT)
    assert deflections[0] == pytest.approx((1e-3, 0.75e-3))
