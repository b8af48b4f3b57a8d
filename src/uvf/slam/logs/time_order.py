"""In which order the lines of a log were taken, and times that rise with it."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import isotonic_regression

from uvf.maths.se2_arrays import steps
from uvf.slam.logs.jumps import FARTHEST

Floats = NDArray[np.float64]

LEVER = 0.5
"""m that a radian of turning counts as when two orders are compared by the length of the way."""
SHORTER = 0.999
"""By what part a way has to be shorter to be the right one."""
CLOCK_SET_BACK = 10.0
"""s; a fall of the stamps by more is a clock that was set, by less it is the jitter of a busy computer."""


def taking_order(stamps: Floats, odom_from_base: Floats) -> NDArray[np.int64]:
    """Indices (n,) that put poses (n, 3) [m, m, rad] with stamps (n,) [s] into the order in which they were driven through.

    A file in order may have stamps that are not, and a shuffled file has good stamps. The vehicle tells which is the case: in
    the wrong order it goes to and fro, which makes the way longer. A leap of the odometry counts no more than one of FARTHEST.
    """
    as_filed = np.arange(len(stamps))
    by_stamp = np.argsort(stamps, kind="stable")
    return by_stamp if _way(odom_from_base[by_stamp]) < SHORTER * _way(odom_from_base) else as_filed


def _way(odom_from_base: Floats) -> float:
    moved = steps(odom_from_base)
    return float(np.minimum(np.hypot(moved[:, 0], moved[:, 1]), FARTHEST).sum() + LEVER * np.abs(moved[:, 2]).sum())


def garbled(stamps: Floats) -> NDArray[np.int64]:
    """Indices (k,) of single stamps (n,) [s] that are off by more than a clock's jitter, while those before and after them agree."""
    before, after = np.diff(stamps)[:-1], np.diff(stamps)[1:]
    alone = (np.abs(before) > CLOCK_SET_BACK) & (np.abs(after) > CLOCK_SET_BACK) & (np.abs(before + after) <= CLOCK_SET_BACK)
    return np.flatnonzero(alone) + 1


def mended(stamps: Floats) -> Floats:
    """Stamps (n,) [s] with each garbled one set to the middle between its neighbours."""
    found, wrong = stamps.copy(), garbled(stamps)
    found[wrong] = (stamps[wrong - 1] + stamps[wrong + 1]) / 2
    return found


def clock_resets(stamps: Floats) -> NDArray[np.int64]:
    """Indices (k,) of the stamps (n,) [s] before which the clock was set back."""
    return np.flatnonzero(np.diff(stamps) < -CLOCK_SET_BACK) + 1


def rising(stamps: Floats) -> Floats:
    """Times (n,) [s] that never fall, as near to the stamps (n,) [s] as can be (least squares; pool adjacent violators).

    Where a clock was set back the time goes on with the median period.
    """
    if len(stamps) < 2:
        return stamps.copy()
    period = np.diff(stamps)
    period[period < -CLOCK_SET_BACK] = max(float(np.median(period)), 0.0)
    found: Any = isotonic_regression(stamps[0] + np.concatenate(((0.0,), np.cumsum(period))))
    times: Floats = found.x
    return times
