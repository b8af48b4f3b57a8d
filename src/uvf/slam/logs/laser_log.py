"""A recorded run as SLAM methods are fed with it, whatever file it comes from."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.slam.reading import Reading

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class OdometryTrack:
    """The odometry's own lines, which come at other times than the sweeps.

    t: (n,) [s] in the clock of the readings; odom_from_base: (n, 3) [m, m, rad] in the odometry frame of the readings.
    """

    t: Floats
    odom_from_base: Floats


@dataclass(frozen=True)
class LaserLog:
    """A recorded run: readings in the order in which they were taken.

    The odometry frame is the base frame of the first reading. Times of readings never fall.
    """

    name: str
    readings: Sequence[Reading]
    stamps: Floats
    """(readings,) s, as the file has them, out of order and all: by these relations name their readings."""
    odometry: OdometryTrack | None = None
    notes: tuple[str, ...] = ()
    """What is wrong with the file, a line each."""

    def __iter__(self) -> Iterator[Reading]:
        return iter(self.readings)

    def __len__(self) -> int:
        return len(self.readings)

    @property
    def odom_from_base(self) -> Floats:
        """Poses (readings, 3) [m, m, rad] of the readings by the odometry."""
        return np.array([r.odom_from_base for r in self.readings], dtype=np.float64).reshape(-1, 3)

    @property
    def duration(self) -> float:
        """Time [s] from the first reading to the last."""
        return self.readings[-1].t - self.readings[0].t if self.readings else 0.0
