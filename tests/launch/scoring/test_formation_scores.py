"""Scores of formations against flights whose figures are known."""

import numpy as np
import pytest

from launch.scoring.formation_scores import separation, station_errors
from uvf.models.mission.formation import Follow

T = np.arange(0.0, 100.0, 0.1)
SPEED = 25.0


def flight(way, aside=0.0, height=100.0, airspeed=SPEED):
    """Eastwards by ``way`` [m], ``aside`` [m] to the right."""
    ones = np.ones(len(T))
    return np.column_stack((T, way, -aside * ones, height * ones, airspeed * ones))


def circle(radius, phase, height=100.0):
    """Clockwise about the origin at the angular speed of 25 m/s on 100 m; ``phase`` [rad] ahead."""
    angle = 0.25 * T + phase
    return np.column_stack((T, radius * np.sin(angle), radius * np.cos(angle), np.full(len(T), height), np.full(len(T), SPEED)))


def test_at_its_station_a_follower_has_no_error():
    errors = station_errors(flight(SPEED * T - 40, 15, 105), flight(SPEED * T), Follow("a", 40, 15, 5))
    assert np.abs(errors[:, 1:]).max() < 1e-6


def test_errors_are_told_along_aside_and_above():
    errors = station_errors(flight(SPEED * T - 43, 17, 104), flight(SPEED * T), Follow("a", 40, 15, 5))
    assert errors[:, 1:] == pytest.approx(np.tile((3.0, 2.0, -1.0), (len(errors), 1)), abs=1e-6)


def test_in_wind_the_station_is_where_the_leader_was_after_so_much_air():
    leader = flight(15 * T)  # 25 m/s through the air against 10 m/s
    errors = station_errors(flight(15 * T - 40 * 15 / 25), leader, Follow("a", 40))
    assert np.abs(errors[:, 1]).max() < 1e-6


def test_on_a_circle_the_station_lies_on_another_one():
    errors = station_errors(circle(90.0, -0.4), circle(100.0, 0.0), Follow("a", 40, 10.0))
    assert np.abs(errors[:, 1:]).max() < 0.2


def test_the_beginning_is_not_scored():
    errors = station_errors(flight(SPEED * T - 40), flight(SPEED * T), Follow("a", 40))
    assert errors[0, 0] == pytest.approx(20.0)


def test_the_separation_is_the_least_distance_at_one_time():
    own, other = flight(SPEED * T), flight(SPEED * T - 30.0, 0.0, 140.0)
    assert separation(own, other)[0] == pytest.approx(50.0)
    least, when = separation(own, flight(SPEED * (100.0 - T), 3.0))
    assert (least, when) == (pytest.approx(3.0, abs=1.3), pytest.approx(50.0, abs=0.1))
