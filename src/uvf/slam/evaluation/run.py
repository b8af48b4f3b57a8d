"""A method run over a log: what it said at the time, what it says in the end, and how long that took."""

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.slam.logs.laser_log import LaserLog, OdometryTrack
from uvf.slam.maps.session import MappingSession
from uvf.slam.method import Keyframe, SlamMethod
from uvf.slam.resumable import Resumable
from uvf.slam.synchronised import Synchronised

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class LogRun:
    """What came out of a run; poses (readings, 3) are map_from_base [m, m, rad]."""

    log: LaserLog
    online: Floats
    """As told when each reading came."""
    final: Floats
    """As known after the last one."""
    covariances: Floats
    """(readings, 3, 3), of the online poses."""
    quality: Floats
    """(readings,) 0..1, of the online poses."""
    keyframes: tuple[Keyframe, ...]
    session: MappingSession | None
    """Of a method that has one."""
    skew: float
    """s, where the odometry of a sweep's stamp is found beside its own; 0 when none has been taken off."""
    wall: float
    """s on the clock, from the first reading to the finished method."""
    cpu: float
    """s on all processors."""

    @property
    def times_real_time(self) -> float:
        """Speed of the run as a multiple of real time [-]."""
        return self.log.duration / self.wall


def run_over(log: LaserLog, method: SlamMethod, watch: Callable[[int], None] = lambda done: None) -> LogRun:
    """Runs a method over a log. The skew of the odometry's stamps is estimated and taken off on the way.

    watch: is told the number of readings done, after each.
    """
    estimates = []
    fed = Synchronised(method, _track(log))
    wall, cpu = time.perf_counter(), time.process_time()
    for done, reading in enumerate(log, 1):
        estimates.append(fed.add(reading))
        watch(done)
    fed.finish()
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    return LogRun(
        log,
        np.array([e.map_from_base for e in estimates]),
        method.trajectory(),
        np.array([e.covariance for e in estimates]),
        np.array([e.quality for e in estimates]),
        tuple(method.keyframes()),
        method.session() if isinstance(method, Resumable) else None,
        fed.skew.seconds if fed.shifts else 0.0,
        wall,
        cpu,
    )


def _track(log: LaserLog) -> OdometryTrack:
    """The odometry's own lines, or, where the log has none, what stands beside the sweeps."""
    return log.odometry or OdometryTrack(np.array([reading.t for reading in log]), log.odom_from_base)
