"""Kernels are compiled, or loaded from their cache, before the first scan: later it would hold up the vehicle for seconds."""

import numpy as np

from uvf.estimation.odometry.filter import DriveFilter
from uvf.estimation.odometry.states import Noise, Step
from uvf.maths.kinematics import WheelTravel
from uvf.maths.se2 import IDENTITY
from uvf.slam.localization import known_map
from uvf.slam.localization.localizer import Localizer
from uvf.slam.localization.params import FilterParams
from uvf.slam.made_corridor import there_and_back
from uvf.slam.maps.shared_kernels import NO_KEY, moved_keys
from uvf.slam.maps.tiles import TileMap
from uvf.slam.matching.branch_and_bound import Window, search
from uvf.slam.matching.cloud import cloud_of
from uvf.slam.matching.likelihood import likelihood_field
from uvf.slam.method import Keyframe, SlamMethod


def warm_up(method: SlamMethod) -> None:
    """Compiles the kernels of odometry, a SLAM method, its map and the place search before the first scan."""
    readings = list(there_and_back())
    for reading in readings:
        method.add(reading)
    method.finish()
    points = cloud_of(readings[0]).points
    search(points, likelihood_field(points, 0.1, 0.1, 2), Window(IDENTITY, 0.2, 0.1), 0.5)
    moved_keys(np.full(2, NO_KEY), np.zeros(2, dtype=np.int32), np.arange(1), 4)  # first called when a map has grown
    drawn = TileMap()
    drawn.follow(method.keyframes())
    drawn.cells()
    _warm_up_odometry()


def warm_up_localization() -> None:
    """Compiles the kernels of localization on a made-up map: the one of the mission may come later."""
    readings = list(there_and_back())
    known = known_map.of_grid(known_map.of_keyframes([Keyframe(r.odom_from_base, r) for r in readings]).grid)
    lost, tracked = Localizer(known, FilterParams(), 0), Localizer(known, FilterParams(), 0, IDENTITY)
    for localizer, drive in ((lost, readings[:2]), (tracked, readings)):
        for reading in drive:
            localizer.add(reading)
    _warm_up_odometry()


def _warm_up_odometry() -> None:
    DriveFilter("ekf", Noise(), 0.2).step(Step(0.02, WheelTravel(0.0, 0.0)))
