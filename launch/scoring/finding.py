"""What a measure found: its value, and the moment, the place and the thing that decided it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Place = tuple[float, float]


@dataclass(frozen=True)
class Finding:
    """The value of a measure. t [s, simulation], place (x, y) [m, world] and note say when, where and against what it came about."""

    value: float
    t: float | None = None
    place: Place | None = None
    note: str = ""

    @property
    def circumstances(self) -> str:
        """``43.2 s, (2.10, 3.40) m: box_3``; empty where nothing is known."""
        moment = [f"{self.t:.1f} s"] if self.t is not None else []
        place = [f"({self.place[0]:.2f}, {self.place[1]:.2f}) m"] if self.place is not None else []
        return ": ".join(part for part in (", ".join(moment + place), self.note) if part)


def largest(values: Floats, track: Floats, note: str = "") -> Finding:
    """The largest of ``values`` (n,) with its moment and place on ``track`` (n, >= 3): t [s], x, y [m, world]; n > 0."""
    k = int(np.argmax(values))
    return Finding(float(values[k]), float(track[k, 0]), (float(track[k, 1]), float(track[k, 2])), note)
