"""Two small controllers that try the simulation itself: one that must arrive and one that must collide."""

import numpy as np
from numpy.typing import NDArray

from benchmarks.planning.barn.worlds import World
from uvf.maths.kinematics import Twist
from uvf.maths.se2 import Pose2, inverse, transform
from uvf.models.yaml_data import BadInput

Floats = NDArray[np.float64]

SLOW = 0.3  # m/s
REACH = 0.3  # m along the path from the nearest place to the place that is driven for
SPACING = 0.1  # m between the places of the path
ROOM, ROUNDS = 0.45, 200  # m from the path to the nearest disc that is tried for; how often
WINDOW = 10  # places within which the nearest one is looked for
TURN_GAIN = 2.5  # 1/s, on the direction of that place
SHARP = 0.5  # rad, direction from which on it turns on the spot
MOST = 1.5  # rad/s


class PathFollower:
    """Follows the organisers' path of a world slowly, from the true pose: pure pursuit of a place a little ahead.

    The path is first eased off the cylinders: in some worlds the footprint does not pass along it as it is.
    """

    def __init__(self, world: World) -> None:
        """Raises BadInput for a world without a path."""
        if world.path is None:
            raise BadInput(f"{world.name}: it has no path to follow; choose another --controller")
        corners = np.array((world.start[:2], *world.path, world.goal))
        eased = _eased(_spaced(corners), world.discs) if len(world.discs) else _spaced(corners)
        self._places = transform(inverse(world.start), eased)
        self._nearest = 0

    def reset(self, goal_in_odom: Pose2) -> None:
        """Begins at the start; the goal is the path's end."""
        self._nearest = 0

    def command(self, t: float, ranges: Floats, odom_from_base: Pose2, velocity: Twist) -> tuple[float, float]:
        """Towards the place ``REACH`` ahead; on the spot while that is far to the side."""
        window = self._places[self._nearest : self._nearest + WINDOW]
        away = np.hypot(window[:, 0] - odom_from_base.x, window[:, 1] - odom_from_base.y)
        self._nearest += int(np.argmin(away))
        ahead = self._places[min(self._nearest + round(REACH / SPACING), len(self._places) - 1)]
        x, y = transform(inverse(odom_from_base), ahead[np.newaxis])[0]
        bearing = float(np.arctan2(y, x))
        turn = float(np.clip(TURN_GAIN * bearing, -MOST, MOST))
        return (0.0 if abs(bearing) > SHARP else SLOW), turn


def _spaced(corners: Floats) -> Floats:
    """(n, 2) [m]: places every ``SPACING`` along a line through corners."""
    along = np.concatenate(((0.0,), np.cumsum(np.hypot(*np.diff(corners, axis=0).T))))
    at = np.arange(0.0, along[-1], SPACING)
    return np.column_stack([np.interp(at, along, column) for column in corners.T])


def _eased(places: Floats, discs: Floats) -> Floats:
    """The path (n, 2) [m] drawn smooth, for it comes in cells, and pushed off the discs (m, 3) where it runs nearer than ``ROOM``."""
    line = places.copy()
    for _ in range(ROUNDS):
        line[1:-1] += 0.5 * (0.5 * (line[:-2] + line[2:]) - line[1:-1])
        off = line[:, np.newaxis] - discs[:, :2]
        away = np.hypot(off[..., 0], off[..., 1])
        nearest = np.argmin(away - discs[:, 2], axis=1)
        rows = np.arange(len(line))
        gap = away[rows, nearest] - discs[nearest, 2]
        line += (0.2 * np.clip(ROOM - gap, 0.0, None) / away[rows, nearest])[:, np.newaxis] * off[rows, nearest]
    return line


class Straight:
    """Drives straight on at 1 m/s, whatever is in the way."""

    def reset(self, goal_in_odom: Pose2) -> None:
        """The goal does not matter."""

    def command(self, t: float, ranges: Floats, odom_from_base: Pose2, velocity: Twist) -> tuple[float, float]:
        """The same always."""
        return 1.0, 0.0
