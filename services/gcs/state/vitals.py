"""The signs of life of one process: its newest counters, and what they say about the last seconds."""

from collections import deque

from schemas.messages import Health

OVER = 5.0  # s, wall: what the processor's load is taken over
SILENT_AFTER = 3.0  # s, wall


class Vitals:
    """Health of one process."""

    def __init__(self) -> None:
        self.report = Health()
        self._used: deque[tuple[float, float]] = deque()

    def hear(self, t: float, report: Health) -> None:
        """Takes a report at ``t`` [s, wall]. Another pid is a new process, which counts from zero."""
        if report.pid != self.report.pid:
            self._used.clear()
        self.report = report
        self._used.append((t, report.cpu_time))
        while self._used[-1][0] - self._used[0][0] > OVER:
            self._used.popleft()

    def silence(self, t: float) -> float:
        """Time [s, wall] without a report, 0 while that is normal; t [s, wall]."""
        age = t - self._used[-1][0]
        return age if age > SILENT_AFTER else 0.0

    @property
    def load(self) -> float | None:
        """Share [-] of one processor core used over the last seconds; None before it is known."""
        (t0, used0), (t1, used1) = self._used[0], self._used[-1]
        return (used1 - used0) / (t1 - t0) if t1 - t0 > 0.5 else None

    @property
    def late(self) -> float:
        """Share [-] of the steps that began more than one period late."""
        return self.report.late / self.report.steps if self.report.steps else 0.0

    @property
    def gaps(self) -> int:
        """Number of messages missed, of all keys."""
        return sum(self.report.gaps.values())
