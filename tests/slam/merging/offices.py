"""Made-up buildings of the same corridors with other doors, and two robots that map one from places unknown to each other."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from benchmarks.slam.evaluation.building import corridors
from benchmarks.slam.evaluation.driven import Wear, drive, route
from uvf.maths.se2 import Pose2, compose, inverse
from uvf.slam.evaluation.run import run_over
from uvf.slam.graph.method import GraphSlam
from uvf.slam.maps.session import MappingSession
from uvf.slam.reading import Beams

HALF_ROUND = Beams((0.0, 0.0), np.radians(np.linspace(-90.0, 90.0, 181)), 0.1, 30.0)
WIDTH, HEIGHT, MIDDLE = 22.0, 14.0, 9.0
LINES = np.array(((0.0, 0.0, WIDTH, 0.0), (WIDTH, 0.0, WIDTH, HEIGHT), (MIDDLE, 0.0, MIDDLE, HEIGHT)))
ANNE = ((0.0, 0.0), (WIDTH, 0.0), (WIDTH, HEIGHT))
BERT = ((MIDDLE, HEIGHT), (MIDDLE, 0.0), (WIDTH, 0.0), (WIDTH, 8.0))


@dataclass(frozen=True)
class Mapped:
    """building_from_map: the truth."""

    session: MappingSession
    building_from_map: Pose2

    def map_from(self, other):
        """Where another's map lies in this one, the truth."""
        return compose(inverse(self.building_from_map), other.building_from_map)


@cache
def mapped(corners, building=1, seed=1):
    walls = corridors(LINES, np.random.default_rng(building))
    way = route(np.array(corners))
    driven, slam = drive(way, walls, HALF_ROUND, Wear(), seed), GraphSlam()
    run_over(driven.log, slam)
    return Mapped(slam.session(), Pose2(*way[0].tolist()))


def anne(building=1):
    return mapped(ANNE, building, 1)


def bert(building=1):
    return mapped(BERT, building, 2)


def first(session, n):
    """The session as it was after n keyframes."""
    e = session.edges
    kept = e.ends.max(axis=1) < n
    edges = type(e)(e.ends[kept], e.measured[kept], e.information[kept], e.kinds[kept], e.enabled[kept])
    return MappingSession(session.keyframes[:n], edges, session.method, session.parameters)


def off_by(found, true):
    """m, rad."""
    away = compose(inverse(true), found)
    return float(np.hypot(away.x, away.y)), abs(away.yaw)
