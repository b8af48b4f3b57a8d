"""Two PID loops, as in textbooks on mobile robots: heading to a point ahead on the path, and distance to the path's end."""

from dataclasses import dataclass
from math import atan2, cos, hypot

from uvf.maths.kinematics import Twist
from uvf.maths.rotations import wrap
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.local.path_following import LookAhead, carrot
from uvf.planning.local.planner import Limits, LocalSituation

MOST_SUM = 0.5  # rad s, of the heading error that is summed up
SECONDS = 0.8  # that it looks ahead
SLOWER = (1.0, 0.5, 0.25, 0.0)
"""Parts of the speed that are tried where the vehicle would touch something."""


@dataclass(frozen=True)
class PidGains:
    """Gains of heading (rad/s per rad, per rad s, per rad/s) and of distance (m/s per m); period: s between two commands."""

    proportional: float = 2.5
    integral: float = 0.2
    derivative: float = 0.1
    distance: float = 1.0
    lookahead: float = 0.35  # m to the point that is headed to
    period: float = 0.1


class PidFollower:
    """Drives to the waypoint with no more thought than that, but not into what it sees."""

    def __init__(self, limits: Limits, footprint: RobotFootprint, gains: PidGains) -> None:
        self.gains = gains
        self._limits, self._look = limits, LookAhead(limits, footprint)
        self._sum = 0.0
        self._last: float | None = None

    def reset(self) -> None:
        """Forgets the errors that were summed up."""
        self._sum, self._last = 0.0, None

    def command(self, now: LocalSituation) -> Twist | None:
        """Velocity for now; None where every part of it leads into something."""
        state, gains, limits = now.state, self.gains, self._limits
        x, y, left = carrot(now.path, state.x, state.y, gains.lookahead)
        error = wrap(atan2(y - state.y, x - state.x) - state.yaw) if hypot(x - state.x, y - state.y) > 0.02 else 0.0
        speed = min(gains.distance * max(left, hypot(x - state.x, y - state.y)), limits.max_speed) * max(cos(error), 0.0) ** 2
        turn = min(max(self._turn(error), -limits.max_turn_rate), limits.max_turn_rate)
        for share in SLOWER:
            if not self._look.collides(now, wanted := Twist(share * speed, turn), SECONDS):
                return wanted
        return None

    def _turn(self, error: float) -> float:
        """rad/s; an error that changes its sign has no past."""
        gains = self.gains
        if self._last is None or self._last * error < 0.0:
            self._sum = 0.0
        rate = 0.0 if self._last is None else wrap(error - self._last) / gains.period
        self._sum = min(max(self._sum + error * gains.period, -MOST_SUM), MOST_SUM)
        self._last = error
        return gains.proportional * error + gains.integral * self._sum + gains.derivative * rate
