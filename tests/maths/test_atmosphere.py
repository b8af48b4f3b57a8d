"""The standard atmosphere against ICAO's table, and each function against its inverse."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from uvf.maths import atmosphere


@pytest.mark.parametrize(("altitude", "pressure", "density"), [(0, 101_325, 1.2250), (1000, 89_874, 1.1116), (5000, 54_020, 0.7361)])
def test_agrees_with_the_icao_table(altitude, pressure, density):
    assert atmosphere.pressure(altitude) == pytest.approx(pressure, rel=1e-4)
    assert atmosphere.density(pressure, 288.15 - 0.0065 * altitude) == pytest.approx(density, rel=1e-3)


@given(st.floats(-400, 10_000))
def test_altitude_inverts_pressure(altitude):
    assert atmosphere.altitude(atmosphere.pressure(altitude)) == pytest.approx(altitude, abs=1e-6)


def test_airspeed_is_that_of_the_dynamic_pressure():
    assert atmosphere.airspeed(0.5 * 1.1 * 25.0**2, 1.1) == pytest.approx(25.0)


def test_a_negative_reading_is_no_airspeed():
    assert atmosphere.airspeed(-5.0, 1.2) == 0.0
