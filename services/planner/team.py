"""The rest of the team, as the planner of one vehicle hears of it."""

from collections import deque
from math import hypot
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from schemas.messages import NavStatus, PoseInFrame, PosesInFrame
from uvf.maths.se2 import Pose2, inverse, transform
from uvf.planning.exploration import OthersGoal
from uvf.planning.navigation.right_of_way import Traveller
from uvf.planning.smoothing import from_place
from uvf.runtime.messages.convert import seconds

Point = tuple[float, float]
Floats = NDArray[np.float64]

LATELY = 40  # times that they were heard
MOST = 2000  # points of another vehicle's path that are looked at
LARGEST = 2.5  # m, of the radius that a vehicle may say it has
ABOVE = 2.0  # m above the vehicle, from where on nobody is in its way
APART, FORGOTTEN = 0.15, 1.0  # s between two poses that a velocity is made of, at least and at most
SLOWEST, FASTEST = 0.08, 5.0  # m/s, of one that moves: a slower one may only be told of anew; what is faster has jumped
FARTHEST = 1e5  # m from the world's origin that a place may lie
AT_IT = (NavStatus.DRIVING, NavStatus.RECOVERING)


class _Motion(NamedTuple):
    """Where one was at ``t`` [s], and how it moved [m/s]."""

    t: float
    place: Point
    velocity: Point


class Teammates:
    """The others, of a vehicle of that name and circumscribed radius [m]. Who does not say its own radius is taken for as large."""

    def __init__(self, own: str, radius: float, world_from_map: Pose2) -> None:
        self.places: dict[str, Point] = {}
        """Where they are [m, world]; without those whose place is none."""
        self._own, self._radius, self._map_from_world = own, radius, inverse(world_from_map)
        self._been: deque[dict[str, Point]] = deque(maxlen=LATELY)
        self._flying: set[str] = set()
        self._motions: dict[str, _Motion] = {}
        self._said: dict[str, NavStatus] = {}
        self._paths: dict[str, PosesInFrame] = {}
        self._points: dict[str, tuple[PosesInFrame, Floats]] = {}
        """(n, 2) m, of the paths that were looked at last."""

    def hear(self, poses: dict[str, PoseInFrame], said: dict[str, NavStatus], paths: dict[str, PosesInFrame]) -> None:
        """What they publish now, by name; the vehicle's own are left out."""
        found = {name: (pose.pose.position.x, pose.pose.position.y) for name, pose in poses.items() if name != self._own}
        self.places = {name: place for name, place in sorted(found.items()) if all(abs(part) < FARTHEST for part in place)}
        own = poses.get(self._own)
        highest = ABOVE + (0.0 if own is None else own.pose.position.z)
        self._flying = {name for name in self.places if poses[name].pose.position.z > highest}
        self._motions = {name: self._motion(name, poses[name]) for name in self.places}
        self._been.append(self.places)
        self._said, self._paths = said, paths

    @property
    def goals(self) -> list[OthersGoal]:
        """Where they go to explore [m, map]; among two that want the same, the one whose name comes first has it."""
        others = {name: said for name, said in self._said.items() if name != self._own}
        exploring = [(name, said.goal) for name, said in others.items() if said.job == "explore" and said.state in AT_IT]
        places = self._in_map([(goal.x, goal.y) for _, goal in exploring]).tolist()
        return [OthersGoal((x, y), name < self._own) for (name, _), (x, y) in zip(exploring, places, strict=True)]

    @property
    def waiting(self) -> dict[str, str]:
        """For whom each of those waits who wait at a narrow passage."""
        return {name: said.waits_for for name, said in self._said.items() if name != self._own and said.waits_for and said.state in AT_IT}

    @property
    def travellers(self) -> list[Traveller]:
        """Those that have a path, with it from where they are on [m, map]."""
        found = []
        for name, place in self.places.items():
            path = self._paths.get(name)
            if path is not None and path.poses:
                rest, _ = from_place(self._points_of(name, path), place)
                found.append(Traveller(name, transform(self._map_from_world, rest), self._radius_of(name)))
        return found

    def _points_of(self, name: str, path: PosesInFrame) -> Floats:
        """(n, 2) m, of a path that may be the one of the last time."""
        before, points = self._points.get(name, (None, np.zeros((0, 2))))
        if before is not path:
            points = np.array([(pose.position.x, pose.position.y) for pose in path.poses[:MOST]])
            points = points[(np.abs(points) < FARTHEST).all(axis=1)]
            self._points[name] = path, points
        return points

    @property
    def present(self) -> Floats:
        """(n, 3) what those who do not fly above it cover now: x, y, radius [m, map]."""
        names = self._on_the_ground
        return np.column_stack((self._in_map([self.places[name] for name in names]), [self._radius_of(name) for name in names]))

    @property
    def velocities(self) -> Floats:
        """(n, 2) m/s, of the same, world axes; 0 of who stands, or jumps."""
        return np.array([self._motions[name].velocity for name in self._on_the_ground]).reshape(-1, 2)

    @property
    def _on_the_ground(self) -> list[str]:
        return [name for name in self.places if name not in self._flying]

    @property
    def discs(self) -> Floats:
        """(n, 3) what they cover and have covered lately, and maps may still show: x, y, radius [m, map]."""
        been = sorted({(name, place) for places in self._been for name, place in places.items()})
        return np.column_stack((self._in_map([place for _, place in been]), [self._radius_of(name) for name, _ in been]))

    def _motion(self, name: str, pose: PoseInFrame) -> _Motion:
        """By the last two poses that are some time apart."""
        t, place, before = seconds(pose.timestamp), (pose.pose.position.x, pose.pose.position.y), self._motions.get(name)
        if before is None or not 0.0 <= t - before.t <= FORGOTTEN:
            return _Motion(t, place, (0.0, 0.0))
        if t - before.t < APART:
            return before
        vx, vy = ((now - then) / (t - before.t) for now, then in zip(place, before.place, strict=True))
        return _Motion(t, place, (vx, vy) if SLOWEST < hypot(vx, vy) < FASTEST else (0.0, 0.0))

    def _radius_of(self, name: str) -> float:
        said = self._said.get(name)
        return said.radius if said is not None and 0.0 < said.radius <= LARGEST else self._radius

    def _in_map(self, places: list[Point]) -> Floats:
        """(n, 2) m, of places [m, world]."""
        return transform(self._map_from_world, np.array(places).reshape(-1, 2))
