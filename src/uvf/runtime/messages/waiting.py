"""What was measured waits until it is known where that was."""

from collections import deque
from collections.abc import Callable, Iterator
from typing import Generic, TypeVar

from uvf.runtime.messages.frames import FrameError

T = TypeVar("T")
R = TypeVar("R")

PATIENCE = 2.0  # s that something waits until it is known where it was measured, and without anything that is, until this is told


class WaitingForFrames(Generic[T]):
    """What is added is given back in its order, placed, as soon as the frames at its time are known; what waits in vain is dropped."""

    def __init__(self, most: int) -> None:
        """most: things that wait at once; of more the oldest are dropped."""
        self._waiting: deque[tuple[float, T]] = deque(maxlen=most)
        self._placed_at = 0.0
        self.lost = ""
        """Why something was dropped in the last step; "" as long as others have been placed not long ago."""

    def add(self, taken: float, thing: T) -> None:
        """Something that was measured at ``taken`` [s]."""
        self._waiting.append((taken, thing))

    def clear(self) -> None:
        """Nothing waits any more."""
        self._waiting.clear()

    def placed(self, t: float, place: Callable[[T], R]) -> Iterator[R]:
        """What ``place`` makes at ``t`` [s] of all that it can place by now; it raises FrameError as long as it cannot."""
        still: list[tuple[float, T]] = []
        reason = ""
        for taken, thing in self._waiting:
            try:
                placed = place(thing)
            except FrameError as error:
                if t - taken < PATIENCE:
                    still.append((taken, thing))
                else:
                    reason = str(error)
                continue
            self._placed_at = t
            yield placed
        self._waiting = deque(still, maxlen=self._waiting.maxlen)
        self.lost = reason if t - self._placed_at >= PATIENCE else ""
