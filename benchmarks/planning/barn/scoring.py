"""How a run of the BARN challenge ends and what it is worth (the organisers' run.py since 2024)."""

from typing import Literal

Ending = Literal["success", "collision", "timeout"]

NEAR_GOAL = 1.0  # m from the robot's middle to the goal
STARTED = 0.1  # m from the start at which the clock begins
LIMIT = 100.0  # s on the clock; without a beginning, s since the run began
FASTEST, SLOWEST = 2.0, 8.0  # times the optimal time between which the time counts


def score(ending: Ending, time: float, optimal_time: float) -> float:
    """Optimal time over the time taken [s], which counts as 2 to 8 times the optimal one; 0 without success, 0.5 at most."""
    if ending != "success":
        return 0.0
    return optimal_time / min(max(time, FASTEST * optimal_time), SLOWEST * optimal_time)


class Referee:
    """Runs the clock and tells the ending."""

    def __init__(self, start: tuple[float, float], goal: tuple[float, float]) -> None:
        """start, goal: x, y [m] of the world."""
        self._start, self._goal = start, goal
        self._began: float | None = None

    def time(self, t: float) -> float:
        """On the clock [s] at ``t`` [s] since the run began; 0 before it has begun."""
        return 0.0 if self._began is None else t - self._began

    def look(self, t: float, place: tuple[float, float], touches: bool) -> Ending | None:
        """The ending at ``t`` [s], if it is one, with the robot's middle at ``place`` [m]; a touch counts before the clock begins too."""
        if self._began is None and _apart(place, self._start) >= STARTED:
            self._began = t
        if touches:
            return "collision"
        if _apart(place, self._goal) <= NEAR_GOAL:
            return "success"
        if t - (self._began or 0.0) >= LIMIT:
            return "timeout"
        return None


def _apart(p: tuple[float, float], q: tuple[float, float]) -> float:
    return float(((p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2) ** 0.5)
