"""The trim solver on aircraft whose answer is known."""

import numpy as np
import pytest

from services.sim_air.trim import Trim, solve


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
