"""Errors of relations against figures worked out by hand and by matrices."""

from math import pi, radians, sqrt

import numpy as np
import pytest

from uvf.maths.se2_arrays import composed, inverted, steps
from uvf.models.yaml_data import BadInput
from uvf.slam.evaluation.relations import Relations, Statistics, index_of, read_relations, relation_errors, relation_scores


def matrix(pose):
    c, s = np.cos(pose[2]), np.sin(pose[2])
    return np.array(((c, -s, pose[0]), (s, c, pose[1]), (0.0, 0.0, 1.0)))


def one(known, first, second, apart=1.0):
    relations = Relations(np.array([[0.0, apart]]), np.array([known], dtype=float))
    return relation_errors(relations, np.array([0.0, apart]), np.array([first, second], dtype=float))


def test_arrays_of_poses_compose_as_matrices_do():
    rng = np.random.default_rng(1)
    a, b = rng.uniform(-4, 4, (20, 3)), rng.uniform(-4, 4, (20, 3))
    for p, q, c, i in zip(a, b, composed(a, b), inverted(a), strict=True):
        assert matrix(c) == pytest.approx(matrix(p) @ matrix(q))
        assert matrix(i) == pytest.approx(np.linalg.inv(matrix(p)))
    assert steps(np.cumsum(np.full((3, 3), (1.0, 0.0, 0.0)), axis=0)) == pytest.approx(np.full((2, 3), (1.0, 0.0, 0.0)))


def test_a_trajectory_that_agrees_has_no_error():
    errors = one((1.0, 0.0, pi / 2), (5.0, 5.0, pi / 2), (5.0, 6.0, pi))
    assert errors.freiburg_translation == pytest.approx(0.0, abs=1e-12)
    assert errors.cartographer_translation == pytest.approx(0.0, abs=1e-12)
    assert errors.rotation == pytest.approx(0.0, abs=1e-12)


def test_the_two_formulas_differ_where_the_heading_is_off():
    """10 m ahead by the relation, and so it is, but turned by 1 deg: nothing by parts, 10 m times a degree by Cartographer."""
    errors = one((10.0, 0.0, 0.0), (0.0, 0.0, 0.0), (10.0, 0.0, radians(1.0)))
    assert errors.freiburg_translation == pytest.approx(0.0)
    assert errors.cartographer_translation == pytest.approx(2 * 10.0 * np.sin(radians(0.5)))
    assert np.degrees(errors.rotation) == pytest.approx(1.0)


def test_translations_off_by_parts_are_off_by_their_hypotenuse():
    errors = one((1.0, 1.0, 0.0), (0.0, 0.0, 0.0), (1.3, 1.4, 0.0))
    assert errors.freiburg_translation == pytest.approx(0.5)
    assert errors.cartographer_translation == pytest.approx(0.5)


def test_headings_are_compared_round_the_circle():
    assert one((0, 0, radians(179.0)), (0, 0, 0), (0, 0, radians(-179.0))).rotation == pytest.approx(radians(2.0))


def test_cartographers_formula_is_the_product_of_matrices():
    rng = np.random.default_rng(2)
    poses, known = rng.uniform(-3, 3, (30, 3)), rng.uniform(-3, 3, (29, 3))
    stamps = np.arange(30.0)
    found = relation_errors(Relations(np.column_stack((stamps[:-1], stamps[1:])), known), stamps, poses)
    for i, k in enumerate(known):
        e = np.linalg.inv(matrix(poses[i])) @ matrix(poses[i + 1]) @ np.linalg.inv(matrix(k))
        assert found.cartographer_translation[i] == pytest.approx(sqrt(e[0, 2] ** 2 + e[1, 2] ** 2))
        assert found.rotation[i] == pytest.approx(abs(np.arctan2(e[1, 0], e[0, 0])))


def test_stamps_are_found_to_the_microsecond_and_need_no_order():
    stamps = np.array([976052857.337284, 976052858.0, 976052857.5])
    assert index_of(stamps, np.array([[976052857.5, 976052857.337284], [976052857.500001, 976052858.0]])).tolist() == [[2, 0], [-1, 1]]


def test_relations_without_a_pose_do_not_count():
    relations = Relations(np.array([[0.0, 1.0], [1.0, 7.0]]), np.zeros((2, 3)))
    scores = relation_scores(relation_errors(relations, np.array([0.0, 1.0]), np.zeros((2, 3))))
    assert scores["all"].rotation.number == 1
    assert scores["far"].rotation.number == 0
    assert np.isnan(scores["far"].rotation.mean)


def test_near_and_far_pairs_are_kept_apart():
    stamps = np.array([0.0, 10.0, 30.0])
    relations = Relations(np.array([[0.0, 10.0], [30.0, 0.0]]), np.zeros((2, 3)))
    scores = relation_scores(relation_errors(relations, stamps, np.array([[0, 0, 0], [0.1, 0, 0], [0, 0.7, 0]], dtype=float)))
    assert scores["near"].freiburg_translation.mean == pytest.approx(0.1)
    assert scores["far"].freiburg_translation.mean == pytest.approx(0.7)
    assert (scores["near"].gross, scores["far"].gross, scores["all"].gross) == (0, 1, 1)


def test_statistics_by_hand():
    s = Statistics.of(np.array([1.0, 2.0, 3.0, 10.0]))
    assert s == pytest.approx((4, 4.0, sqrt(50.0 / 3.0), 28.5, 2.5, 8.95, 10.0))
    assert Statistics.of(np.array([2.0])).std == 0.0


def test_a_relations_file_is_read_and_a_broken_line_is_named(tmp_path):
    path = tmp_path / "made.relations"
    path.write_text("# stamps and motions\n1.5 2.5 0.1 -0.2 0 0 0 7.0\n\n")
    relations = read_relations(path)
    assert relations.stamps.tolist() == [[1.5, 2.5]]
    assert relations.first_from_second[0] == pytest.approx((0.1, -0.2, 7.0 - 2 * pi))
    for bad in ("1 2 3", "1 2 x 0 0 0 0 0", "1 2 nan 0 0 0 0 0"):
        path.write_text(f"1.5 2.5 0.1 -0.2 0 0 0 7.0\n{bad}\n")
        with pytest.raises(BadInput, match=r"made\.relations:2"):
            read_relations(path)
    path.write_text("")
    with pytest.raises(BadInput, match="holds none"):
        read_relations(path)
