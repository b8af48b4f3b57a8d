"""Where markers stand that have been seen from several places.

A sighting is a ray: it tells where a marker is across it, and little along it. What sightings tell adds up as information, the inverse of
the covariance (Thrun, Burgard & Fox, "Probabilistic Robotics", section 3.5), so that rays from different places intersect by least squares
(Hartley & Sturm, "Triangulation", CVIU 68(2), 1997). Markers stand on level ground of a known height: that tells how far away one is that
is seen from above. One that is seen from the side tells it by its apparent height.
"""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

APART = 0.5  # m that a sighting is from the last one of the same marker: from one place its error is always the same
GATE = 3.5  # sigmas across a ray, within which a marker may be what is seen
LEVEL = 0.5  # rad from the horizon, within which a marker is seen from the side
RANGE_ERROR = 0.15  # share of the range by the apparent height
LEAST_SIGMA = 0.05  # m
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


@dataclass(eq=False)
class Marker:
    """One marker: what its sightings tell, as information (3, 3) [1/m^2] and information times position (3,) [1/m]."""

    id: int
    information: Floats
    weighted: Floats
    views: int = 1
    """From different places."""
    seen_from: Floats = field(default_factory=lambda: np.full(3, np.inf))
    """(3,) [m, world], the last time that it was counted."""

    @property
    def position(self) -> Floats:
        """(3,) [m, world], of its middle."""
        return np.asarray(np.linalg.solve(self.information, self.weighted), dtype=np.float64)

    @property
    def covariance(self) -> Floats:
        """(3, 3) [m^2] of the position."""
        return np.asarray(np.linalg.inv(self.information), dtype=np.float64)

    @property
    def sigma(self) -> float:
        """m, 1 sigma, horizontal, of the worse axis."""
        return max(math.sqrt(float(np.linalg.eigvalsh(self.covariance[:2, :2])[-1])), LEAST_SIGMA)

    def add(self, information: Floats, position: Floats) -> None:
        """Adds what tells the ``position`` (3,) [m, world] with ``information`` (3, 3) [1/m^2]."""
        self.information = self.information + information
        self.weighted = self.weighted + information @ position


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
        return first

    def resume(self, known: list[tuple[int, Floats, float, int]]) -> None:
        """Goes on with markers: id, position (3,) [m, world], sigma [m], views."""
        for name, position, sigma, views in known:
            information = np.eye(3) / sigma**2
            self.markers.append(Marker(name, information, information @ position, views))
            self._next = max(self._next, name + 1)

    def _known(self, sighting: Sighting) -> Marker | None:
        """The nearest marker that lies on the ray."""
        fitting = [(self._along(marker, sighting), marker) for marker in self.markers if self._fits(marker, sighting)]
        return min(fitting, key=lambda pair: pair[0])[1] if fitting else None

    def _along(self, marker: Marker, sighting: Sighting) -> float:
        return float((marker.position - sighting.origin) @ sighting.ray)

    def _fits(self, marker: Marker, sighting: Sighting) -> bool:
        off = marker.position - sighting.origin
        along = float(off @ sighting.ray)
        if along <= 0:
            return False
        aside = off - along * sighting.ray
        distance = float(np.linalg.norm(aside))
        if distance < 1e-9:
            return True
        unit = aside / distance
        sigma = math.sqrt(float(unit @ marker.covariance @ unit) + self._sigma_aside(along) ** 2)
        return distance <= max(GATE * sigma, self._model.least_apart / 2)

    def _sigma_aside(self, distance: float) -> float:
        return math.hypot(self._model.pose_sigma, distance * self._model.angle_sigma)

    def _refine(self, marker: Marker, sighting: Sighting) -> None:
        if float(np.linalg.norm(marker.seen_from - sighting.origin)) < APART:
            return
        marker.add(self._across(sighting, max(self._along(marker, sighting), APART)), sighting.origin)
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
        marker = Marker(self._next, information, information @ sighting.origin, seen_from=sighting.origin)
        level = np.diag((0.0, 0.0, 1 / model.ground_sigma**2))
        marker.add(level, np.array((0.0, 0.0, middle)))
        if is_level:
            along = np.outer(sighting.ray, sighting.ray) / (RANGE_ERROR * distance) ** 2
            marker.add(np.asarray(along, dtype=np.float64), sighting.origin + distance * sighting.ray)
        return marker

    def _join(self, marker: Marker) -> None:
        """Another one that has turned out to be the same is joined to the older of both."""
        for other in self.markers:
            if other is not marker and float(np.linalg.norm((other.position - marker.position)[:2])) < self._model.least_apart:
                older, newer = sorted((marker, other), key=lambda each: each.id)
                older.information, older.weighted = older.information + newer.information, older.weighted + newer.weighted
                older.views, older.seen_from = older.views + newer.views, marker.seen_from
                self.markers.remove(newer)
                return
