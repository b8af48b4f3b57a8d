"""What sampling planners are asked, and what they answer."""

from dataclasses import dataclass
from math import hypot, inf
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from uvf.maths.curves.segments import Triple, checked_configuration
from uvf.planning.costmap.inflation import LETHAL, MAX_NON_OBSTACLE, cost_factors
from uvf.planning.sampling.clearance import Body, ClearanceField, checked_field, is_clear
from uvf.planning.sampling.path import SamplingPath
from uvf.planning.sampling.spaces import PLANE, SteeringSpace
from uvf.planning.search.grid_search import GridSearch

Floats = NDArray[np.float64]

EVERY_WAY = np.ones((3, 3), dtype=np.int64)
STEP = 0.08  # of the field's diagonal
TURNS = 3.0  # of the turning radius
NARROW = 2.0
"""Added to the cost of a cell of the guide, at the very edge of what the body fits through."""
SMOOTH = 6  # cells over which the guide's heading is taken


class Ground(NamedTuple):
    """Where a body may be: a clearance field, and the body itself."""

    field: ClearanceField
    body: Body


@dataclass(frozen=True)
class Budget:
    """What a planner may spend: ``iterations``, the same for each run, and ``seconds`` of wall time, looked at between them."""

    iterations: int
    seconds: float = inf


@dataclass(frozen=True)
class SamplingPlan:
    """A planner's answer: the ``path``, or None and the ``reason``. ``nodes`` are those of its trees or roadmap."""

    path: SamplingPath | None
    reason: str
    nodes: int
    iterations: int

    @property
    def cost(self) -> float:
        """Length of the path [m], inf without one."""
        return self.path.length if self.path else inf


class SamplingProblem(NamedTuple):
    """What kernels need: ``step`` [m] is the longest new curve, ``weight`` [m/rad] that of a heading among neighbours.

    ``cells`` (n,) are flat indices of the cells that may be on a way, ``guide`` (m, 3) is a way over them for who needs no room to turn;
    ``draw`` samples from both.
    """

    field: ClearanceField
    body: Body
    space: SteeringSpace
    start: Triple
    goal: Triple
    step: float
    weight: float
    cells: NDArray[np.int32]
    guide: Floats


def problem(ground: Ground, space: SteeringSpace, start: Triple, goal: Triple) -> SamplingProblem | str:
    """What kernels need to find a way from ``start`` to ``goal``, or why there is none.

    start, goal: x, y [m, map frame], heading [rad]. Raises ValueError for what is not finite and a field that makes no sense.
    """
    start, goal = checked_configuration("start", start), checked_configuration("goal", goal)
    field, body = checked_field(ground.field), ground.body
    if body.radii.size == 0:
        raise ValueError("a body without discs; make one with disc(radius), discs or rectangle")
    for what, at in (("start", start), ("goal", goal)):
        if why := _fault(field, body, space, at):
            return f"the {what} {why}"
    cells = _reachable(field, body, (start, goal))
    if cells is None:
        return "no way leads to the goal: the body does not fit through, whichever way it turns"
    rows, columns = field.values.shape
    step = max(STEP * hypot(rows, columns) * field.resolution, TURNS * space.radius)
    return SamplingProblem(field, body, space, start, goal, step, space.radius, cells, _guide(field, body, space, (start, goal)))


def _fault(field: ClearanceField, body: Body, space: SteeringSpace, at: Triple) -> str:
    rows, columns = field.values.shape
    row, column = (at[1] - field.y) / field.resolution, (at[0] - field.x) / field.resolution
    if not (0 <= row < rows and 0 <= column < columns):
        return "lies outside the map"
    if space.kind == PLANE and np.ptp(body.offsets) > 0:
        raise ValueError("in the plane no heading is planned: it takes a body of one disc; or plan with dubins or reeds_shepp")
    if not is_clear(field, body, at, 1.0):
        room = float(field.values[int(row), int(column)])
        return f"is not free: the clearance there is {room:.2f} m, the body's discs need {float(body.radii.max()):.2f} m"
    return ""


def _reachable(field: ClearanceField, body: Body, ends: tuple[Triple, Triple]) -> NDArray[np.int32] | None:
    """Cells that the reference point may be on, None where no disc's centre can come from the one end to the other."""
    cells = None
    for offset, radius in zip(body.offsets.tolist(), body.radii.tolist(), strict=True):
        parts, _ = ndimage.label(field.values >= radius, EVERY_WAY)
        found = []
        for x, y, heading in ends:
            row = (y + offset * np.sin(heading) - field.y) / field.resolution
            column = (x + offset * np.cos(heading) - field.x) / field.resolution
            found.append(parts[int(row), int(column)])
        if found[0] != found[1]:
            return None
        if cells is None or offset == 0.0:
            cells = np.flatnonzero(parts == found[0] if offset == 0.0 else field.values >= 0.0)
    assert cells is not None
    return cells.astype(np.int32)


def _guide(field: ClearanceField, body: Body, space: SteeringSpace, ends: tuple[Triple, Triple]) -> Floats:
    """(m, 3) x, y [m], heading [rad] along the cheapest way over the cells; nothing where there is none.

    Ways are planned with the narrowest disc, and cost more where there is less room than the turning radius.
    """
    clearance = field.values.astype(np.float64) - body.radii.min()
    wanted = max(space.radius, 2.0 * field.resolution)
    values = (MAX_NON_OBSTACLE * np.clip(1.0 - clearance / wanted, 0.0, 1.0)).astype(np.uint8)
    values[clearance < 0.0] = LETHAL
    start, goal = ((int((y - field.y) / field.resolution), int((x - field.x) / field.resolution)) for x, y, _ in ends)
    found = GridSearch(values, cost_factors(NARROW)).astar(start, goal)
    if found is None or len(found.cells) < 2 * SMOOTH:
        return np.empty((0, 3))
    points = (found.cells[:, ::-1] + 0.5) * field.resolution + (field.x, field.y)
    along = points[SMOOTH:] - points[:-SMOOTH]
    return np.column_stack((points[SMOOTH // 2 : SMOOTH // 2 - SMOOTH], np.arctan2(along[:, 1], along[:, 0])))
