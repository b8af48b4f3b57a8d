"""Where markers stand that have been seen from several places.

A sighting is a ray: it tells where a marker is across it, and little along it. What sightings tell adds up as information, the inverse of
the covariance (Thrun, Burgard & Fox, "Probabilistic Robotics", section 3.5), so that rays from different places intersect by least squares
(Hartley & Sturm, "Triangulation", CVIU 68(2), 1997). Markers stand on level ground of a known height: that tells how far away one is that
is seen from above. One that is seen from the side tells it by its apparent height.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

APART = 0.5  # m that a sighting is from the last one of the same marker: from one place its error is always the same
GATE = 3.5  # sigmas across a ray, within which a marker may be what is seen
LEVEL = 0.5  # rad from the horizon, within which a marker is seen from the side
RANGE_ERROR = 0.15  # share of the range by the apparent height
SIZE_RATIO = 1.6  # between the apparent height and that of a marker so far away
LEAST_SIGMA = 0.05  # m
ONCE_MOST = 50
"""Markers that were seen from one place alone which are kept."""
INFLATED = 1e-9  # 1/m^2, so that a single ray has a solution


@dataclass(frozen=True)
class MarkerModel:
    """What is known of markers and of sightings."""

    height: float
    """m, of a marker, which stands on the ground."""
    ground: float
    """m, z of the ground in the world."""
    ground_sigma: float
    """m, 1 sigma: how level it is."""
    pose_sigma: float
    """m, 1 sigma: error of the camera's place."""
    angle_sigma: float
    """rad, 1 sigma: error of a ray."""
    reach: float
    """m, beyond which nothing is taken for a marker."""
    least_apart: float
    """m: two markers nearer to each other are one."""


@dataclass(frozen=True)
class Sighting:
    """Something seen: origin (3,) [m, world], ray (3,) unit vector [world] to its middle; height [rad] as it appears, None if cut off."""

    origin: Floats
    ray: Floats
    height: float | None


class Marker:
    """One marker: what its sightings tell, as information (3, 3) [1/m^2] and information times position (3,) [1/m]."""

    def __init__(self, id_: int, information: Floats, position: Floats, views: int = 1) -> None:
        self.id = id_
        self.views = views
        """From different places."""
        self.seen_from: Floats = np.full(3, np.inf)
        """(3,) [m, world], the last time that it was counted."""
        self._information, self._weighted = information, information @ position
        self._solve()

    def add(self, information: Floats, position: Floats) -> None:
        """Adds what tells the ``position`` (3,) [m, world] with ``information`` (3, 3) [1/m^2]."""
        self._information = self._information + information
        self._weighted = self._weighted + information @ position
        self._solve()

    def join(self, other: "Marker") -> None:
        """Adds all that is known of another one, which is the same."""
        self.add(other._information, other.position)
        self.views += other.views
        self.seen_from = other.seen_from

    def _solve(self) -> None:
        self.covariance: Floats = np.asarray(np.linalg.inv(self._information), dtype=np.float64)
        """(3, 3) [m^2] of the position."""
        self.position: Floats = self.covariance @ self._weighted
        """(3,) [m, world], of its middle."""
        self.sigma = max(math.sqrt(float(np.linalg.eigvalsh(self.covariance[:2, :2])[-1])), LEAST_SIGMA)
        """m, 1 sigma, horizontal, of the worse axis."""


class MarkerMap:
    """All markers that have been seen."""

    def __init__(self, model: MarkerModel) -> None:
        self._model = model
        self.markers: list[Marker] = []
        self._next = 1

    def see(self, sighting: Sighting) -> Marker | None:
        """Adds a sighting; the marker that it was taken for, or None where it tells too little."""
        known = self._known(sighting)
        if known is not None:
            self._refine(known, sighting)
            return known
        first = self._first(sighting)
        if first is not None:
            self.markers.append(first)
            self._next += 1
            self._make_room()
        return first

    def resume(self, known: list[tuple[int, Floats, float, int]]) -> None:
        """Goes on with markers: id, position (3,) [m, world], sigma [m], views."""
        for name, position, sigma, views in known:
            self.markers.append(Marker(name, np.eye(3) / sigma**2, position, views))
            self._next = max(self._next, name + 1)

    def _known(self, sighting: Sighting) -> Marker | None:
        """The marker that lies nearest to the ray, in sigmas."""
        fitting = [(off, marker) for marker in self.markers if (off := self._off(marker, sighting)) <= GATE]
        return min(fitting, key=lambda pair: pair[0])[1] if fitting else None

    def _off(self, marker: Marker, sighting: Sighting) -> float:
        """How many sigmas the ray misses a marker by; infinite for one that lies behind, or looks otherwise."""
        away = marker.position - sighting.origin
        along = float(away @ sighting.ray)
        if along <= 0 or not self._looks_right(along, sighting):
            return math.inf
        aside = away - along * sighting.ray
        distance = float(np.linalg.norm(aside))
        if distance < 1e-9:
            return 0.0
        unit = aside / distance
        sigma = math.sqrt(float(unit @ marker.covariance @ unit) + self._sigma_aside(along) ** 2)
        return distance / max(sigma, self._model.least_apart / 2 / GATE)

    def _looks_right(self, along: float, sighting: Sighting) -> bool:
        """Whether something so far away [m] has this apparent height; seen from above, or in part, that tells nothing."""
        down = abs(float(sighting.ray[2]))
        if sighting.height is None or down >= math.sin(LEVEL):
            return True
        expected = math.atan(self._model.height * math.sqrt(1 - down**2) / along)
        return expected / SIZE_RATIO <= sighting.height <= expected * SIZE_RATIO

    def _sigma_aside(self, distance: float) -> float:
        return math.hypot(self._model.pose_sigma, distance * self._model.angle_sigma)

    def _refine(self, marker: Marker, sighting: Sighting) -> None:
        if float(np.linalg.norm(marker.seen_from - sighting.origin)) < APART:
            return
        along = float((marker.position - sighting.origin) @ sighting.ray)
        marker.add(self._across(sighting, max(along, APART)), sighting.origin)
        marker.views, marker.seen_from = marker.views + 1, sighting.origin
        self._join(marker)

    def _across(self, sighting: Sighting, distance: float) -> Floats:
        """Information (3, 3) across a ray to something so far away [m]."""
        across: Floats = np.eye(3) - np.outer(sighting.ray, sighting.ray)
        return across / self._sigma_aside(distance) ** 2

    def _first(self, sighting: Sighting) -> Marker | None:
        """A new marker by one sighting: how far it is, its apparent height tells, or the ground that it stands on."""
        model, down = self._model, -float(sighting.ray[2])
        middle = model.ground + model.height / 2
        is_level = abs(down) < math.sin(LEVEL)
        if is_level and sighting.height is None:
            return None
        if is_level and sighting.height is not None:
            distance = model.height * math.sqrt(1 - down**2) / math.tan(max(sighting.height, 1e-6))
        elif down > 0:
            distance = float(sighting.origin[2] - middle) / down
        else:
            return None
        if not 0 < distance <= model.reach:
            return None
        information = self._across(sighting, distance) + INFLATED * np.eye(3)
        marker = Marker(self._next, information, sighting.origin)
        marker.seen_from = sighting.origin
        level = np.diag((0.0, 0.0, 1 / model.ground_sigma**2))
        marker.add(level, np.array((0.0, 0.0, middle)))
        if is_level:
            along = np.outer(sighting.ray, sighting.ray) / (RANGE_ERROR * distance) ** 2
            marker.add(np.asarray(along, dtype=np.float64), sighting.origin + distance * sighting.ray)
        return marker

    def _join(self, marker: Marker) -> None:
        """Another one that has turned out to be the same is joined to the one of both that was seen from more places."""
        for other in self.markers:
            if other is not marker and float(np.linalg.norm((other.position - marker.position)[:2])) < self._model.least_apart:
                kept, gone = sorted((marker, other), key=lambda each: (-each.views, each.id))
                kept.join(gone)
                self.markers.remove(gone)
                return

    def _make_room(self) -> None:
        """Of those seen from one place alone the oldest is forgotten where there are too many: most of them were none."""
        once = [marker for marker in self.markers if marker.views == 1]
        if len(once) > ONCE_MOST:
            self.markers.remove(once[0])
