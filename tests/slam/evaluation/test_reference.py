"""Trajectory errors against figures worked out by hand and by another way."""

from math import pi, radians

import numpy as np
import pytest
from scipy.optimize import minimize

from tests.slam.evaluation.made_log import made_log, way
from uvf.maths.alignment import aligned
from uvf.maths.se2_arrays import composed
from uvf.models.yaml_data import BadInput
from uvf.slam.evaluation.beside import beside
from uvf.slam.evaluation.reference import Trajectory, absolute_error, paired, read_trajectory, relative_error


def over(poses, period=0.1):
    return Trajectory(period * np.arange(len(poses)), np.asarray(poses, dtype=float))


def test_no_other_motion_lays_the_points_closer():
    rng = np.random.default_rng(1)
    a, b = rng.normal(size=(2, 40, 2))
    best = np.array(aligned(a, b))

    def cost(a_from_b):
        return np.square(composed(np.array(a_from_b), np.column_stack((b, np.zeros(40))))[:, :2] - a).sum()

    found = minimize(cost, best + 0.3, method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12}).x
    assert best == pytest.approx(found, abs=1e-5)


def test_a_trajectory_in_another_frame_has_no_absolute_error():
    truth = way(200)
    estimate = composed(np.array((5.0, -3.0, 2.0)), truth)
    error = absolute_error(over(estimate), over(truth))
    assert error.number == 200
    assert (error.rmse, error.max, error.rotation_rmse) == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)


def test_absolute_error_by_hand():
    """Two points 2 m apart, seen 3 m apart: the alignment leaves half a metre at either end."""
    error = absolute_error(over([(0, 0, 0), (3, 0, 0)]), over([(10, 5, pi / 2), (10, 7, pi / 2)]))
    assert (error.rmse, error.mean, error.max) == pytest.approx((0.5, 0.5, 0.5))
    assert error.rotation_rmse == pytest.approx(0.0, abs=1e-6)


def test_relative_error_by_hand():
    """Straight on in steps of half a metre; the estimate takes each for 1 % longer and turns by 0.2 deg."""
    truth = np.column_stack((0.5 * np.arange(41), np.zeros((41, 2))))
    step, poses = np.array((0.505, 0.0, radians(0.2))), [np.zeros(3)]
    for _ in range(40):
        poses.append(composed(poses[-1], step))
    per_metre, per_ten = (relative_error(over(poses), over(truth), d) for d in (1.0, 10.0))
    assert per_metre.number == 39
    assert per_metre.rotation_rmse == pytest.approx(0.4)
    assert per_metre.mean == pytest.approx(np.hypot(0.01, 0.505 * radians(0.2)), rel=0.01)
    assert per_ten.number == 21
    assert per_ten.rotation_rmse == pytest.approx(4.0)


def test_poses_pair_with_the_nearest_in_time_or_not_at_all():
    reference = Trajectory(np.array([0.0, 1.0, 2.0]), np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0)], dtype=float))
    estimate = Trajectory(np.array([0.96, 1.04, 1.5, 2.04, 9.0]), np.zeros((5, 3)))
    assert paired(estimate, reference)[1][:, 0].tolist() == [1.0, 1.0, 2.0]
    with pytest.raises(BadInput, match="1 poses within"):
        absolute_error(Trajectory(np.array([0.0, 0.5]), np.zeros((2, 3))), Trajectory(np.array([0.0]), np.zeros((1, 3))))


def test_a_way_that_is_too_short_has_no_relative_error():
    error = relative_error(over(way(5)), over(way(5)), 10.0)
    assert error.number == 0
    assert np.isnan(error.rmse)


def test_trajectories_are_read_in_both_forms_and_broken_lines_are_named(tmp_path):
    path = tmp_path / "made_poses.txt"
    path.write_text("# a comment\n2 1 0 0.5\n1 0.5 0.25 0\n")
    assert read_trajectory(path).stamps.tolist() == [1.0, 2.0]
    path.write_text("1 0.5 0.25 0 0 0 0.7071067811865476 0.7071067811865476\n")
    assert read_trajectory(path).world_from_base[0] == pytest.approx((0.5, 0.25, pi / 2))
    path.write_text("1 0.5 0.25 0 0 0 0.35 0.35\n")
    assert read_trajectory(path).world_from_base[0] == pytest.approx((0.5, 0.25, pi / 2))
    for bad in ("1 2 3", "1 2 3 x", "1 2 3 nan"):
        path.write_text(f"0 0 0 0\n{bad}\n")
        with pytest.raises(BadInput, match=r"made_poses\.txt:2"):
            read_trajectory(path)
    path.write_text("\n")
    with pytest.raises(BadInput, match="holds no pose"):
        read_trajectory(path)


def test_what_lies_beside_a_log_counts_if_it_is_about_it(tmp_path):
    log, path = made_log(), tmp_path / "made.clf"
    relation = "{:.6f} {:.6f} 0 0 0 0 0 0\n"
    (tmp_path / "made.relations").write_text(relation.format(*log.stamps[:2]))
    (tmp_path / "another.relations").write_text(relation.format(log.stamps[2], log.stamps[0]))
    (tmp_path / "foreign.relations").write_text(relation.format(1.0, 2.0))
    (tmp_path / "made.gmapping_poses.txt").write_text(f"{log.stamps[5]:.6f} 0 0 0\n")
    (tmp_path / "index_poses.txt").write_text("0 0 0 0\n1 0 0 0\n")
    found = beside(path, log)
    assert list(found.relations) == ["made.relations", "another.relations"]
    assert list(found.references) == ["made.gmapping_poses.txt"]
    assert found.notes == ()


def test_what_lies_beside_a_log_and_cannot_be_read_ends_nothing_and_is_told(tmp_path):
    log = made_log()
    (tmp_path / "made.relations").write_text(f"{log.stamps[0]:.6f} {log.stamps[1]:.6f} 0 0 0 0 0 0\n")
    (tmp_path / "other.relations").write_text("hello\n")
    (tmp_path / "my_poses.txt").write_text("my notes on poses\n")
    found = beside(tmp_path / "made.clf", log)
    assert (list(found.relations), list(found.references)) == (["made.relations"], [])
    assert [note.split(":1:")[0].rpartition("/")[2] for note in found.notes] == ["other.relations", "my_poses.txt"]
