"""Whether a keyframe fits into a submap: how much of it, how well, and whether one looks through what the other sees."""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import Pose2, compose, inverse
from uvf.slam.graph.nodes import KeyframeNodes, Node, Submap
from uvf.slam.matching.cloud import Cloud
from uvf.slam.matching.imls import Match, match
from uvf.slam.matching.visibility import AGREES, THROUGH, verdicts

Floats = NDArray[np.float64]
NO_PRIOR = np.zeros((3, 3))

LEAST_SHARE, MOST_RMS = 0.6, 0.05
MOST_THROUGH = 0.15
"""Of the surfaces that the other sees, those it has looked through."""
UNSEEN = 0.01 * np.eye(3)
"""Information of what a match does not see, as the way along a fence: with a sigma of 10 m or 10 rad it tells nothing."""
FLOOR = np.diag((0.01, 0.01, 0.003)) ** 2
"""Covariance that no match is better than: objects move, floors tilt the lidar [m^2, rad^2]."""


def fitted(node: Node, cloud: Cloud, submap: Submap, nodes: KeyframeNodes, guess: Pose2) -> Match | None:
    """Match of a keyframe to a submap of ``nodes`` near ``guess`` (anchor_from_node); None where it does not fit.

    cloud: its own, or ``KeyframeNodes.gathered``.
    """
    found = match(guess, cloud, submap.surfaces, NO_PRIOR)
    if found.share < LEAST_SHARE or found.rms > MOST_RMS:
        return None
    agree, through = looks(node, submap, nodes, found.map_from_base)
    return None if through > MOST_THROUGH * (agree + through) else found


def looks(node: Node, submap: Submap, nodes: KeyframeNodes, anchor_from_node: Pose2) -> tuple[int, int]:
    """(seen, looked through): surface points that the keyframe and three of the submap's see of each other's, or look through."""
    agree = through = 0
    for m in (submap.members[0], submap.anchor, submap.members[-1]):
        member = nodes.all[m]
        member_from_node = compose(inverse(submap.anchor_from_member[m - submap.members[0]]), anchor_from_node)
        seen = (
            verdicts(node.cloud.points, member_from_node, member.rays),
            verdicts(member.cloud.points, inverse(member_from_node), node.rays),
        )
        agree += sum(int(np.count_nonzero(v == AGREES)) for v in seen)
        through += sum(int(np.count_nonzero(v == THROUGH)) for v in seen)
    return agree, through


def information_of(found: Match) -> Floats:
    """Information (3, 3) [1/m^2, 1/rad^2] of a closure by a match, no better than FLOOR allows."""
    covariance = np.linalg.inv(found.information + UNSEEN) + FLOOR
    information: Floats = np.linalg.inv(covariance)
    return information
