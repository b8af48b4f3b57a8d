"""Vector fields about lines and circles with the curvature of the path fed forward.

Beard & McLain chapter 10; plane coordinates are (north, east) [m], courses from north, clockwise [rad], lateral distances
and curvatures positive to the right of the direction of flight.
"""

import math
from dataclasses import dataclass

from uvf.control.cycle import clip
from uvf.estimation.state import Estimate
from uvf.maths.filters import Integral
from uvf.maths.geodesy import GRAVITY
from uvf.models.vehicle.flight_params import AirParams

Point = tuple[float, float]
INTEGRATES_WITHIN = 5.0, 0.2  # m, rad
TURN_TRIM_LIMIT = 0.05  # rad/s
SHALLOWEST, STEEPEST = 0.4, 2.0  # of the field about a path, by the ground speed


def turn_radius(speed: float, bank: float) -> float:
    """Radius [m] of a coordinated turn with this bank [rad] at this speed [m/s] (Beard & McLain 9.3.2)."""
    return speed**2 / (GRAVITY * math.tan(bank))


@dataclass(frozen=True, slots=True)
class PathReference:
    """Path to follow at the present position: distance from it, its course and curvature, and the vector field about it."""

    error: float  # m, the aircraft's distance to the right of the path
    course: float  # rad, of the path there
    curvature: float  # 1/m, of the path a lead time ahead
    convergence: float  # 1/m, steepness of the field at cruise: course correction per distance, near the path
    limit: float  # rad, course correction far away


def from_line(along: Point, origin: Point, position: Point) -> tuple[float, float]:
    """Distance [m] ahead of ``origin`` in the direction ``along`` (unit vector, north and east), and to the right of the line."""
    north, east = position[0] - origin[0], position[1] - origin[1]
    return along[0] * north + along[1] * east, along[0] * east - along[1] * north


def line_reference(along: Point, origin: Point, position: Point, params: AirParams) -> PathReference:
    """Path reference on the line through ``origin`` [m] in the direction ``along`` (unit vector, north and east)."""
    _, right = from_line(along, origin, position)
    return PathReference(right, math.atan2(along[1], along[0]), 0.0, params.k_path, params.chi_inf)


def orbit_reference(centre: Point, radius: float, position: Point, params: AirParams) -> PathReference:
    """Path reference on the circle about ``centre`` [m]; ``radius`` [m] positive clockwise seen from above (10.13)."""
    turn = math.copysign(1.0, radius)
    north, east = position[0] - centre[0], position[1] - centre[1]
    distance = math.hypot(north, east)
    course = math.atan2(east, north) + turn * math.pi / 2
    error = turn * (abs(radius) - distance)
    near = min(abs(radius) / max(distance, 1.0), 1.0)
    as_line = params.k_path * params.chi_inf / (math.pi / 2)  # near the circle the field is as steep as about a line
    return PathReference(error, course, near * turn / abs(radius), params.k_orbit / abs(radius) if params.k_orbit else as_line, math.pi / 2)


class LateralGuidance:
    """From a path reference to a bank angle."""

    def __init__(self) -> None:
        self._trim = Integral(TURN_TRIM_LIMIT)

    def bank(self, aim: PathReference, now: Estimate, params: AirParams, dt: float) -> float:
        """Bank angle [rad] to follow the path, ``dt`` [s] after the last call.

        Course rate of the path and of the field about it, plus the course error, as a coordinated turn (9.14).
        """
        speed = max(now.ground_speed, 5.0)
        off_path = math.remainder(now.course - aim.course, math.tau)
        convergence = aim.convergence * min(max(params.trim_airspeed / speed, SHALLOWEST), STEEPEST)  # the same in time in any wind
        slope = aim.limit * 2 / math.pi * convergence
        correction = -aim.limit * 2 / math.pi * math.atan(convergence * aim.error)
        drift = speed * math.sin(off_path)
        field_rate = -slope / (1 + (convergence * aim.error) ** 2) * drift
        course_error = math.remainder(correction - off_path, math.tau)
        rate = clip(field_rate, 0.5) + params.course_p * course_error
        if abs(aim.error) < INTEGRATES_WITHIN[0] and abs(course_error) < INTEGRATES_WITHIN[1]:
            # What is off the field, not off the path: the field leads back onto it.
            self._trim.step(params.course_i * course_error, dt)
        rate += self._trim.value
        crab = math.cos(math.remainder(now.course - now.yaw, math.tau))
        ahead, crab_ahead = _ahead(aim, now, speed, params)
        sideways = aim.curvature * ahead**2 / max(crab_ahead, 0.3) + rate * speed / max(crab, 0.3)
        return clip(math.atan(sideways / GRAVITY), params.bank_limit)


def _ahead(aim: PathReference, now: Estimate, speed: float, params: AirParams) -> tuple[float, float]:
    """Ground speed [m/s] and cosine of the crab angle on the path by the time at which a bank that is commanded now is there."""
    turned = speed * aim.curvature * (params.lead_time + params.bank_time)
    (before, _), (after, crab) = (_in_wind(aim.course + angle, now) for angle in (0.0, turned))
    return max(speed + after - before, 5.0), crab


def _in_wind(course: float, now: Estimate) -> tuple[float, float]:
    """Ground speed [m/s] on a course at the present airspeed and wind, and the cosine of the crab angle (Beard & McLain 2.4)."""
    along = now.wind_north * math.cos(course) + now.wind_east * math.sin(course)
    across = now.wind_east * math.cos(course) - now.wind_north * math.sin(course)
    air = max(now.airspeed, 1.0)
    crab = math.sqrt(max(1 - (across / air) ** 2, 0.0))
    return along + air * crab, crab
