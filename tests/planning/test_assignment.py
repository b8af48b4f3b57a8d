"""Goals are shared among vehicles as well as by trying everything, also where some are slow or shut out."""

from itertools import combinations_with_replacement, pairwise, permutations

import numpy as np
import pytest

from uvf.planning.assignment import assign


def distances(a, b):
    return np.linalg.norm(a[:, None] - b[None], axis=2)


def scattered(seed, vehicles, goals, size=10.0):
    rng = np.random.default_rng(seed)
    starts, places = rng.uniform(0.0, size, (vehicles, 2)), rng.uniform(0.0, size, (goals, 2))
    return distances(starts, places), distances(places, places)


def tour_time(first, between, tour):
    return first[tour[0]] + sum(between[a, b] for a, b in pairwise(tour)) if tour else 0.0


def tried_all(to_goals, between):
    """The best cost of all ways to share the goals."""
    vehicles, goals = to_goals.shape
    best = (np.inf, np.inf)
    for order in permutations(range(goals)):
        for cuts in combinations_with_replacement(range(goals + 1), vehicles - 1):
            ends = (0, *cuts, goals)
            times = [tour_time(to_goals[v], between, order[ends[v] : ends[v + 1]]) for v in range(vehicles)]
            best = min(best, (max(times), sum(times)))
    return best


@pytest.mark.parametrize(("vehicles", "goals"), [(1, 5), (2, 5), (3, 5), (4, 2)])
def test_it_finds_what_trying_everything_finds(vehicles, goals):
    for seed in range(5):
        to_goals, between = scattered(seed, vehicles, goals)
        found = assign(to_goals, between)
        assert (max(found.times), sum(found.times)) == pytest.approx(tried_all(to_goals, between))


def test_the_sum_counts_where_a_far_goal_makes_the_longest_tour():
    for seed in range(5):
        rng = np.random.default_rng(seed)
        starts, places = rng.uniform(0.0, 10.0, (3, 2)), np.vstack(((200.0, 5.0), rng.uniform(0.0, 10.0, (4, 2))))
        to_goals, between = distances(starts, places), distances(places, places)
        found = assign(to_goals, between)
        assert (max(found.times), sum(found.times)) == pytest.approx(tried_all(to_goals, between))


def test_each_goal_is_in_one_tour_and_the_times_are_those_of_the_tours():
    to_goals, between = scattered(1, 4, 40, 100.0)
    found = assign(to_goals, between)
    assert sorted(goal for tour in found.tours for goal in tour) == list(range(40)) and found.unreachable == []
    assert found.times == pytest.approx([tour_time(to_goals[v], between, tour) for v, tour in enumerate(found.tours)])
    assert min(found.times) > 0.8 * max(found.times)
    assert assign(to_goals, between) == found


def test_a_slow_vehicle_gets_less_and_one_that_is_shut_in_gets_nothing():
    to_goals, between = scattered(2, 3, 30, 100.0)
    to_goals[1:] *= ((4.0,), (np.inf,))
    found = assign(to_goals, np.stack((between, 4.0 * between, between)))
    assert len(found.tours[0]) > 2 * len(found.tours[1]) > 0
    assert found.tours[2] == [] and found.times[2] == 0.0


def test_a_goal_behind_a_wall_is_named_and_rooms_keep_their_vehicle():
    """Two rooms with a vehicle each, goal 3 in none of them."""
    to_goals = np.array(((1.0, 2.0, np.inf, np.inf), (np.inf, np.inf, 5.0, np.inf)))
    between = np.full((4, 4), np.inf)
    between[:2, :2] = ((0.0, 1.0), (1.0, 0.0))
    found = assign(to_goals, between)
    assert found == ([[0, 1], [2]], [2.0, 5.0], [3])


def test_without_goals_nobody_goes_anywhere():
    assert assign(np.empty((2, 0)), np.empty((0, 0))) == ([[], []], [0.0, 0.0], [])


@pytest.mark.parametrize(
    ("to_goals", "between", "said"),
    [
        (np.ones((2, 3)), np.ones((2, 2)), r"between has the shape \(2, 2\); it is \(3, 3\)"),
        (np.empty((0, 3)), np.ones((3, 3)), "one vehicle at least"),
        (np.ones(3), np.ones((3, 3)), "one vehicle at least"),
        (np.full((1, 1), np.nan), np.zeros((1, 1)), "no number"),
        (np.full((1, 1), -1.0), np.zeros((1, 1)), "below 0"),
    ],
)
def test_what_is_no_table_of_times_is_refused(to_goals, between, said):
    with pytest.raises(ValueError, match=said):
        assign(to_goals, between)
