"""How often one instance of a service has failed, and whether it is tried again."""

import traceback
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field

from uvf.runtime.messages.validation import legible
from uvf.runtime.process.watchdog import StepHangs

FAILURES = 3
WINDOW = 30.0  # s: this many failures within it, and the instance is given up
LONGEST = 300  # characters of a cause
STARTED_AFRESH, GIVEN_UP = "has failed and was started afresh", "and is given up:"
"""Words by which events tell that an instance has failed."""


@dataclass
class Bulkhead:
    """Counts the failures of one instance, and keeps them from the instances of other vehicles in the same process."""

    given_up: str = ""
    """The cause, once it is."""
    _times: deque[float] = field(default_factory=lambda: deque(maxlen=FAILURES))

    @staticmethod
    def contain(action: Callable[[], None]) -> str:
        """Runs ``action`` and returns the cause if it failed, whatever it has raised; empty if it did not."""
        try:
            action()
        except KeyboardInterrupt:
            raise  # an operator's, not the instance's
        except BaseException as error:  # noqa: BLE001  # a bulkhead: nobody knows what a fault will raise
            return cause_of(error)
        return ""

    def failed(self, t: float, cause: str) -> bool:
        """Counts a failure at ``t`` [s]; True when that was one too many within the window."""
        self._times.append(t)
        if len(self._times) == FAILURES and t - self._times[0] < WINDOW:
            self.given_up = cause
        return bool(self.given_up)

    def is_repeated(self, t: float) -> bool:
        """Whether there was another failure within the window before the one at ``t`` [s]."""
        return len(self._times) > 1 and t - self._times[-2] < WINDOW


def cause_of(error: BaseException) -> str:
    """Cause of an error on one line: ``ValueError: math domain error (service.py:212 in _steer)``."""
    frames = traceback.extract_tb(error.__traceback__)
    if isinstance(error, StepHangs):
        frames.pop()  # the watchdog's own: the one before is where the step was
    where = f" ({frames[-1].filename.rpartition('/')[2]}:{frames[-1].lineno} in {frames[-1].name})" if frames else ""
    return legible(f"{type(error).__name__}: {_words_of(error)[:LONGEST]}{where}")


def _words_of(error: BaseException) -> str:
    try:
        return " ".join(str(error).split())
    except Exception:  # noqa: BLE001  # an error that cannot say what it is must not do more harm than it has done
        return "it cannot say what"
