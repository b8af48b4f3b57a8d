"""Three equations, solved by hand."""

import numpy as np
import pytest

from uvf.maths.vec3 import solve


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e8])
def test_the_solution_is_that_of_the_general_solver(scale):
    rng = np.random.default_rng(1)
    for _ in range(50):
        root, b = rng.normal(size=(3, 3)), rng.normal(size=3)
        a = scale * (root @ root.T + 1e-3 * np.eye(3))
        np.testing.assert_allclose(solve(a, b), np.linalg.solve(a, b), rtol=1e-8)
