"""Bad starts: headings first, and the way down from far away."""

import numpy as np

from tests.slam.graph.rings import driven, truth
from uvf.slam.pose_graph.descent import descend, heading_first
from uvf.slam.pose_graph.linear import LinearSystem


def closed(seed, n=120):
    """A graph at its optimum, and its linear system."""
    graph = driven(truth(n), [(k, k + 59) for k in range(0, 60, 6)], np.random.default_rng(seed))
    graph.optimise(tolerance=1e-9)
    rows = graph.edges.rows
    return graph, LinearSystem(n, rows, rows.enabled, 0), np.ones(len(graph.edges))


def test_headings_first_comes_near_the_optimum_from_positions_that_mean_nothing():
    graph, system, weights = closed(1)
    start = graph.poses.copy()
    start[1:, :2] = np.random.default_rng(2).uniform(-50.0, 50.0, (119, 2))
    start[1:, 2] += np.random.default_rng(3).normal(0.0, 0.5, 119)
    found = heading_first(system, start, weights)
    assert np.abs(found - graph.poses).max() < 0.2
    assert (found[0] == start[0]).all()


def test_headings_first_leaves_alone_what_nothing_ties():
    graph, _, weights = closed(4)
    rows = graph.edges.rows
    cut = rows.enabled & (rows.ends.max(axis=1) < 100)
    system = LinearSystem(120, rows, cut, 0)
    found = heading_first(system, graph.poses.copy(), weights)
    np.testing.assert_allclose(found[100:], graph.poses[100:], atol=1e-9)


def test_a_descent_ends_at_the_optimum_from_a_start_that_gauss_newton_climbs_from():
    graph, system, weights = closed(5)
    start = graph.poses.copy()
    start[1:] += np.random.default_rng(6).normal(0.0, (5.0, 5.0, 0.8), (119, 3))
    down = descend(system, start, weights, (60, 1e-8))
    assert down.converged
    np.testing.assert_allclose(down.poses[:, :2], graph.poses[:, :2], atol=1e-5)


def test_steps_that_lead_nowhere_are_damped_until_the_cost_falls():
    """Headings turned by up to nearly half a turn: which way to turn them back is lost, and a minimum nearby is all there is to find."""
    graph, system, weights = closed(7)
    start = graph.poses.copy()
    start[1:, 2] += np.random.default_rng(8).uniform(-3.0, 3.0, 119)
    before = system.linearise(start, weights)
    down = descend(system, start, weights, (40, 1e-8))
    assert system.linearise(down.poses, weights) < 0.2 * before
