"""What agrees with what, and what is the same seen from the other side."""

import numpy as np
import pytest

from tests.slam.merging.offices import anne, bert
from uvf.maths.se2 import Pose2, compose, inverse
from uvf.slam.graph.loops import Closure
from uvf.slam.merging.confirmation import confirmed_part
from uvf.slam.merging.consistency import agreement, largest_clique
from uvf.slam.merging.crossing import the_other_way_round
from uvf.slam.merging.headings import FACES, facing, likely
from uvf.slam.merging.part import VehicleMap

INFORMATION = np.diag((2500.0, 2500.0, 40000.0))


def part_of(session):
    part = VehicleMap("anne")
    part.follow(session)
    return part


@pytest.fixture(scope="module")
def parts():
    return part_of(anne().session), part_of(bert().session)


def right(parts, i, j):
    """The closure between two keyframes by the truth."""
    a, b = parts
    a_from_j = compose(anne().map_from(bert()), b.nodes.poses[j])
    return Closure(i, j, compose(inverse(a.nodes.poses[i]), a_from_j), INFORMATION, 1.0)


def shifted(closure, x, yaw=0.0):
    return Closure(closure.i, closure.j, compose(Pose2(x, 0.0, yaw), closure.i_from_j), closure.information, 1.0)


def test_right_closures_agree_and_wrong_ones_do_not(parts):
    closures = [right(parts, i, j) for i, j in ((20, 30), (60, 70), (100, 90))]
    closures += [shifted(right(parts, 40, 50), 2.0), shifted(right(parts, 80, 80), 0.0, 0.3)]
    agree = agreement(closures, *parts)
    assert agree[:3, :3].sum() == 6
    assert not agree[3:].any()
    assert largest_clique(agree) == [0, 1, 2]


def test_a_keyframe_is_in_one_place_only(parts):
    assert not agreement([right(parts, 20, 30), right(parts, 21, 30)], *parts).any()


def test_the_largest_set_wins_though_others_agree_with_more():
    agree = np.zeros((9, 9), dtype=bool)
    for a, b in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3), *((4, k) for k in range(5, 9)), (4, 0)]:
        agree[a, b] = agree[b, a] = True
    assert largest_clique(agree) == [0, 1, 2, 3]
    assert largest_clique(np.zeros((0, 0), dtype=bool)) == []


def test_the_other_way_round_is_the_inverse_with_its_covariance():
    rng = np.random.default_rng(2)
    root = rng.normal(size=(3, 3))
    closure = Closure(3, 7, Pose2(1.2, -0.7, 0.9), root @ root.T + np.eye(3), 1.0)
    back = the_other_way_round(closure)
    assert (back.i, back.j) == (7, 3)
    assert compose(closure.i_from_j, back.i_from_j) == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)
    samples = rng.multivariate_normal(np.zeros(3), 1e-6 * np.linalg.inv(closure.information), 20000)
    inverses = np.array([inverse(Pose2(*(np.array(closure.i_from_j) + off).tolist())) for off in samples])
    assert np.cov(inverses.T) == pytest.approx(1e-6 * np.linalg.inv(back.information), rel=0.1, abs=2e-8)


def test_what_is_confirmed_counts_along_the_direction_with_the_least():
    walls, ends = np.outer((0.0, 1.0), (0.0, 1.0)), np.outer((1.0, 0.0), (1.0, 0.0))
    assert confirmed_part(100 * walls + 10 * ends, 98 * walls + 3 * ends) == pytest.approx(0.3)
    assert confirmed_part(100 * walls, 100 * walls) == 0.0


def test_headings_are_those_at_which_walls_are_parallel():
    room = np.repeat(np.array(((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0))), (90, 90, 10, 10), axis=0)
    turns = np.radians(np.arange(-180.0, 180.0, 2.0))
    found = np.degrees(likely(turns, facing(room, 0.5), facing(room)))
    away = (found - np.degrees(0.5) + 90.0) % 180.0 - 90.0
    assert np.abs(away).max() < 15.0 and np.abs(away).min() < 2.0
    assert len(likely(turns, np.ones(FACES), facing(room))) == len(turns)
