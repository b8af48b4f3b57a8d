"""filterpy's filters behind one face: the textbook's equations, and states that measurements do not change."""

import numpy as np
import pytest

from uvf.estimation.kalman import FILTERS, Measured, correct, misfit, move_linearly

SPREAD = np.array(((2.0, 0.3, -0.2), (0.3, 1.0, 0.4), (-0.2, 0.4, 0.5)))
X = np.array((1.0, -2.0, 0.5))
H = np.array(((1.0, 0.0, 2.0), (0.0, 1.0, -1.0)))
R = np.diag((0.2, 0.1))
MEASURED = Measured(np.array((2.5, -2.0)), lambda x: H @ x, H, R)
S = H @ SPREAD @ H.T + R
Y = MEASURED.z - H @ X


@pytest.fixture(params=FILTERS)
def kalman(request):
    return FILTERS[request.param](X.copy(), SPREAD.copy())


@pytest.mark.parametrize("held", [slice(0, 0), slice(0, 1), slice(1, 3)])
def test_held_states_keep_mean_and_covariance_as_schmidt_has_it(kalman, held):
    """Joseph's form with the held rows of the gain zero, written out."""
    gain = SPREAD @ H.T @ np.linalg.inv(S)
    gain[held] = 0.0
    rest = np.eye(3) - gain @ H
    correct(kalman, MEASURED, held)
    assert kalman.x == pytest.approx(X + gain @ Y, abs=1e-12)
    covariance = kalman.P
    assert covariance == pytest.approx(rest @ SPREAD @ rest.T + gain @ R @ gain.T, abs=1e-12)


def test_a_linear_motion_is_the_same_however_it_is_told(kalman):
    f, shift, q = np.array(((1.0, 0.1, 0.0), (0.0, 1.0, 0.1), (0.0, 0.0, 0.9))), np.array((0.1, 0.0, -0.2)), np.eye(3) * 0.01
    other = type(kalman)(X.copy(), SPREAD.copy())
    kalman.move(lambda x: f @ x + shift, f, q)
    move_linearly(other, f, shift, q)
    for moved in (kalman, other):
        assert moved.x == pytest.approx(f @ X + shift, abs=1e-12)
        covariance = moved.P
        assert covariance == pytest.approx(f @ SPREAD @ f.T + q, abs=1e-12)


def test_the_misfit_is_told_before_anything_is_changed(kalman):
    assert misfit(kalman, MEASURED) == pytest.approx(Y @ np.linalg.inv(S) @ Y)
    covariance = kalman.P
    assert kalman.x == pytest.approx(X) and covariance == pytest.approx(SPREAD)
