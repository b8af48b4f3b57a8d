"""The pose graph: what it finds, what it refuses."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.slam.graph.rings import INFORMATION, between, driven, truth
from uvf.maths.se2 import Pose2, compose
from uvf.slam.pose_graph.edges import Edge
from uvf.slam.pose_graph.linearise import Normal, chi_squares, normal_equations, residual
from uvf.slam.pose_graph.pose_graph import PoseGraph
from uvf.slam.pose_graph.robust import LIMIT

ANGLE = st.floats(-10.0, 10.0)
METRES = st.floats(-50.0, 50.0)


def dense(graph):
    """Normal matrix and gradient by numbers: central differences of the residuals of all edges."""
    rows, n = graph.edges.rows, len(graph)
    h, g = np.zeros((3 * n, 3 * n)), np.zeros(3 * n)
    weights = graph.weights
    for k, (i, j) in enumerate(rows.ends):
        jacobian = np.zeros((3, 3 * n))
        for column in [*range(3 * i, 3 * i + 3), *range(3 * j, 3 * j + 3)]:
            both = []
            for sign in (1.0, -1.0):
                poses = graph.poses.copy()
                poses.flat[column] += sign * 1e-5
                both.append(np.array(residual(poses, i, j, rows.measured[k])))
            jacobian[:, column] = (both[0] - both[1]) / 2e-5
        w = weights[k] * rows.information[k]
        h += jacobian.T @ w @ jacobian
        g += jacobian.T @ w @ np.array(residual(graph.poses, i, j, rows.measured[k]))
    return h, g


def blocks(graph):
    """The same by the compiled kernel, with a block for each edge of its own, every second kept the other way round."""
    rows, n, m = graph.edges.rows, len(graph), len(graph.edges)
    out = Normal(np.empty((n, 3, 3)), np.empty((m, 3, 3)), np.empty((n, 3)))
    flipped = np.arange(m) % 2 == 1
    cost = normal_equations(graph.poses, rows.ends, rows.measured, rows.information, graph.weights, (np.arange(m), flipped), out)
    h = np.zeros((3 * n, 3 * n))
    for k in range(n):
        h[3 * k : 3 * k + 3, 3 * k : 3 * k + 3] = np.tril(out.diagonal[k]) + np.tril(out.diagonal[k], -1).T
    for k, (i, j) in enumerate(rows.ends):
        block = out.between[k].T if flipped[k] else out.between[k]
        h[3 * i : 3 * i + 3, 3 * j : 3 * j + 3] += block
        h[3 * j : 3 * j + 3, 3 * i : 3 * i + 3] += block.T
    return h, out.gradient.ravel(), cost


@settings(max_examples=25, deadline=None)
@given(st.lists(st.tuples(METRES, METRES, ANGLE), min_size=3, max_size=3), st.integers(0, 1000))
def test_the_normal_equations_are_those_of_the_differences(poses, seed):
    graph, rng = PoseGraph(), np.random.default_rng(seed)
    for pose in poses:
        graph.add_pose(Pose2(*pose))
    for i, j in ((0, 1), (2, 1), (0, 2)):
        root = rng.normal(0.0, 1.0, (3, 3))
        near = between(graph.poses, i, j)
        graph.add_edge(Edge(i, j, compose(near, Pose2(*rng.uniform(-1.0, 1.0, 3))), root @ root.T))
    (h, g), (h_own, g_own, cost) = dense(graph), blocks(graph)
    scale = max(1.0, np.abs(h).max())
    np.testing.assert_allclose(h_own, h, atol=1e-6 * scale)
    np.testing.assert_allclose(g_own, g, atol=1e-6 * scale)
    assert cost == pytest.approx(graph.cost)


def test_a_drive_without_noise_is_found_again_to_the_last_digits():
    true = truth(40)
    graph = PoseGraph()
    rng = np.random.default_rng(1)
    for pose in true:
        graph.add_pose(Pose2(*pose))
    for i, j in [*zip(range(39), range(1, 40), strict=True), (0, 20), (5, 25), (39, 0)]:
        graph.add_edge(Edge(i, j, between(true, i, j), INFORMATION))
    graph.poses = graph.poses + np.vstack((np.zeros(3), rng.normal(0.0, 0.05, (39, 3))))
    outcome = graph.optimise(tolerance=1e-10)
    assert outcome.converged
    np.testing.assert_allclose(graph.poses, true, atol=1e-9)


def test_the_fixed_pose_does_not_move():
    true = truth(40)
    graph = driven(true, [(0, 39)], np.random.default_rng(2), fixed=7)
    before = graph.poses.copy()
    graph.optimise()
    assert (graph.poses[7] == before[7]).all()
    assert np.abs(graph.poses[30] - before[30]).max() > 1e-3


def test_true_loops_survive_ten_degrees_of_drift_and_false_ones_are_switched_off():
    true = truth(200)
    loops = [(k, k + 99) for k in range(0, 100, 10)]
    graph = driven(true, loops, np.random.default_rng(3), bend=np.radians(10.0) / 100)
    false = [graph.add_edge(Edge(i, j, Pose2(0.0, 0.0, 0.0), INFORMATION, True)) for i, j in ((20, 70), (40, 150), (10, 190))]
    graph.optimise()
    weights = graph.weights
    assert (weights[199 : 199 + len(loops)] > 0.9).all()
    assert (weights[false] == 0.0).all()
    assert (weights[:199] == 1.0).all()
    assert np.abs(graph.poses[:, :2] - true[:, :2]).max() < 0.5


FALSE = Pose2(0.0, 0.0, 0.0)


def test_a_false_loop_that_the_graph_leaves_no_room_for_changes_nothing_and_costs_little():
    true = truth(200)
    graph = driven(true, [(k, k + 99) for k in range(0, 100, 10)], np.random.default_rng(6))
    graph.optimise(tolerance=1e-9)
    before = graph.poses.copy()
    false = graph.add_edge(Edge(20, 170, FALSE, INFORMATION, True))
    outcome = graph.optimise()
    assert graph.weights[false] == 0.0
    assert not outcome.annealed
    np.testing.assert_allclose(graph.poses, before, atol=1e-6)


def test_a_single_true_loop_after_a_drift_of_three_sigma_is_believed_after_a_trial():
    true = truth(100, turns=0.97)
    graph = driven(true, [(0, 99)], np.random.default_rng(7), bend=3.0 * 0.01 / np.sqrt(100))
    assert graph.chi2[-1] > 1000.0
    outcome = graph.optimise()
    assert graph.weights[-1] == 1.0
    assert not outcome.annealed
    assert graph.chi2[-1] < 1.0


def test_a_false_loop_that_was_believed_is_given_up_when_many_speak_against_it():
    true = truth(200)
    graph = driven(true, [], np.random.default_rng(8))
    false = graph.add_edge(Edge(40, 139, compose(between(true, 40, 139), Pose2(0.6, 0.0, 0.1)), INFORMATION, True))
    graph.optimise()
    assert graph.weights[false] == 1.0
    loops = [graph.add_edge(Edge(k, k + 99, between(true, k, k + 99), INFORMATION, True)) for k in range(35, 46) if k != 40]
    graph.optimise()
    assert graph.weights[false] == 0.0
    assert (graph.weights[loops] == 1.0).all()


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 10000), st.integers(0, 12))
def test_an_optimisation_never_ends_at_a_higher_cost_than_where_it_began(seed, wrong):
    rng, true = np.random.default_rng(seed), truth(80)
    graph = driven(true, [(k, k + 39) for k in range(0, 40, 8)], rng, bend=0.002)
    for i, j in rng.integers(0, 80, (wrong, 2)):
        if i != j:
            graph.add_edge(Edge(i, j, Pose2(*rng.normal(0.0, 0.5, 3)), INFORMATION, True))

    def truncated():
        return np.where(graph.edges.rows.robust, np.minimum(graph.chi2, LIMIT), graph.chi2).sum()

    costs = [truncated()]
    for anneal in (None, True, None):
        graph.optimise(anneal)
        costs.append(truncated())
    assert (np.diff(costs) < 1e-2).all()


def test_an_edge_that_is_taken_out_no_longer_counts():
    true = truth(60)
    graph = driven(true, [(0, 59)], np.random.default_rng(4))
    odometry = graph.poses.copy()
    graph.enable(59, False)
    graph.optimise(tolerance=1e-9)
    np.testing.assert_allclose(graph.poses, odometry, atol=1e-6)
    graph.enable(59, True)
    graph.optimise()
    assert np.abs(graph.poses - odometry).max() > 1e-2


def test_a_direction_that_nothing_measures_does_not_break_the_solve():
    corridor = np.diag((0.0, 2500.0, 10000.0))
    graph = PoseGraph()
    for k in range(30):
        graph.add_pose(Pose2(k, 0.1 * (k % 2), 0.0))
    for k in range(29):
        graph.add_edge(Edge(k, k + 1, Pose2(1.0, 0.0, 0.0), corridor))
    assert graph.optimise().converged
    np.testing.assert_allclose(graph.poses[:, 0], np.arange(30), atol=1e-6)
    np.testing.assert_allclose(graph.poses[:, 1], 0.0, atol=1e-6)


def test_the_covariance_is_that_of_the_dense_inverse():
    true = truth(30)
    graph = driven(true, [(0, 15), (3, 20)], np.random.default_rng(5))
    graph.optimise(tolerance=1e-10)
    h, _ = dense(graph)
    covariance = np.zeros_like(h)
    covariance[3:, 3:] = np.linalg.inv(h[3:, 3:])
    for i, j in ((4, 25), (25, 4), (0, 12)):
        jacobian = np.zeros((3, len(h)))
        for column in [*range(3 * i, 3 * i + 3), *range(3 * j, 3 * j + 3)]:
            both = []
            for sign in (1.0, -1.0):
                poses = graph.poses.copy()
                poses.flat[column] += sign * 1e-5
                both.append(np.array(residual(poses, i, j, np.zeros(3))))
            jacobian[:, column] = (both[0] - both[1]) / 2e-5
        np.testing.assert_allclose(graph.relative_covariance(i, j), jacobian @ covariance @ jacobian.T, rtol=1e-4, atol=1e-10)


def test_the_covariances_of_all_poses_at_once_are_those_of_each():
    graph = driven(truth(60), [(0, 29), (10, 40), (3, 55)], np.random.default_rng(9))
    graph.optimise()
    for i in (0, 17, 59):
        every = graph.covariances_from(i)
        for j in (0, 5, 17, 40, 59):
            np.testing.assert_allclose(every[j], graph.relative_covariance(i, j), rtol=1e-6, atol=1e-12)


def test_covariances_follow_what_was_added_since():
    true = truth(60)
    graph = driven(true, [], np.random.default_rng(10))
    graph.optimise()
    before = graph.relative_covariance(0, 59)
    graph.add_edge(Edge(0, 59, between(true, 0, 59), INFORMATION))
    assert np.linalg.eigvalsh(before - graph.relative_covariance(0, 59)).min() > 0.0
    assert np.linalg.eigvalsh(graph.relative_covariance(0, 59)).max() < 1.0 / 2500.0


def test_the_chain_gives_the_covariance_of_odometry_and_never_less_than_the_graph():
    true = truth(60)
    graph = driven(true, [], np.random.default_rng(11))
    for i, j in ((0, 1), (2, 40), (40, 2), (59, 0)):
        np.testing.assert_allclose(graph.chain_covariance(i, j), graph.relative_covariance(i, j), rtol=1e-3, atol=1e-9)
    graph.add_edge(Edge(10, 40, between(true, 10, 40), INFORMATION, True))
    graph.optimise()
    for i, j in ((0, 30), (2, 40), (40, 2), (59, 0)):
        assert np.linalg.eigvalsh(graph.chain_covariance(i, j) - graph.relative_covariance(i, j)).min() > -1e-6
    graph.enable(20, False)
    with pytest.raises(ValueError, match="no trusted edge from pose 20 to 21"):
        graph.chain_covariance(2, 40)


def test_a_covariance_of_a_pose_that_is_not_there_is_refused():
    graph = driven(truth(5), [], np.random.default_rng(12))
    for ask in (graph.relative_covariance, graph.chain_covariance):
        with pytest.raises(ValueError, match="no pose 5; there are 5"):
            ask(0, 5)
    with pytest.raises(ValueError, match="no pose -1"):
        graph.covariances_from(-1)


def test_headings_wrap():
    graph = PoseGraph()
    graph.add_pose(Pose2(0.0, 0.0, 3.1))
    graph.add_pose(Pose2(-1.0, 0.0, -3.1))
    edge = Edge(0, 1, Pose2(1.0, 0.0, 2 * np.pi - 6.2 - 4 * np.pi), INFORMATION)
    graph.add_edge(edge)
    rows = graph.edges.rows
    assert chi_squares(graph.poses, rows.ends, rows.measured, rows.information)[0] < 2500.0 * 0.05**2
    graph.optimise()
    assert graph.chi2[0] == pytest.approx(0.0, abs=1e-9)
    assert abs(graph.poses[1, 2] + 3.1) < 0.2


@pytest.mark.parametrize(
    ("edge", "line"),
    [
        (Edge(0, 5, Pose2(0, 0, 0), np.eye(3)), "edge 0 -> 5: no pose 5; there are 2"),
        (Edge(1, 1, Pose2(0, 0, 0), np.eye(3)), "edge 1 -> 1: a pose is not measured from itself"),
        (Edge(0, 1, Pose2(np.nan, 0, 0), np.eye(3)), "edge 0 -> 1: a number that is not finite"),
        (Edge(0, 1, Pose2(0, 0, 0), np.diag((1.0, 1.0, np.inf))), "edge 0 -> 1: a number that is not finite"),
        (Edge(0, 1, Pose2(0, 0, 0), np.zeros((3, 3))), "no inverse covariance"),
        (Edge(0, 1, Pose2(0, 0, 0), np.diag((1.0, 1.0, -1.0))), "no inverse covariance"),
        (Edge(0, 1, Pose2(0, 0, 0), np.triu(np.ones((3, 3)))), "not symmetric"),
        (Edge(0, 1, Pose2(0, 0, 0), np.eye(2)), "not (3, 3)"),
    ],
)
def test_what_is_no_measurement_is_refused_in_one_line(edge, line):
    graph = PoseGraph()
    graph.add_pose(Pose2(0, 0, 0))
    graph.add_pose(Pose2(1, 0, 0))
    with pytest.raises(ValueError) as refused:
        graph.add_edge(edge)
    assert line in str(refused.value)
    assert "\n" not in str(refused.value)
    assert len(graph.edges) == 0


def test_a_graph_without_edges_stays_where_it_is():
    graph = PoseGraph()
    with pytest.raises(ValueError, match="no pose 0; there are 0"):
        graph.optimise()
    for x in (1.0, 2.0):
        graph.add_pose(Pose2(x, 0.0, 0.0))
        assert graph.optimise().converged
    assert graph.poses[:, 0].tolist() == [1.0, 2.0]
    assert np.isfinite(graph.relative_covariance(0, 1)).all()


def test_two_parts_that_nothing_joins_are_settled_each():
    true = truth(40)
    graph = driven(true, [(0, 19), (20, 39)], np.random.default_rng(13))
    graph.enable(19, False)
    assert graph.optimise().converged
    assert np.abs(graph.chi2[[39, 40]]).max() < LIMIT
    assert np.isfinite(graph.poses).all()


def test_poses_that_are_not_finite_are_refused():
    graph = PoseGraph()
    with pytest.raises(ValueError, match="not finite"):
        graph.add_pose(Pose2(0.0, np.inf, 0.0))
    graph.add_pose(Pose2(0.0, 0.0, 0.0))
    with pytest.raises(ValueError, match=r"\(1, 3\)"):
        graph.poses = np.zeros((2, 3))
