"""The Allan deviation: by its definition, and on noise whose deviation is known."""

import numpy as np
import pytest

from uvf.sensors.allan import allan_deviation, expected, octaves
from uvf.sensors.errors import Channel, Errors

HZ = 100.0


def record(errors, count=200_000, seed=4):
    channel = Channel(errors, 1, np.random.default_rng(seed))
    return np.array([channel.read(np.zeros(1), 1 / HZ)[0] for _ in range(count)])


def slope(taus, deviations):
    """Of the log-log plot."""
    return np.polyfit(np.log(taus), np.log(deviations), 1)[0]


def test_it_is_half_the_mean_square_of_the_change_between_neighbouring_means():
    samples = np.random.default_rng(0).standard_normal(50)
    means = np.convolve(samples, np.ones(4) / 4, "valid")
    _, deviation = allan_deviation(samples, HZ, [4])
    assert deviation[0] == pytest.approx(np.sqrt(np.mean((means[4:] - means[:-4]) ** 2) / 2))


def test_the_standard_set_of_nist():
    """NIST SP 1065, section 12.4: the 1000-point random set of Lehmer's generator; overlapping deviation at 1, 10 and 100."""
    n = [1234567890]
    for _ in range(999):
        n.append(16807 * n[-1] % 2147483647)
    _, deviation = allan_deviation(np.array(n) / 2147483647, 1.0, [1, 10, 100])
    assert deviation == pytest.approx((2.922319e-01, 9.159953e-02, 3.241343e-02), rel=1e-6)


def test_white_noise_falls_with_the_root_of_time():
    errors = Errors(noise=0.02)
    taus, deviation = allan_deviation(record(errors), HZ, octaves(200_000, 200))
    assert slope(taus, deviation) == pytest.approx(-0.5, abs=0.03)
    assert deviation == pytest.approx(0.02 / np.sqrt(HZ * taus), rel=0.1)
    assert expected(errors, HZ, taus) == pytest.approx(0.02 / np.sqrt(HZ * taus))


def test_a_random_walk_rises_with_the_root_of_time():
    errors = Errors(random_walk=0.3)
    taus, deviation = allan_deviation(record(errors), HZ, 2 ** np.arange(4, 11))
    assert slope(taus, deviation) == pytest.approx(0.5, abs=0.06)
    assert deviation == pytest.approx(expected(errors, HZ, taus), rel=0.15)


def test_gauss_markov_noise_has_its_bump():
    errors = Errors(drift=0.1, drift_time=1.0)
    taus, deviation = allan_deviation(record(errors), HZ, 2 ** np.arange(4, 12))
    assert deviation == pytest.approx(expected(errors, HZ, taus), rel=0.1)
    assert taus[np.argmax(deviation)] == pytest.approx(1.89, rel=0.4)  # its greatest value lies at 1.89 correlation times
    assert deviation.max() == pytest.approx(0.617 * 0.1, rel=0.1)


def test_a_constant_does_not_count():
    samples = record(Errors(noise=1.0), 1000)
    assert allan_deviation(samples + 1e6, HZ, [1, 8])[1] == pytest.approx(allan_deviation(samples, HZ, [1, 8])[1], rel=1e-6)


@pytest.mark.parametrize("factor", [0, 501])
def test_intervals_that_do_not_fit_twice_are_refused(factor):
    with pytest.raises(ValueError, match=r"must lie in 1\.\.500"):
        allan_deviation(np.zeros(1000), HZ, [factor])
