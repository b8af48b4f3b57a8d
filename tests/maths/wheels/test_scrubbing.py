"""Wheels that scrub: about which point a vehicle turns and as which two wheels, against closed forms and the least dissipation."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize

from uvf.maths.wheels.scrubbing import scrubbing, shared_loads


def wheels(track, *along):
    return np.array([(x, side * track / 2) for side in (1, -1) for x in along])


@pytest.mark.parametrize(
    ("track", "wheelbase", "published"),
    [(0.3756, 0.262, 1.5), (0.5708, 0.512, 1.875)],  # Clearpath's Jackal and Husky: wheel_separation_multiplier
)
def test_four_wheels_under_equal_loads(track, wheelbase, published):
    found = scrubbing(wheels(track, wheelbase / 2, -wheelbase / 2), np.ones(4))
    assert found.track == pytest.approx(track + wheelbase**2 / track)
    assert found.track / track == pytest.approx(published, rel=0.05)
    assert found.pivot == pytest.approx((0.0, 0.0), abs=1e-9)


def test_it_turns_about_the_axle_that_bears_most():
    found = scrubbing(wheels(0.394, 0.135, -0.135), np.array((28.0, 106.0, 28.0, 106.0)))
    assert found.track == pytest.approx(0.394, rel=1e-3)
    assert found.pivot == pytest.approx((-0.135, 0.0), abs=1e-3)


def test_two_wheels_turn_as_they_stand():
    found = scrubbing(np.array(((0.1, 0.2), (0.1, -0.2))), np.ones(2))
    assert found.track == pytest.approx(0.4)
    assert found.pivot == pytest.approx((0.1, 0.0))


@settings(deadline=None, max_examples=25)
@given(st.lists(st.floats(0.2, 1.0), min_size=6, max_size=6), st.floats(0.3, 0.8), st.floats(0.1, 0.4))
def test_no_motion_dissipates_less(loads, track, reach):
    places, weights = wheels(track, reach, 0.1, -reach), np.array(loads)
    treads = np.repeat((-1.0, 1.0), 3)

    def dissipated(motion):
        x, y, turn = motion
        return weights @ np.hypot(x - turn * places[:, 1] - treads, y + turn * places[:, 0])

    found = scrubbing(places, weights)
    turn = 2.0 / found.track
    ours = dissipated((found.pivot[1] * turn, -found.pivot[0] * turn, turn))
    best = min(minimize(dissipated, (0.0, 0.0, w), method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12}).fun for w in (1.0, 4.0))
    assert ours <= best * (1 + 1e-6)


def test_loads_are_shared_as_by_springs_and_hold_the_body():
    places = wheels(0.4, 0.3, 0.0, -0.3)
    loads = shared_loads(places, np.array((0.05, -0.02)))
    assert loads.sum() == pytest.approx(1.0)
    assert loads @ places == pytest.approx((0.05, -0.02))
    assert loads[4] > loads[1]
