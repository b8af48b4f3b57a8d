"""Every Jacobian against finite differences of what it is the derivative of."""

import numpy as np
import pytest

from uvf.estimation.ekf import observations
from uvf.estimation.ekf.alignment import attitude
from uvf.estimation.ekf.inertial import Mechanisation, transition
from uvf.estimation.ekf.states import SIZE, TILT, FilterState, turned

STEP = 1e-5


def a_state(seed=3):
    rng = np.random.default_rng(seed)
    state = FilterState(attitude(0.5, -0.2, 2.0))
    state.x[3:] = rng.standard_normal(SIZE - 3)
    state.x[3:6] = 20.0, -12.0, 1.5
    return state


def moved(state, k, by=STEP):
    twin, error = state.copy(), np.zeros(SIZE)
    error[k] = by
    twin.add(error)
    return twin


def numerical(observation, state):
    """(m, 25), of the prediction: minus that of the residual."""
    columns = [observation(moved(state, k, -STEP)).residual - observation(moved(state, k)).residual for k in range(SIZE)]
    return np.array(columns).T / (2 * STEP)


EARTH = np.array((25.0, 2.0, 39.0))
OBSERVED = {
    "pitot": lambda s: observations.pitot(s, 380.0, 1.19, 16.0),
    "airspeed": lambda s: observations.airspeed(s, 25.0, 1.0),
    "slip": lambda s: observations.slip(s, 0.0, 1.0),
    "field": lambda s: observations.field(s, np.array((1.0, 2.0, 3.0)), EARTH, 0.5),
    "rest": lambda s: observations.rest(s, 0.1),
    "no turning": lambda s: observations.no_turning(s, np.zeros(3), 0.1),
    "climb": lambda s: observations.climb(s, 0.0, 1.0),
    "place": lambda s: observations.place(-s.x[6:8] - s.x[22:24], 0.0, 1.0),
    "depth": lambda s: observations.depth(-s.x[8] - s.x[24], 0.0, 1.0),
    "height": lambda s: observations.height(s.x[8] - s.x[20], 0.0, 1.0),
    "velocity": lambda s: observations.velocity(-s.x[3:6], s, np.zeros(3), 0.0, 1.0),
}


@pytest.mark.parametrize("name", OBSERVED)
def test_a_measurement_changes_with_the_errors_as_its_jacobian_says(name):
    state = a_state()
    np.testing.assert_allclose(OBSERVED[name](state).jacobian, numerical(OBSERVED[name], state), atol=1e-3, rtol=1e-5)


def after(state, seconds, n=200):
    """The state flown on with constant readings, and the mean acceleration."""
    rates, force = np.array((0.4, -0.2, 0.3)), np.array((1.0, 0.5, -14.0))
    inertial, twin = Mechanisation(rates, force), state.copy()
    accelerations = [inertial.step(twin, rates, force, seconds / n) for _ in range(n)]
    return twin, np.mean(accelerations, axis=0)


def difference(a, b):
    """(25,) errors that lead from b to a."""
    turn = a.rotation @ b.rotation.T
    error = a.x - b.x
    error[TILT] = 0.5 * np.array((turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]))
    return error


def test_errors_grow_as_the_transition_says():
    state, dt = a_state(), 0.01
    end, acceleration = after(state, dt)
    columns = [difference(after(moved(state, k, 1e-4), dt)[0], end) / 1e-4 for k in range(SIZE)]
    expected = transition(end, acceleration, 1e9, dt)
    np.testing.assert_allclose(expected, np.array(columns).T, atol=1e-3)


@pytest.mark.parametrize("lag", [0.05, 0.1])
def test_an_old_fix_is_compared_with_the_state_of_its_moment(lag):
    state = a_state()
    end, acceleration = after(state, lag)
    velocity = observations.velocity(np.zeros(3), end, acceleration, lag, 1.0).jacobian
    place = observations.place(np.zeros(2), lag, 1.0).jacobian
    for k in (0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14):
        now = difference(after(moved(state, k, 1e-4), lag)[0], end) / 1e-4
        then = np.eye(SIZE)[k]
        np.testing.assert_allclose(velocity @ now, then[3:6], atol=0.03)
        np.testing.assert_allclose(place @ now, then[6:8], atol=0.15 * (k < 3) + 0.01)


def test_a_rotation_vector_turns_by_its_length():
    np.testing.assert_allclose(turned(np.array((0.0, 0.0, np.pi / 2))).matrix() @ (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), atol=1e-12)
