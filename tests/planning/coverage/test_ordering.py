import itertools

import numpy as np
import pytest

from uvf.planning.coverage.ordering import best_tour, rule_orders, tour_cost


def random_costs(n, seed):
    return np.random.default_rng(seed).uniform(1.0, 100.0, (2 * n + 1, 2 * n + 1))


@pytest.mark.parametrize("seed", range(6))
def test_few_swaths_are_ordered_as_well_as_by_trying_all(seed):
    n = 5
    cost = random_costs(n, seed)
    ways = list(itertools.product((0, 1), repeat=n))
    every = (2 * np.array(order) + np.array(way) for order in itertools.permutations(range(n)) for way in ways)
    least = min(tour_cost(tour, cost) for tour in every)
    found = best_tour(cost, rule_orders([np.arange(n)], [1, 2]), seed)
    assert tour_cost(found, cost) == pytest.approx(least)


@pytest.mark.parametrize("n", [1, 2, 3, 30])
def test_each_swath_is_in_the_tour_once_and_the_same_seed_gives_the_same(n):
    cost = random_costs(n, 3)
    first = rule_orders([np.arange(n)], [1])
    tour = best_tour(cost, first, 7)
    assert sorted(tour // 2) == list(range(n))
    assert tour_cost(tour, cost) <= tour_cost(first[0], cost) + 1e-9
    assert (best_tour(cost, first, 7) == tour).all()


def test_no_swaths_make_no_tour():
    assert len(best_tour(np.zeros((1, 1)), [])) == 0


@pytest.mark.parametrize("count", [1, 2, 5, 9, 16, 23])
@pytest.mark.parametrize("skip", [1, 2, 3, 8])
def test_rule_orders_go_along_every_swath(count, skip):
    (order,) = rule_orders([np.arange(count)], [skip])
    assert sorted(order // 2) == list(range(count))
