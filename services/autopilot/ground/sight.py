"""How long a ground vehicle has been without what it drives by itself by: a scan that changes, a mapping that speaks."""

from schemas.messages import FrameTransform, LaserScan
from uvf.runtime.messages.convert import seconds
from uvf.runtime.messages.readings.scans import sees_nothing
from uvf.sensors.sweeping import Sweeping

MOVED = 0.03  # m of the wheels, after which a scan that is the same to the last bit has frozen


class SensorWatch:
    """Age of the last scan that changed, ``unseen`` [s], and of the map correction, ``map_age`` [s]; 0 while there never was one.

    A scan is as old as its last beam.
    """

    def __init__(self, sweeping: Sweeping) -> None:
        self._sweeping = sweeping
        self.unseen = self.map_age = 0.0
        self._seen: float | None = None
        self._mapped: float | None = None
        self._scan: LaserScan | None = None
        self._travelled = 0.0

    def step(self, t: float, scan: LaserScan | None, correction: FrameTransform | None, travelled: float) -> None:
        """One cycle at ``t`` [s]. travelled: distance by the wheels [m] since the start."""
        if scan is not None and (self._scan is None or scan.timestamp != self._scan.timestamp):
            changed = self._scan is None or scan.ranges != self._scan.ranges
            if changed or travelled - self._travelled < MOVED or sees_nothing(scan):
                self._seen = self._sweeping.end(seconds(scan.timestamp))
            if changed:
                self._travelled = travelled
            self._scan = scan
        if correction is not None:
            self._mapped = seconds(correction.timestamp)
        self.unseen = t - self._seen if self._seen is not None else 0.0
        self.map_age = t - self._mapped if self._mapped is not None else 0.0
