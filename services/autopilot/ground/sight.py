"""How long a ground vehicle has been without what it drives by itself by: scans that change, a mapping that speaks."""

from collections.abc import Iterable, Mapping

from schemas.messages import FrameTransform, LaserScan
from uvf.runtime.messages.convert import seconds
from uvf.runtime.messages.readings.scans import sees_nothing
from uvf.sensors.sweeping import Sweeping

MOVED = 0.03  # m of the wheels, after which a scan that is the same to the last bit has frozen


class LidarWatch:
    """Stamp of a lidar's last scan that changed, ``seen`` [s]; None while there never was one. A scan is as old as its last beam."""

    def __init__(self, sweeping: Sweeping) -> None:
        self._sweeping = sweeping
        self.seen: float | None = None
        self._scan: LaserScan | None = None
        self._travelled = 0.0

    def hear(self, scan: LaserScan, travelled: float) -> None:
        """Takes a scan. travelled: distance by the wheels [m] since the start."""
        if self._scan is not None and scan.timestamp == self._scan.timestamp:
            return
        changed = self._scan is None or scan.ranges != self._scan.ranges
        if changed or travelled - self._travelled < MOVED or sees_nothing(scan):
            self.seen = self._sweeping.end(seconds(scan.timestamp))
        if changed:
            self._travelled = travelled
        self._scan = scan


class SensorWatch:
    """Age of the last scan that changed, ``unseen`` [s], and of the map correction, ``map_age`` [s]; 0 while there never was one.

    Of several lidars the one counts of which this is longest ago; one that never spoke, from the first scan of the others on.
    """

    def __init__(self, sweeping: Mapping[str, Sweeping]) -> None:
        """sweeping: of the lidars, by their frames."""
        self._lidars = {frame: LidarWatch(each) for frame, each in sweeping.items()}
        self.unseen = self.map_age = 0.0
        self._begun: float | None = None
        self._mapped: float | None = None

    def step(self, t: float, scans: Iterable[LaserScan], correction: FrameTransform | None, travelled: float) -> None:
        """One cycle at ``t`` [s]. travelled: distance by the wheels [m] since the start."""
        for scan in scans:
            if scan.frame_id in self._lidars:
                self._lidars[scan.frame_id].hear(scan, travelled)
        if correction is not None:
            self._mapped = seconds(correction.timestamp)
        seen = [lidar.seen for lidar in self._lidars.values()]
        if self._begun is None:
            self._begun = min((at for at in seen if at is not None), default=None)
        self.unseen = t - min(at if at is not None else self._begun for at in seen) if self._begun is not None else 0.0
        self.map_age = t - self._mapped if self._mapped is not None else 0.0
