"""Chooses the approach to a strip: its direction, the circle to descend on and the slope, for the wind and what stands about.

The circle is left along its tangent onto the final approach (Beard & McLain 9.3.2 for its radius in a wind). Everything on the way, the
circle, the glide and the climb of a go-around, keeps a clearance over the ground and what stands on it.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.guidance.approach import OF_IDLE, SHORTEST, STEEPEST, Approach
from uvf.guidance.flight_plan import ItemKind, PlanItem
from uvf.guidance.route import Place
from uvf.guidance.runways import LandingStrip, Runway
from uvf.guidance.vector_field import Point, turn_radius
from uvf.models.vehicle.flight_params import AirParams

Floats = NDArray[np.float64]
Tops = Callable[[Floats], Floats]

LONGEST = 60.0  # s at the lowest airspeed, of a final approach
LENGTHS, RADII = 14, 5  # tried
STEP = 10.0  # m, between places that are looked at
CORRIDOR = 25.0  # m, to each side of the way
TOUCH_ZONE = 60.0  # m before the aiming point, where no clearance can be asked for
GO_AROUND = 800.0  # m behind the aiming point
CLIMBING = 0.7  # of the fastest climb, in a go-around
WIDEST = 1.5  # times the radius of Hold


@dataclass(frozen=True)
class ApproachSite:
    """What an approach is planned for: the ``strip``, the ``wind`` [m/s, north and east, where it blows to], and what stands about.

    tops: heights (k,) [m, world] of the ground, or of what stands on it, at places (k, 2) [m, north and east]. clearance: [m] above
    these. tailwind, crosswind: [m/s], the largest that may be landed in.
    """

    strip: LandingStrip
    wind: Point
    tops: Tops
    clearance: float = 15.0
    tailwind: float = 1.5
    crosswind: float = 8.0

    def __post_init__(self) -> None:
        """Raises ValueError for numbers that make no sense."""
        if not all(math.isfinite(v) for v in self.wind):
            raise ValueError(f"a wind of {self.wind} m/s; give two finite numbers")
        for name, value in (("clearance", self.clearance), ("tailwind", self.tailwind), ("crosswind", self.crosswind)):
            if not 0.0 <= value < math.inf:
                raise ValueError(f"a {name} of {value:g}; give 0 or more")


@dataclass(frozen=True)
class PlannedApproach:
    """The approach chosen; None with the ``why`` not. circle: the middle of the circle at the height at which it is left."""

    approach: Approach | None
    circle: Place | None
    why: str

    @property
    def items(self) -> tuple[PlanItem, ...]:
        """Mission items that fly it: the circle down to its height, and the landing; none without an approach."""
        if self.approach is None or self.circle is None:
            return ()
        orbit = PlanItem(ItemKind.ORBIT, self.circle, radius=self.approach.radius, to_altitude=True)
        return orbit, PlanItem(ItemKind.LAND, self.approach.place)


def plan_approach(site: ApproachSite, params: AirParams) -> PlannedApproach:
    """The approach against the wind if one fits, else the other way; of those the shortest with the widest circle that clears everything.

    Without one, ``why`` says for each direction what is in the way.
    """
    courses = sorted((site.strip.course, site.strip.course + math.pi), key=lambda course: _along(site.wind, course))
    whys = []
    for course in courses:
        runway = site.strip.lane(course)
        found = _approach(runway, site, params)
        if isinstance(found, str):
            whys.append(f"{math.degrees(runway.course) % 360:.0f} deg: {found}")
        else:
            return found
    return PlannedApproach(None, None, "; ".join(whys))


def _along(wind: Point, course: float) -> float:
    return wind[0] * math.cos(course) + wind[1] * math.sin(course)


def _approach(runway: Runway, site: ApproachSite, params: AirParams) -> PlannedApproach | str:
    """The best approach to one runway, or why there is none."""
    tail = _along(site.wind, runway.course)
    cross = abs(site.wind[1] * math.cos(runway.course) - site.wind[0] * math.sin(runway.course))
    if tail > site.tailwind:
        return f"a tailwind of {tail:.1f} m/s, {site.tailwind:g} m/s at most"
    if cross > site.crosswind:
        return f"a crosswind of {cross:.1f} m/s, {site.crosswind:g} m/s at most"
    rise = CLIMBING * params.climb_max / (params.trim_airspeed + tail)
    if (needed := _steepness(runway, site, -1.0, GO_AROUND)) > rise:
        return f"a go-around must climb {needed:.3f} over what stands behind it, it climbs {rise:.3f}"
    steepest = min(math.tan(STEEPEST), OF_IDLE * params.idle_sink / (params.trim_airspeed + tail))
    whys = []
    for length in np.linspace(SHORTEST, LONGEST, LENGTHS) * params.min_airspeed:
        slope = max(math.tan(params.glide_slope), _steepness(runway, site, 1.0, float(length)))
        if slope > steepest:
            angle, most = (math.degrees(math.atan(v)) for v in (slope, steepest))
            whys.append(f"a glide of {angle:.1f} deg over what stands before it, {most:.1f} at most")
            break
        height = runway.aim.height + slope * float(length)
        for radius in _radii(site, params):
            middle = runway.before(float(length), radius)
            if _clears_circle(middle, abs(radius), height, site):
                approach = Approach(runway.aim, runway.course, float(length), height, radius)
                return PlannedApproach(approach, Place(*middle, height), "")
        whys.append(f"no circle within {length:.0f} m clears the ground by {site.clearance:g} m")
    return whys[-1]


def _radii(site: ApproachSite, params: AirParams) -> Iterator[float]:
    """Radii [m] to try, positive clockwise: the aircraft's own first, then narrower and wider ones, none too tight for the wind."""
    tightest = turn_radius(params.trim_airspeed + math.hypot(*site.wind), params.turn_bank)
    wanted = max(params.hold_radius, tightest)
    for size in (wanted, *np.linspace(tightest, WIDEST * wanted, RADII).tolist()):
        yield size
        yield -size


def _steepness(runway: Runway, site: ApproachSite, side: float, length: float) -> float:
    """Least slope from the aiming point that clears what stands before it (side 1) or behind it (-1) up to ``length`` [m]; at least 0."""
    begin = TOUCH_ZONE if side > 0 else max(runway.rest, TOUCH_ZONE)
    distances = np.arange(begin, max(length, begin) + STEP, STEP)
    asides = np.linspace(-CORRIDOR, CORRIDOR, 5)
    places = np.array([runway.before(side * d, a) for d in distances.tolist() for a in asides.tolist()])
    tops = site.tops(places).reshape(len(distances), -1).max(axis=1)
    clear = np.minimum(site.clearance, 0.5 * math.tan(STEEPEST) * distances)  # near the ground it cannot be all of it
    blocked = tops > runway.aim.height + 0.5
    needed = np.where(blocked, (tops + clear - runway.aim.height) / distances, 0.0)
    return float(max(needed.max(), 0.0))


def _clears_circle(middle: Point, radius: float, height: float, site: ApproachSite) -> bool:
    """Whether a ring about the circle, as wide as the corridor, keeps the clearance."""
    angles = np.arange(0.0, math.tau, min(STEP / radius, 0.5))
    rings = [radius + aside for aside in (-CORRIDOR, 0.0, CORRIDOR)]
    places = np.concatenate([np.column_stack((middle[0] + r * np.cos(angles), middle[1] + r * np.sin(angles))) for r in rings])
    return bool((site.tops(places) + site.clearance <= height).all())
