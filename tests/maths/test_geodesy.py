"""The local tangent plane against the ellipsoid's radii of curvature, and there and back."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from uvf.maths import geodesy as g

METRES = st.floats(-20_000, 20_000)


@given(st.floats(-1.5, 1.5), st.floats(-3, 3), st.floats(-100, 5000), METRES, METRES, st.floats(-100, 5000))
def test_there_and_back(latitude, longitude, altitude, east, north, up):
    plane = g.LocalTangent(latitude, longitude, altitude)
    enu = np.array((east, north, up))
    np.testing.assert_allclose(plane.enu(*plane.geodetic(enu)), enu, atol=2e-3)


def test_small_steps_agree_with_the_radii_of_curvature():
    plane = g.LocalTangent.from_degrees(40.77, 14.79, 100.0)
    n = g.A / np.sqrt(1 - g.E2 * np.sin(plane.latitude) ** 2)
    m = n * (1 - g.E2) / (1 - g.E2 * np.sin(plane.latitude) ** 2)
    east, north, up = plane.enu(plane.latitude + 1e-6, plane.longitude + 1e-6, 101.0)
    assert north == pytest.approx(1e-6 * (m + 100), rel=1e-4)
    assert east == pytest.approx(1e-6 * (n + 100) * np.cos(plane.latitude), rel=1e-4)
    assert up == pytest.approx(1.0, abs=1e-4)
