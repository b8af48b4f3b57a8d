"""What every local planner is asked: the velocity for now, from where the vehicle is, what is round it, and the path."""

from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled
from uvf.maths.kinematics import Twist
from uvf.planning.local.window import Grids

Floats = NDArray[np.float64]

NOBODY: Floats = np.zeros((0, 5))
STOP = Twist(0.0, 0.0)


class Limits(NamedTuple):
    """What a vehicle can do."""

    min_speed: float  # m/s, below 0 where it may reverse
    max_speed: float  # m/s
    max_turn_rate: float  # rad/s
    acceleration: float  # m/s^2
    angular_acceleration: float  # rad/s^2
    lateral_acceleration: float  # m/s^2, of speed times turn rate, beyond which the wheels slide or the vehicle tips
    sideslip: float = 0.0  # s, of speed times turn rate: velocity at which wheels that skid in a turn slide out of it
    turning_radius: float = 0.0  # m, of the tightest circle; 0: it turns on the spot
    side_speed: float = 0.0  # m/s, to either side; 0: it only goes ahead and back


class State(NamedTuple):
    """Pose [m, m, rad] in the window's frame and velocity [m/s, rad/s] of the vehicle."""

    x: float
    y: float
    yaw: float
    speed: float
    turn_rate: float
    side: float = 0.0
    """m/s, to the left."""


@dataclass(frozen=True)
class LocalSituation:
    """All that a local planner decides by; one frame for all."""

    state: State
    grids: Grids
    path: Floats
    """(n, 2) m, n >= 1, from the vehicle to the goal."""
    obstacles: Floats = field(default_factory=lambda: NOBODY)
    """(m, 5) what moves: x, y [m], vx, vy [m/s], radius [m]."""
    limits: Limits | None = None
    """Those that count now, where they are not the planner's own: a vehicle may do more to evade than it does for its errand."""


class LocalPlanner(Protocol):
    """Chooses velocities at a fixed rate."""

    def command(self, now: LocalSituation) -> Twist | None:
        """Velocity; None where nothing that it knows of is free of contacts."""
        ...

    def reset(self) -> None:
        """Forgets what it remembers of earlier cycles."""
        ...


@compiled
def fastest_turn(limits: Limits, speed: float) -> float:
    """Largest turn rate [rad/s] at a speed [m/s]."""
    most = min(limits.max_turn_rate, limits.lateral_acceleration / max(abs(speed), 1e-3))
    return min(most, abs(speed) / limits.turning_radius) if limits.turning_radius > 0.0 else most


def within(limits: Limits, now: State, wanted: Twist, dt: float) -> Twist:
    """The wanted velocity as far as it can be reached within ``dt`` [s], and driven without sliding."""
    dv, dw = limits.acceleration * dt, limits.angular_acceleration * dt
    slowest = min(limits.min_speed, 0.0)  # who may not drive slowly may still stop
    speed = min(max(wanted.linear, now.speed - dv, slowest), now.speed + dv, limits.max_speed)
    side = min(max(wanted.lateral, now.side - dv, -limits.side_speed), now.side + dv, limits.side_speed)
    most = fastest_turn(limits, speed)
    turn = min(max(wanted.angular, now.turn_rate - dw), now.turn_rate + dw)
    return Twist(speed, min(max(turn, -most), most), side)
