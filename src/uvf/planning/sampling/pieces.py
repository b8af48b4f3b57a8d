"""From the curves of a tree's nodes to a path."""

import itertools
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.curves.segments import Triple, moved
from uvf.planning.sampling.path import SamplingPath
from uvf.planning.sampling.spaces import SteeringSpace, leaving
from uvf.planning.sampling.tree import CurveTree, node

Floats = NDArray[np.float64]


@compiled
def pieces_of(start: Triple, segments: Floats) -> Floats:
    """Pieces (k, 5), as in ``SamplingPath``, of segments (k, 2) from ``start``."""
    out = np.empty((segments.shape[0], 5))
    x, y, heading = start
    for k in range(segments.shape[0]):
        out[k] = (x, y, heading, segments[k, 0], segments[k, 1])
        x, y, heading = moved(x, y, heading, segments[k, 1], segments[k, 0])
    return out


@compiled
def driven_back(pieces: Floats) -> Floats:
    """The way back over pieces (n, 5), looking the other way: a turn to the left is one to the right."""
    out = np.empty_like(pieces)
    n = pieces.shape[0]
    for k in range(n):
        x, y, heading, length, curvature = pieces[n - 1 - k]
        x, y, heading = moved(x, y, heading, curvature, length)
        out[k] = (x, y, heading - np.pi, length, -curvature)
    return out


def pieces_there(grown: CurveTree, nodes: Sequence[int], space: SteeringSpace) -> Floats:
    """Pieces (n, 5) of the way from node to node."""
    parts = [np.empty((0, 5))]
    for before, after in itertools.pairwise(nodes):
        start = leaving(space, node(grown, before), node(grown, after))
        parts.append(pieces_of(start, grown.curves[after]))
    return np.vstack(parts)


def pieces_back(grown: CurveTree, nodes: Sequence[int], space: SteeringSpace) -> Floats:
    """Pieces (n, 5) of the way back over nodes of a tree that looks the other way."""
    return driven_back(pieces_there(grown, nodes, space))


def joined(parts: Sequence[Floats], end: Triple) -> SamplingPath:
    """The path of all pieces that have a length, with its ``end``."""
    pieces = np.vstack(parts)
    return SamplingPath(pieces[pieces[:, 3] != 0.0], end)
