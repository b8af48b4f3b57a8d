"""The score against figures by hand, and the clock."""

import pytest

from benchmarks.planning.barn.scoring import Referee, score


@pytest.mark.parametrize(
    ("ending", "time", "optimal", "expected"),
    [
        ("success", 5.0, 5.0, 0.5),  # faster than can be: counts as twice the optimal time
        ("success", 10.0, 5.0, 0.5),
        ("success", 20.0, 5.0, 0.25),
        ("success", 34.09, 5.71, 5.71 / 34.09),
        ("success", 40.0, 5.0, 0.125),
        ("success", 99.0, 5.0, 0.125),  # slower counts as eight times
        ("collision", 10.0, 5.0, 0.0),
        ("timeout", 100.0, 5.0, 0.0),
    ],
)
def test_the_score_is_that_of_the_organisers(ending, time, optimal, expected):
    assert score(ending, time, optimal) == pytest.approx(expected)


def test_the_clock_begins_with_the_first_tenth_of_a_metre():
    referee = Referee((1.0, 1.0), (1.0, 9.0))
    assert referee.look(50.0, (1.0, 1.099), False) is None and referee.time(50.0) == 0.0
    assert referee.look(60.0, (1.0, 1.101), False) is None and referee.time(60.0) == 0.0
    assert referee.look(61.5, (1.0, 1.0), False) is None and referee.time(61.5) == 1.5  # it goes on where it turns back


def test_the_goal_is_reached_at_a_metre():
    referee = Referee((1.0, 1.0), (1.0, 9.0))
    assert referee.look(1.0, (1.0, 7.99), False) is None
    assert referee.look(2.0, (1.0, 8.01), False) == "success"


def test_a_touch_at_the_goal_or_before_the_clock_is_a_collision():
    assert Referee((1.0, 1.0), (1.0, 9.0)).look(1.0, (1.0, 9.0), True) == "collision"
    assert Referee((1.0, 1.0), (1.0, 9.0)).look(0.0, (1.0, 1.0), True) == "collision"


def test_time_is_out_after_a_hundred_seconds_of_the_clock_or_of_standing():
    moving, standing = Referee((0.0, 0.0), (0.0, 9.0)), Referee((0.0, 0.0), (0.0, 9.0))
    moving.look(30.0, (0.2, 0.0), False)
    assert moving.look(129.99, (0.2, 0.0), False) is None and moving.look(130.0, (0.2, 0.0), False) == "timeout"
    assert standing.look(99.99, (0.0, 0.0), False) is None and standing.look(100.0, (0.0, 0.0), False) == "timeout"
