"""The exact cellular decomposition of a field along a direction: cells without holes that are swept back and forth.

Boustrophedon cells, Choset, "Coverage of known spaces: the boustrophedon cellular decomposition", Autonomous Robots 9 (2000): a line
along the swaths sweeps over the field; where the number of pieces that it is cut into changes, cells end and begin.
"""

import itertools
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from uvf.planning.coverage.strips import rotated

Floats = NDArray[np.float64]
Span = tuple[float, float]


@dataclass
class Cell:
    """One cell: ``levels`` (k,) [m] across the swaths, from the right of their direction to its left, and its ``left`` and ``right`` sides.

    left, right: (k,) [m] along the swaths' direction, at each level. neighbours: indices of the cells that touch it.
    """

    levels: list[float] = field(default_factory=list)
    left: list[float] = field(default_factory=list)
    right: list[float] = field(default_factory=list)
    neighbours: set[int] = field(default_factory=set)

    @property
    def area(self) -> float:
        """Area [m^2]."""
        return float(np.trapezoid(np.subtract(self.right, self.left), self.levels))

    def outline(self, direction: float) -> Floats:
        """Corners (2 k, 2) [m], east and north, for swaths in ``direction`` [rad]."""
        corners = np.array([*zip(self.left, self.levels, strict=True), *zip(self.right[::-1], self.levels[::-1], strict=True)])
        return rotated(np.hstack((corners, corners)), direction)[:, :2]

    def span(self, level: float) -> Span | None:
        """From where to where [m] the cell reaches at a level [m]; None outside of it."""
        if not self.levels[0] <= level <= self.levels[-1]:
            return None
        return float(np.interp(level, self.levels, self.left)), float(np.interp(level, self.levels, self.right))


def decompose(edges: Floats, direction: float) -> list[Cell]:
    """The boustrophedon cells of a field with ``edges`` (m, 4) [m] for swaths in ``direction`` [rad]; they cover it without overlap."""
    turned = rotated(edges, -direction)
    levels = np.unique(turned[:, 1::2])
    cells: list[Cell] = []
    above: list[tuple[int, Span]] = []
    for low, high in itertools.pairwise(levels.tolist()):
        spans = _spans(turned, low, high)
        following: list[tuple[int, Span]] = []
        touching = [[k for k, (_, span) in enumerate(above) if _touch(span, begin)] for begin, _ in spans]
        for number, (begin, end) in enumerate(spans):
            olds = touching[number]
            is_same = len(olds) == 1 and sum(olds[0] in other for other in touching) == 1
            if is_same:
                index = above[olds[0]][0]
            else:
                index = len(cells)
                cells.append(Cell([low], [begin[0]], [begin[1]]))
                for old in (above[k][0] for k in olds):
                    cells[index].neighbours.add(old)
                    cells[old].neighbours.add(index)
            _extend(cells[index], low, begin)
            _extend(cells[index], high, end)
            following.append((index, end))
        above = following
    return cells


def _spans(edges: Floats, low: float, high: float) -> list[tuple[Span, Span]]:
    """What of the field lies between two neighbouring levels: from where to where it reaches at the lower and at the upper one."""
    middle = (low + high) / 2
    crossing = edges[(edges[:, 1] > middle) != (edges[:, 3] > middle)]
    slope = (crossing[:, 2] - crossing[:, 0]) / (crossing[:, 3] - crossing[:, 1])
    at = [crossing[:, 0] + slope * (y - crossing[:, 1]) for y in (low, middle, high)]
    order = np.argsort(at[1], kind="stable")
    x0, x1 = at[0][order].tolist(), at[2][order].tolist()
    return [((x0[k], x0[k + 1]), (x1[k], x1[k + 1])) for k in range(0, len(order) - 1, 2)]


def _touch(one: Span, other: Span) -> bool:
    """Whether they have more than a point in common."""
    return min(one[1], other[1]) - max(one[0], other[0]) > 1e-9 * max(1.0, one[1] - one[0])


def _extend(cell: Cell, level: float, span: Span) -> None:
    if (cell.levels[-1], cell.left[-1], cell.right[-1]) != (level, *span):
        cell.levels.append(level)
        cell.left.append(span[0])
        cell.right.append(span[1])


def visiting_order(cells: list[Cell]) -> list[int]:
    """All cells, each as near as the neighbourhood allows to the one before: depth first, as Choset visits them."""
    seen: list[int] = []
    for first in range(len(cells)):
        waiting = [first]
        while waiting:
            cell = waiting.pop()
            if cell not in seen:
                seen.append(cell)
                waiting += sorted(cells[cell].neighbours - set(seen), reverse=True)
    return seen
