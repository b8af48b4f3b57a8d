"""What a 2-D SLAM method is fed with: a scan of ranges and where the odometry has the vehicle at its stamp."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se2 import Pose2

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Beams:
    """Geometry of a lidar's beams; one object serves all scans of the same shape.

    origin: (x, y) of the lidar in the base frame [m]; bearings: (n,) direction of each beam in the base frame [rad], in the
    order in which they are measured: falling for a lidar that turns clockwise or hangs upside down.
    Ranges outside [range_min, range_max] are no return; so are 0, infinite ones and NaN.
    """

    origin: tuple[float, float]
    bearings: Floats
    range_min: float
    range_max: float
    duration: float = 0.0
    """s from the first beam to the last; 0 where all are taken at once."""
    directions: Floats = field(init=False)
    """(n, 2) unit vectors of the bearings."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "directions", np.column_stack((np.cos(self.bearings), np.sin(self.bearings))))


@dataclass(frozen=True)
class Reading:
    """One scan of a lidar with the odometry's pose at its end.

    t: stamp of its last beam [s]; ranges: (n,) [m]; odom_from_base: by the odometry at ``t``; rate_sigmas: 1 sigma of its speed [m/s] and
    turn rate [rad/s], None where it does not say.
    """

    t: float
    ranges: Floats
    beams: Beams
    odom_from_base: Pose2
    rate_sigmas: tuple[float, float] | None = None
    others: "tuple[Reading, ...]" = ()
    """Of the vehicle's other lidars, at about the same time: what the map is drawn from, too."""

    @property
    def returned(self) -> NDArray[np.bool_]:
        """Mask (n,) of the beams that came back."""
        with np.errstate(invalid="ignore"):
            found: NDArray[np.bool_] = (self.ranges > max(self.beams.range_min, 0.0)) & (self.ranges < self.beams.range_max)
        return found

    def claimed_since(self, before: "Reading") -> tuple[float, float] | None:
        """1 sigma (position [m], heading [rad]) of the motion since a reading before, as the odometry has it; None where it does not say.

        As if its speeds had been off the same way all the time, as they are by a bias. What its pose's covariance has grown by would say
        less: an error that goes on as before makes it grow by as much as everything before has made it.
        """
        if self.rate_sigmas is None or before.rate_sigmas is None or self.t <= before.t:
            return None  # the reading before may be of a session from another day
        speed, turn_rate = self.rate_sigmas
        return speed * (self.t - before.t), turn_rate * (self.t - before.t)
