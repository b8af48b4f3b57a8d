"""Mean wind over height and the shape of a single gust."""

import math
from itertools import pairwise

import pytest

from uvf.maths.atmosphere import CEILING, FT, logarithmic, one_minus_cosine, power

Z0 = 2.0 * FT


def test_the_logarithmic_law_is_1_at_its_reference_and_the_standards_elsewhere():
    assert logarithmic(20 * FT, Z0, 20 * FT) == pytest.approx(1.0)
    assert logarithmic(200 * FT, Z0, 20 * FT) == pytest.approx(math.log(100) / math.log(10))


def test_the_logarithmic_law_has_a_constant_gradient_over_the_logarithm_of_height():
    steps = [logarithmic(10.0 * 2**k, Z0, 6.0) for k in range(5)]
    assert [b - a for a, b in pairwise(steps)] == pytest.approx([math.log(2) / math.log(6.0 / Z0)] * 4)


def test_there_is_no_wind_on_the_ground_and_no_more_growth_above_1000_feet():
    for profile in (lambda h: logarithmic(h, Z0, 6.0), lambda h: power(h, 1 / 7, 6.0)):
        assert profile(0.0) == 0.0
        assert profile(-1.0) == 0.0
        assert profile(CEILING + 500.0) == profile(CEILING)
        heights = [profile(h) for h in (0.0, 0.3, 0.91, 0.92, 5.0, 50.0, 300.0)]
        assert heights == sorted(heights)


def test_the_power_law_doubles_with_ten_times_the_height_at_its_exponent():
    assert power(60.0, math.log10(2.0), 6.0) == pytest.approx(2.0)


def test_a_gust_begins_and_ends_smoothly_and_is_whole_in_its_middle():
    assert one_minus_cosine(25.0, 50.0) == 1.0
    assert one_minus_cosine(12.5, 50.0) == pytest.approx(0.5)
    assert one_minus_cosine(0.01, 50.0) < 1e-6
    assert (one_minus_cosine(-1.0, 50.0), one_minus_cosine(50.0, 50.0), one_minus_cosine(60.0, 50.0)) == (0.0, 0.0, 0.0)
