"""Regulated pure pursuit (Macenski, Singh, Martin, Gines 2023): an arc to a carrot on the path, slower in bends and beside obstacles."""

from dataclasses import dataclass
from math import atan2, hypot, pi, sin, sqrt

from uvf.maths.kinematics import Twist
from uvf.maths.rotations import wrap
from uvf.planning.costmap.footprint import RobotFootprint
from uvf.planning.local.path_following import LookAhead, carrot, distance_to_obstacle, turn_rate_over
from uvf.planning.local.planner import STOP, Limits, LocalSituation

Target = tuple[float, float, float]

ATTEMPTS = ((1.0, 1.0), (0.6, 0.6), (0.3, 0.35))
"""Shares of the distance to the carrot and of the speed that are tried: where the wide arc touches, a nearer carrot cuts less."""
NEAREST = 0.1  # m, less is not believed of a carrot's distance
ARRIVED = 0.02  # m from the path's end


@dataclass(frozen=True)
class RppSettings:
    """Nav2's parameters of the same names where it has them. Distances to obstacles are beyond the footprint's inscribed radius."""

    min_lookahead_dist: float = 0.3  # m
    max_lookahead_dist: float = 0.9  # m
    lookahead_time: float = 0.8  # s
    lookahead_room_gain: float = 3.0
    """m of distance to the carrot, beyond the least one, for each m to the nearest obstacle: in narrow places corners are not cut."""
    regulated_linear_scaling_min_radius: float = 0.9  # m
    regulated_linear_scaling_min_speed: float = 0.25  # m/s
    cost_scaling_dist: float = 0.35  # m to obstacles, from which on it slows down
    cost_scaling_gain: float = 1.0
    approach_velocity_scaling_dist: float = 0.6  # m
    min_approach_linear_velocity: float = 0.05  # m/s
    max_allowed_time_to_collision_up_to_carrot: float = 1.0  # s
    rotate_to_heading_min_angle: float = 0.785  # rad of the carrot's bearing, from which on it turns on the spot
    rotate_to_heading_end_angle: float = 0.25  # rad, until which it does


class RegulatedPurePursuit:
    """Follows the path; turns on the spot where it begins elsewhere, and reverses where there is no room to turn and it may.

    Cusps of the path are driven to, not cut.
    """

    def __init__(self, limits: Limits, footprint: RobotFootprint, settings: RppSettings) -> None:
        self.settings = settings
        self._limits, self._inscribed = limits, footprint.inscribed_radius
        self._look = LookAhead(limits, footprint)
        self._turning = False

    def reset(self) -> None:
        """Forgets that it was turning on the spot."""
        self._turning = False

    def command(self, now: LocalSituation) -> Twist | None:
        """Velocity for now; None where the arc to the carrot touches something, at low speed and with a near carrot too."""
        s, state = self.settings, now.state
        room = max(distance_to_obstacle(now.grids, state.x, state.y, s.cost_scaling_dist + self._inscribed) - self._inscribed, 0.0)
        reach = self._reach(abs(state.speed), room)
        bearing, distance, left = self._target(now, reach)
        if left < ARRIVED and distance < ARRIVED:
            return STOP
        if abs(bearing) > (s.rotate_to_heading_end_angle if self._turning else s.rotate_to_heading_min_angle):
            turn = turn_rate_over(bearing, self._limits)
            if not self._look.collides(now, wanted := Twist(0.0, turn), abs(bearing / turn)):
                self._turning = True
                return wanted
        self._turning = False
        for share, pace in ATTEMPTS:
            target = self._target(now, max(share * reach, s.min_lookahead_dist))
            wanted = self._pursue(target, pace, room)
            seconds = min(s.max_allowed_time_to_collision_up_to_carrot, target[1] / max(abs(wanted.linear), 1e-6))
            if not self._look.collides(now, wanted, seconds):
                return wanted
        return None

    def _reach(self, speed: float, room: float) -> float:
        """m to the carrot."""
        s = self.settings
        far = min(max(s.lookahead_time * speed, s.min_lookahead_dist), s.max_lookahead_dist)
        return min(far, s.min_lookahead_dist + s.lookahead_room_gain * room) if room < s.cost_scaling_dist else far

    def _target(self, now: LocalSituation, reach: float) -> Target:
        """Bearing [rad] and distance [m] of the carrot, and way [m] left to the path's end."""
        state = now.state
        x, y, left = carrot(now.path, state.x, state.y, reach)
        return wrap(atan2(y - state.y, x - state.x) - state.yaw), hypot(x - state.x, y - state.y), left

    def _pursue(self, target: Target, pace: float, room: float) -> Twist:
        """Velocity on the arc that ends in the target, backwards where that lies behind and the vehicle may."""
        bearing, distance, left = target
        back = abs(bearing) > pi / 2 and self._limits.min_speed < 0.0
        curvature = 2.0 * sin(bearing) / max(distance, NEAREST)
        speed = pace * self._regulated(-self._limits.min_speed if back else self._limits.max_speed, abs(curvature), room)
        speed = min(speed, self._approach(speed, max(left, distance)))
        speed = -speed if back else speed
        return Twist(speed, speed * curvature)

    def _regulated(self, speed: float, curvature: float, room: float) -> float:
        """Speed [m/s] by curvature (equation 5), proximity (equation 6) and what turn rate and sideways acceleration allow."""
        s, limits = self.settings, self._limits
        bent = speed * min(1.0 / max(s.regulated_linear_scaling_min_radius * curvature, 1.0), 1.0)
        beside = speed * (min(s.cost_scaling_gain * room / s.cost_scaling_dist, 1.0) if room < s.cost_scaling_dist else 1.0)
        regulated = min(max(min(bent, beside), s.regulated_linear_scaling_min_speed), speed)
        most = min(limits.max_turn_rate / max(curvature, 1e-6), sqrt(limits.lateral_acceleration / max(curvature, 1e-6)))
        return min(regulated, most)

    def _approach(self, speed: float, left: float) -> float:
        """Speed [m/s] that brings the vehicle to the path's end without overshooting."""
        s = self.settings
        braked = sqrt(2.0 * 0.5 * self._limits.acceleration * left)  # half of the deceleration: the rest is for errors
        if left < s.approach_velocity_scaling_dist:
            braked = min(braked, max(speed * left / s.approach_velocity_scaling_dist, s.min_approach_linear_velocity))
        return braked
