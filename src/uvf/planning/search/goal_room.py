"""Whether a vehicle that only drives forwards has room to come to its goal at all: a look back from there.

A search from the start finds that out last, when it has been everywhere.
"""

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.planning.costmap.headings import HEADINGS, heading_bin
from uvf.planning.search.hybrid_expansion import Question
from uvf.planning.search.motion_primitives import Moves
from uvf.planning.search.pose_check import PoseCheck, price_at

Floats = NDArray[np.float64]
Slots = NDArray[np.int32]

ENOUGH = 1_500
"""States from which the goal can be reached, at which the look back ends."""


@compiled
def states_before(check: PoseCheck, ask: Question, back: Moves, slots: tuple[Slots, int], queue: Floats) -> int:
    """How many states lead to the goal, counted no further than ``queue`` (n, 3) holds; ``back``: the primitives driven backwards.

    slots: the table of states and a number above all in it; that number is what the states have then.
    """
    slot, mark = slots
    rows, columns = check.values.shape
    last, p = back.shape.shape[2] - 1, back.length.size
    queue[0, 0], queue[0, 1], queue[0, 2] = ask.goal
    count, done, room = 1, 0, queue.shape[0]
    while done < count < room:
        x0, y0, k = queue[done, 0], queue[done, 1], heading_bin(queue[done, 2])
        done += 1
        for move in range(p):
            x, y = x0 + back.shape[k, move, last, 0], y0 + back.shape[k, move, last, 1]
            if count >= room or not (0.0 <= x < columns and 0.0 <= y < rows):
                continue
            state = (int(y) * columns + int(x)) * HEADINGS + ((k + back.turn[move]) & (HEADINGS - 1))
            if slot[state] == mark:
                continue
            free = True
            for i in range(last + 1):
                if (
                    price_at(check, x0 + back.shape[k, move, i, 0], y0 + back.shape[k, move, i, 1], back.shape[k, move, i, 2], ask.margin)
                    < 0.0
                ):
                    free = False
                    break
            if free:
                slot[state] = mark
                queue[count, 0], queue[count, 1], queue[count, 2] = x, y, back.shape[k, move, last, 2]
                count += 1
    return count
