"""Passes over the same ground, each with another error of height and roll, are drawn as one surface."""

import numpy as np
import pytest

from uvf.slam.elevation.elevation_map import ElevationMap
from uvf.slam.elevation.strip_adjustment import StripAdjustment

PASS = 5.0
HEIGHT, SPEED, HALF = 18.0, 25.0, 18.0  # m, m/s, m to either side
PERIOD, SWEEPS = 0.2, 8


def ground(x, y):
    """Gentle waves, a terrace of 0.8 m, and blocks of 2 m."""
    waves = 0.4 * np.sin(x / 17.0) + 0.3 * np.cos(y / 11.0)
    block = (np.mod(x, 20.0) < 2.0) & (np.mod(y, 15.0) < 3.0)
    return waves + np.where(y > 20.0, 0.8, 0.0) + np.where(block, 2.0, 0.0)


class Survey:
    """Flies lines to the east and draws what its lidar meets, as its pose has it."""

    def __init__(self):
        self.map, self.strips = ElevationMap(0.25, 0.25), StripAdjustment()
        self.rng = np.random.default_rng(4)
        self.t = 0.0

    def fly(self, y, error, roll=0.0, length=100.0, speed=SPEED):
        """error [m]: of the height of its pose, a number or of the time since the line began; roll [rad] likewise."""
        begun, self.t = self.t, self.t + PERIOD
        while (self.t - begun) * speed < length:
            sweeps, origins = [], []
            for k in range(SWEEPS):
                t = self.t - begun - PERIOD + (k + 1) * PERIOD / SWEEPS
                side = np.linspace(-HALF, HALF, 181)
                x = np.full(len(side), t * speed) + self.rng.normal(0, 0.1)
                z = ground(x, y + side) + self.rng.normal(0, 0.03, len(side))
                z += (error(t) if callable(error) else error) + roll * side
                sweeps.append(np.column_stack((x, y + side, z)))
                origins.append(np.array([x[0], y, HEIGHT]))
            drawn = [self.map.surface(sweep, self.t - PASS) for sweep in sweeps]
            for sweep, raised in zip(sweeps, self.strips.raises(self.t, origins, sweeps, drawn), strict=True):
                self.map.insert(sweep, self.t, raised)
            self.t += PERIOD
        self.t += 15.0

    def errors(self):
        """(rows, columns) [m] of the lowest surface, away from the blocks."""
        found = self.map.elevation()
        rows, columns = np.indices(found.ground.shape)
        x, y = found.x + (columns + 0.5) * 0.25, found.y + (rows + 0.5) * 0.25
        even = sum(np.abs(ground(x + dx, y + dy) - ground(x, y)) for dx in (-0.5, 0.5) for dy in (-0.5, 0.5)) < 0.3
        return np.where(even, found.ground - ground(x, y), np.nan), y


def steps(survey):
    """The largest differences [m] between columns 1 m apart."""
    errors, _ = survey.errors()
    apart = np.abs(errors[4:] - errors[:-4])
    return float(np.nanquantile(apart, 0.999))


def test_passes_that_differ_in_height_and_roll_make_one_surface_and_none_of_them_is_the_right_one():
    survey = Survey()
    for y, error, roll in ((0.0, 0.4, 0.0), (30.0, -0.1, 0.005), (15.0, 0.0, -0.005)):
        survey.fly(y, error, roll)
    assert steps(survey) < 0.15
    errors, _ = survey.errors()
    assert abs(np.nanmean(errors) - 0.1) < 0.08


def test_without_a_correction_there_would_be_a_step(monkeypatch):
    monkeypatch.setattr(StripAdjustment, "raises", lambda self, t, origins, sweeps, drawn: [np.zeros(len(each)) for each in sweeps])
    survey = Survey()
    for y, error in ((0.0, 0.4), (15.0, 0.0)):
        survey.fly(y, error)
    assert steps(survey) > 0.35


def test_an_error_that_changes_on_the_way_is_followed():
    survey = Survey()
    survey.fly(0.0, 0.0)
    survey.fly(15.0, lambda t: 0.3 * np.sin(t * 1.5))
    assert steps(survey) < 0.2


def test_a_few_sweeps_along_a_wall_or_over_a_wood_do_not_lift_the_rest():
    survey = Survey()
    survey.fly(0.0, 0.0)
    survey.fly(15.0, lambda t: 0.9 if 2.0 < t < 2.1 else 0.0)
    errors, _ = survey.errors()
    assert abs(np.nanmedian(errors)) < 0.03
    assert np.nanquantile(np.abs(errors), 0.9) < 0.1


def test_where_nothing_was_drawn_before_nothing_is_raised():
    survey = Survey()
    survey.fly(0.0, 0.3)
    errors, _ = survey.errors()
    assert np.nanmedian(errors) == pytest.approx(0.3, abs=0.02)


def test_who_flies_slowly_is_not_held_to_what_it_has_just_drawn():
    survey = Survey()
    survey.fly(0.0, lambda t: 0.1 * t, length=8.0, speed=2.0)
    errors, _ = survey.errors()
    assert np.nanmax(errors) > 0.3


def test_nothing_and_what_is_not_finite_are_taken():
    strips = StripAdjustment()
    assert strips.raises(1.0, [], [], []) == []
    lost = np.full((3, 3), np.nan)
    (raised,) = strips.raises(2.0, [np.zeros(3)], [lost], [np.full(3, np.nan)])
    assert len(raised) == 3
    heights = ElevationMap(0.25, 0.25)
    heights.insert(lost, 2.0, raised)
    assert heights.elevation() is None
    assert np.isnan(heights.surface(np.array([[1.0, 2.0, 3.0]]), 9.0)).all()
