"""What the report says of a path that is too short to be laid onto its reference."""

import numpy as np

from launch.slam.scoring import against
from launch.slam.tables import reference_rows, remarks
from tests.slam.evaluation.made_log import way
from uvf.slam.evaluation.reference import Trajectory, is_alignable


def standing(seed):
    noise = np.random.default_rng(seed).normal(0.0, 0.002, (50, 3))
    return Trajectory(0.1 * np.arange(50), noise)


def figures_of(estimate, reference):
    return {"references": {"truth": {"final": against(estimate, reference)}}}


def test_of_a_rover_that_stood_no_error_of_the_rotation_is_told():
    assert not is_alignable(standing(1), standing(2))
    figures = figures_of(standing(1), standing(2))
    _, row = reference_rows(figures)["truth"]
    assert row[:3] == ("final", "absolute", "50") and row[-1] == "-"
    (line,) = remarks(figures)
    assert line.startswith("distance to truth: the path is too short to align")


def test_of_one_that_drove_it_is():
    driven = Trajectory(0.1 * np.arange(200), way(200))
    figures = figures_of(driven, driven)
    assert all(row[-1] == "0.00" for row in reference_rows(figures)["truth"][1:]) and remarks(figures) == []
