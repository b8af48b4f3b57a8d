"""Linear models: slopes of a known function, parts by name, responses that have a closed form."""

import numpy as np
import pytest

from uvf.maths.state_space import StateSpace, jacobian

SPRING = StateSpace(np.array(((0.0, 1.0), (-4.0, 0.0))), np.array(((0.0,), (4.0,))), ("x", "v"), ("f",))


def test_slopes_of_a_polynomial_are_its_derivatives():
    found = jacobian(lambda x: np.array((x[0] ** 2 * x[1], x[1] ** 2, 3.0)), (2.0, 5.0), (1e-3, 1e-2))
    assert found == pytest.approx(np.array(((20.0, 4.0), (0.0, 10.0), (0.0, 0.0))), abs=1e-9)


def test_a_part_keeps_the_slopes_of_its_names():
    whole = StateSpace(np.arange(9.0).reshape(3, 3), np.arange(6.0).reshape(3, 2), ("x", "y", "z"), ("f", "g"))
    part = whole.part(("z", "x"), ("g",))
    assert part.a.tolist() == [[8.0, 6.0], [2.0, 0.0]]
    assert part.b.tolist() == [[5.0], [1.0]]
    assert part.slope("z", "x") == whole.slope("z", "x") == 6.0
    assert part.slope("x", "g") == whole.slope("x", "g") == 1.0


def test_a_pushed_spring_swings_about_its_new_rest():
    dt, steps = 0.05, 100
    states = SPRING.response(np.ones((steps, 1)), dt)
    t = dt * np.arange(steps + 1)
    assert states[:, 0] == pytest.approx(1 - np.cos(2 * t), abs=1e-12)
    assert states[:, 1] == pytest.approx(2 * np.sin(2 * t), abs=1e-12)


def test_what_is_not_pushed_stays_at_rest():
    assert not SPRING.response(np.zeros((10, 1)), 0.1).any()
