"""What a browser can ask for: what changes its own view, and what goes to a vehicle or to all."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from schemas.messages import GimbalCommand


@dataclass(frozen=True)
class Join:
    """A browser has connected. page: here and below, which browser."""

    page: int


@dataclass(frozen=True)
class Leave:
    """A browser has disconnected."""

    page: int


@dataclass(frozen=True)
class Select:
    """Show this vehicle on the page."""

    page: int
    vehicle: str


@dataclass(frozen=True)
class ClickGround:
    """A click that hit no vehicle: its ray (origin [m], direction), world frame. vehicle: here and below, the one the page shows."""

    vehicle: str
    origin: tuple[float, float, float]
    direction: tuple[float, float, float]


@dataclass(frozen=True)
class Arm:
    """Arm or disarm the vehicle; carried out when it is asked for twice."""

    page: int
    vehicle: str
    arm: bool


@dataclass(frozen=True)
class SetMode:
    """Put the vehicle into a mode, by its name on the page."""

    vehicle: str
    mode: str


@dataclass(frozen=True)
class StopAll:
    """Engage STOP ALL, or release it."""

    engaged: bool


@dataclass(frozen=True)
class Layer:
    """Show or hide a layer of the scene on a page."""

    page: int
    name: str
    on: bool


@dataclass(frozen=True)
class Cancel:
    """Cancel the goal that the vehicle drives to."""

    vehicle: str


@dataclass(frozen=True)
class TakeWheel:
    """Drive the vehicle by hand from this page."""

    page: int
    vehicle: str


@dataclass(frozen=True)
class LeaveWheel:
    """End driving by hand from this page."""

    page: int


@dataclass(frozen=True)
class Steer:
    """Directions that a page holds: parts (-1..1) of the linear and the angular scale."""

    page: int
    forward: float
    left: float


@dataclass(frozen=True)
class Rescale:
    """Change the speeds at which the page drives; key: one of teleop_drive.SCALINGS."""

    page: int
    key: str


@dataclass(frozen=True)
class ShowCamera:
    """Show a camera of the vehicle on the page: image, chase or gimbal."""

    page: int
    name: str


@dataclass(frozen=True)
class Looking:
    """The page reports that the camera picture is visible."""

    page: int


@dataclass(frozen=True)
class AimGimbal:
    """Point the gimbal. vehicle: the one that the page was showing; pan and tilt [rad] and mode as in GimbalCommand."""

    vehicle: str
    pan: float
    tilt: float
    mode: GimbalCommand.Mode


Shown = Join | Leave | Select | Layer | ShowCamera | Looking
"""What changes only what is seen."""
Action = Shown | ClickGround | Arm | SetMode | StopAll | Cancel | TakeWheel | LeaveWheel | Steer | Rescale | AimGimbal


def ground_point(origin: Sequence[float], direction: Sequence[float]) -> tuple[float, float] | None:
    """Where a ray (origin (3,) [m], direction (3,), world) meets the ground z = 0: (x, y) [m, world]; None if it never does."""
    o, d = np.asarray(origin, dtype=float), np.asarray(direction, dtype=float)
    if o.shape != (3,) or d.shape != (3,) or not (np.isfinite(o).all() and np.isfinite(d).all()):
        return None
    if abs(d[2]) < 1e-9 or -o[2] / d[2] <= 0:
        return None
    hit = o - d * o[2] / d[2]
    return float(hit[0]), float(hit[1])
