"""Keyframes of one session that fit into submaps of another."""

import numpy as np

from uvf.maths.se2 import Pose2, compose, inverse
from uvf.slam.graph.fitting import MOST_THROUGH, fitted, information_of, looks
from uvf.slam.graph.loops import Closure
from uvf.slam.matching.everywhere import Floor, all_turns, everywhere
from uvf.slam.merging.confirmation import confirmed_part, of_place
from uvf.slam.merging.headings import facing, likely
from uvf.slam.merging.part import SIGMA, VehicleMap

LEAST_SCORE, RIVAL, MOST_PLACES = 0.6, 0.85, 4
CONFIRMED = 0.75
"""Part of what either tells of the place that the other must confirm: ``confirmation``."""


def searched(a: VehicleMap, b: VehicleMap, j: int) -> list[Closure]:
    """Closures where what b has seen around its keyframe j fits into session a: several where places look alike."""
    points = b.query(j)
    turns = likely(all_turns(points, SIGMA), a.facing, facing(b.nodes.submap(j).surfaces.table[1]))
    places = everywhere(points, turns, a.field, Floor(a.near, LEAST_SCORE, RIVAL, MOST_PLACES))
    found = [fit(a, b, j, place.pose) for place in places]
    return [closure for closure in found if closure is not None]


def fit(a: VehicleMap, b: VehicleMap, j: int, a_from_j: Pose2) -> Closure | None:
    """Closure of keyframe j of b and the submap of a nearest to its believed pose in the map of a; None where it does not fit.

    The score is the part of it that is confirmed.
    """
    i = a.nodes.nearest(a_from_j)
    submap, node = a.nodes.submap(i), b.nodes.all[j]
    found = fitted(node, b.nodes.gathered(j), submap, a.nodes, compose(inverse(a.nodes.poses[i]), a_from_j))
    if found is None:
        return None
    agree, through = _seen_around(a, i, b, j, found.map_from_base)
    if through > MOST_THROUGH * (agree + through):
        return None
    confirmed = confirmed_part(*of_place(a, i, b, j, found.map_from_base))
    return Closure(i, j, found.map_from_base, information_of(found), confirmed) if confirmed > CONFIRMED else None


def _seen_around(a: VehicleMap, i: int, b: VehicleMap, j: int, i_from_j: Pose2) -> tuple[int, int]:
    """Surface points that the keyframes around i and those before and after j see of each other's, and those they look through."""
    agree = through = 0
    others, submap = b.nodes.submap(j), a.nodes.submap(i)
    for m in (others.members[0], others.members[-1]):
        j_from_member = others.anchor_from_member[m - others.members[0]]
        more = looks(b.nodes.all[m], submap, a.nodes, compose(i_from_j, j_from_member))
        agree, through = agree + more[0], through + more[1]
    return agree, through


def the_other_way_round(closure: Closure) -> Closure:
    """The closure with i and j exchanged."""
    j_from_i = inverse(closure.i_from_j)
    c, s = np.cos(j_from_i.yaw), np.sin(j_from_i.yaw)
    by = np.array(((-c, s, j_from_i.y), (-s, -c, -j_from_i.x), (0.0, 0.0, -1.0)))  # of (x, y, yaw) of j_from_i by that of i_from_j
    back = np.linalg.inv(by)
    return Closure(closure.j, closure.i, j_from_i, back.T @ closure.information @ back, closure.score)
