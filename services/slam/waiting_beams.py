"""Beams that wait until it is known where they were measured."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se3 import apply
from uvf.runtime.messages.frames import FrameBuffer
from uvf.runtime.messages.waiting import WaitingForFrames
from uvf.sensors.sweeping import SweepSegment

Floats = NDArray[np.float64]

WORLD = "world"
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


class WaitingBeams(WaitingForFrames[_Taken]):
    """Pictures and sweeps."""

    def __init__(self) -> None:
        super().__init__(WAITING_MOST)

    def take(self, parts: list[SweepSegment], frame: str, beams: RayBundle) -> None:
        """A picture or sweep that was measured in a frame; parts: its beams by when they were measured."""
        self.add(parts[-1].at, _Taken(parts, frame, beams))

    def in_world(self, t: float, frames: FrameBuffer) -> Iterator[PlacedBeams]:
        """What has a place at ``t`` [s] by now."""
        return self.placed(t, lambda taken: taken.placed(frames))
