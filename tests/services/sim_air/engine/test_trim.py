"""The trim solver on aircraft whose answer is known."""

import numpy as np
import pytest

from services.sim_air.engine.trim import FlightPath, G, Trim, attitude, solve
from uvf.maths import rotations


def linear(answer):
    """Six accelerations that vanish at ``answer``."""
    matrix = np.array(
        [[3.0, 0, 0, 0, 0, 9], [0, 9, 0, 0, 4, 0], [40, 0, 0, 2, 0, 1], [0, 0, 90, 0, 3, 0], [-90, 0, 0, -30, 0, 0], [0, 0, 5, 0, -20, 0]]
    )
    return lambda trim: matrix @ (np.array((trim.alpha, trim.roll, trim.aileron, trim.elevator, trim.rudder, trim.throttle)) - answer)


def test_finds_the_state_without_acceleration():
    answer = np.array((0.06, -0.01, 0.005, -0.15, 0.002, 0.7))
    trim = solve(linear(answer))
    assert trim.converged
    assert (trim.alpha, trim.elevator, trim.throttle) == pytest.approx((0.06, -0.15, 0.7))


def test_more_than_full_throttle_is_no_trim():
    trim = solve(linear(np.array((0.06, 0.0, 0.0, -0.15, 0.0, 1.3))))
    assert not trim.converged


def test_acceleration_that_cannot_be_taken_out_is_no_trim():
    trim = solve(lambda trim: np.array((1.0, 0, 0, 0, 0, 0)) + trim.alpha**2)
    assert not trim.converged
    assert trim.residual > 0.1


def test_a_trim_without_a_solution_says_so():
    assert not Trim(0.0, 0.0, 0.0, 0.0, 0.0, 0.5).converged


def test_an_aircraft_without_a_rudder_flies_with_side_slip():
    def accelerations(trim):
        left = linear(np.array((0.06, -0.01, 0.005, -0.15, 0.0, 0.7)))(trim)
        return (
            left + np.array((0.0, 0.0, 0.0, 0.0, 0.0, 2.0)) * (trim.slip - 0.03) + np.array((0.0, -4.0, 0.0, -3.0, 0.0, 20.0)) * trim.rudder
        )

    trim = solve(accelerations)
    assert trim.converged
    assert (trim.slip, trim.rudder) == pytest.approx((0.03, 0.0), abs=1e-3)


def test_a_coordinated_turn_banks_and_turns_about_the_vertical():
    path = FlightPath(25.0, turn=0.3)
    lies = attitude(path, Trim(0.08, path.bank, 0.0, 0.0, 0.0, 0.5))
    assert np.tan(path.bank) == pytest.approx(25.0 * 0.3 / G)
    down = rotations.matrix(rotations.from_euler(lies.roll, lies.pitch, 0.0)) @ np.array(lies.rates)
    assert down == pytest.approx((0.0, 0.0, 0.3), abs=1e-9)
    course = rotations.matrix(rotations.from_euler(lies.roll, lies.pitch, lies.yaw)) @ np.array((np.cos(0.08), 0.0, np.sin(0.08)))
    assert course == pytest.approx((1.0, 0.0, 0.0), abs=1e-9)  # level, along the course
