"""How often one instance of a service has failed, and whether it is tried again."""

import traceback
from collections import deque
from dataclasses import dataclass, field

from uvf.runtime.watchdog import StepHangs

FAILURES = 3
WINDOW = 30.0  # s: this many failures within it, and the instance is given up
LONGEST = 300  # characters of a cause


@dataclass
class Bulkhead:
    """Of one instance; its failures are kept from the instances of other vehicles in the same process."""

    given_up: str = ""
    """The cause, once it is."""
    _times: deque[float] = field(default_factory=lambda: deque(maxlen=FAILURES))

    def failed(self, t: float, cause: str) -> bool:
        """Counts a failure at ``t`` [s]; True when that was one too many."""
        self._times.append(t)
        if len(self._times) == FAILURES and t - self._times[0] < WINDOW:
            self.given_up = cause
        return bool(self.given_up)


def cause_of(error: Exception) -> str:
    """``ValueError: math domain error (service.py:212 in _steer)``, in one line."""
    frames = traceback.extract_tb(error.__traceback__)
    if isinstance(error, StepHangs):
        frames.pop()  # the watchdog's own: the one before is where the step was
    where = f" ({frames[-1].filename.rpartition('/')[2]}:{frames[-1].lineno} in {frames[-1].name})" if frames else ""
    return f"{type(error).__name__}: {' '.join(str(error).split())[:LONGEST]}{where}"
