"""Beams that wait until it is known where they were measured."""

from collections import deque
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se3 import apply
from uvf.runtime.messages.frames import FrameBuffer, FrameError
from uvf.sensors.sweeping import SweepSegment

Floats = NDArray[np.float64]

WORLD = "world"
PATIENCE = 2.0  # s that a picture or sweep waits until it is known where it was taken, and without any that is, until this is told
WAITING_MOST = 256


class RayBundle(NamedTuple):
    """Beams. ends: (n, 3) [m] in the sensor's frame; reach [m]: a beam that ends farther away has met nothing."""

    ends: Floats
    reach: float


class PlacedBeams(NamedTuple):
    """Origin (3,) and ends (n, 3) of beams [m, world]; the origin of a sweep is that of its middle. reach [m]: as in ``RayBundle``."""

    origin: Floats
    ends: Floats
    reach: float


class _Taken(NamedTuple):
    parts: list[SweepSegment]
    frame: str
    beams: RayBundle

    def placed(self, frames: FrameBuffer) -> PlacedBeams:
        places = [frames.lookup(WORLD, self.frame, part.at) for part in self.parts]
        ends = [apply(place, self.beams.ends[part.beams]) for place, part in zip(places, self.parts, strict=True)]
        return PlacedBeams(places[len(places) // 2].translation, np.concatenate(ends), self.beams.reach)


class WaitingBeams:
    """What is added is given back in its order, placed, as soon as the frames at its time are known; what waits in vain is dropped."""

    def __init__(self) -> None:
        self._waiting: deque[_Taken] = deque(maxlen=WAITING_MOST)
        self._placed_at = 0.0
        self.lost = ""
        """Why beams were dropped in the last step; "" as long as others have been placed not long ago."""

    def add(self, parts: list[SweepSegment], frame: str, beams: RayBundle) -> None:
        """A picture or sweep that was measured in a frame; parts: its beams by when they were measured."""
        self._waiting.append(_Taken(parts, frame, beams))

    def clear(self) -> None:
        """Nothing waits any more."""
        self._waiting.clear()

    def placed(self, t: float, frames: FrameBuffer) -> Iterator[PlacedBeams]:
        """What has a place at ``t`` [s] by now."""
        still: list[_Taken] = []
        reason = ""
        for taken in self._waiting:
            try:
                placed = taken.placed(frames)
            except FrameError as error:
                if t - taken.parts[-1].at < PATIENCE:
                    still.append(taken)
                else:
                    reason = str(error)
                continue
            self._placed_at = t
            yield placed
        self._waiting = deque(still, maxlen=WAITING_MOST)
        self.lost = reason if t - self._placed_at >= PATIENCE else ""
