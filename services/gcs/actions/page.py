"""What a browser can ask for: what changes its own view, and what goes to a vehicle or to all.

Each names the page that asks; words from a page are turned into these by their field types (``page.words``).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Literal

import msgspec
import numpy as np

Name = Annotated[str, msgspec.Meta(max_length=64)]
ServiceKey = Annotated[str, msgspec.Meta(max_length=96)]
Share = Annotated[float, msgspec.Meta(ge=-1.0, le=1.0)]
Metres = Annotated[float, msgspec.Meta(ge=-1e6, le=1e6)]
Degrees = Annotated[float, msgspec.Meta(ge=-360.0, le=360.0)]


@dataclass(frozen=True)
class PageAction:
    """Base of all actions. page: which browser asks."""

    page: int


@dataclass(frozen=True)
class Join(PageAction):
    """A browser has connected."""


@dataclass(frozen=True)
class Leave(PageAction):
    """A browser has disconnected."""


@dataclass(frozen=True)
class Hello(PageAction):
    """Who sits before the page, and which vehicle it showed before the connection was lost ("" at first)."""

    operator: Annotated[str, msgspec.Meta(pattern="^[0-9a-f]{32}$")]
    vehicle: Name


@dataclass(frozen=True)
class Beat(PageAction):
    """The page has shown this beat of the status bar: how old is what the operator sees."""

    beat: Annotated[str, msgspec.Meta(max_length=20)]


@dataclass(frozen=True)
class Select(PageAction):
    """Show this vehicle on the page."""

    vehicle: Name


@dataclass(frozen=True)
class FleetTable(PageAction):
    """Show the fleet as a table too, or no longer."""

    on: bool


@dataclass(frozen=True)
class OpenTab(PageAction):
    """The page shows this tab."""

    tab: Name


@dataclass(frozen=True)
class Dress(PageAction):
    """The page is light or dark."""

    theme: Literal["light", "dark"]


@dataclass(frozen=True)
class Shape(PageAction):
    """The page's 3-D view has this width over height [-]; touched: somebody has turned it by hand."""

    aspect: Annotated[float, msgspec.Meta(ge=0.05, le=20.0)]
    touched: bool


@dataclass(frozen=True)
class ChooseView(PageAction):
    """Look at the scene from a named view."""

    view: Name


@dataclass(frozen=True)
class Layer(PageAction):
    """Show or hide a layer of the scene on a page."""

    name: Name
    on: bool


@dataclass(frozen=True)
class ShowCamera(PageAction):
    """Show a camera of the vehicle on the page: image, chase or gimbal."""

    name: Name


@dataclass(frozen=True)
class Looking(PageAction):
    """The page reports that the camera picture is visible."""


@dataclass(frozen=True)
class FilterTopics(PageAction):
    """List topics whose key, type or services contain this text."""

    text: Name


@dataclass(frozen=True)
class ScopeTopics(PageAction):
    """List the topics of the vehicle on show, all, or those that something is wrong with."""

    scope: Literal["vehicle", "all", "problems"]


@dataclass(frozen=True)
class ShowService(PageAction):
    """List the topics of a service (``owner/name``), or of the bundle that leads ``to`` another one; "" for all."""

    node: ServiceKey
    to: ServiceKey


@dataclass(frozen=True)
class ShowTopic(PageAction):
    """Show the newest message of a key; "" for none."""

    key: Annotated[str, msgspec.Meta(max_length=200)]


@dataclass(frozen=True)
class ClickGround(PageAction):
    """A click that hit no vehicle: its ray (origin [m], direction), world frame."""

    origin: tuple[float, float, float]
    direction: tuple[float, float, float]


@dataclass(frozen=True)
class Point(PageAction):
    """What is to be done at the place that was clicked: one of ``pointing.TOOLS``; "" closes the menu."""

    tool: Name


@dataclass(frozen=True)
class Command(PageAction):
    """A command of ``offers``, by its key, to a vehicle."""

    vehicle: Name
    key: Name


@dataclass(frozen=True)
class StopAll(PageAction):
    """Engage STOP ALL."""


@dataclass(frozen=True)
class ReleaseStop(PageAction):
    """Release STOP ALL."""


@dataclass(frozen=True)
class RequestControl(PageAction):
    """Ask for control of a vehicle that another operator controls."""

    vehicle: Name


@dataclass(frozen=True)
class AnswerControl(PageAction):
    """Give control of a vehicle to the operator that asks for it, or keep it."""

    vehicle: Name
    give: bool


@dataclass(frozen=True)
class TakeWheel(PageAction):
    """Drive the vehicle by hand from this page."""

    vehicle: Name


@dataclass(frozen=True)
class LeaveWheel(PageAction):
    """End driving by hand from this page."""


@dataclass(frozen=True)
class Steer(PageAction):
    """Directions that a page holds: parts (-1..1) of the scales; turn and aside: to the left."""

    forward: Share
    turn: Share
    aside: Share


@dataclass(frozen=True)
class Rescale(PageAction):
    """Change the speeds at which the page drives; key: one of teleop_drive.SCALINGS."""

    key: Name


@dataclass(frozen=True)
class AimGimbal(PageAction):
    """Turn one axis of the gimbal to an angle, in degrees as the slider has it."""

    vehicle: Name
    axis: Literal["pan", "tilt"]
    degrees: Degrees


@dataclass(frozen=True)
class GimbalMode(PageAction):
    """What the gimbal's angles are relative to: one of ``wording.GIMBAL_MODES``."""

    vehicle: Name
    mode: Name


@dataclass(frozen=True)
class RunClock(PageAction):
    """Pause, resume, step or reset the simulation; a reset wants a second click."""

    what: Literal["pause", "resume", "step", "reset"]


@dataclass(frozen=True)
class SetRate(PageAction):
    """Simulation seconds per second; 0 = as fast as it goes."""

    rate: Annotated[float, msgspec.Meta(ge=0.0, le=100.0)]


@dataclass(frozen=True)
class WindForm:
    """What is written into the form: where the wind comes from [deg from north], and how fast [m/s]."""

    direction: Annotated[str, msgspec.Meta(max_length=20)]
    speed: Annotated[str, msgspec.Meta(max_length=20)]


@dataclass(frozen=True)
class SetWind(PageAction):
    """Let another mean wind blow."""

    form: WindForm


@dataclass(frozen=True)
class LaunchMission(PageAction):
    """End the mission that runs and start this one; wants a second click."""

    mission: Name


def ground_point(origin: Sequence[float], direction: Sequence[float]) -> tuple[float, float] | None:
    """Where a ray (origin (3,) [m], direction (3,), world) meets the ground z = 0: (x, y) [m, world]; None if it never does."""
    o, d = np.asarray(origin, dtype=float), np.asarray(direction, dtype=float)
    if o.shape != (3,) or d.shape != (3,) or not (np.isfinite(o).all() and np.isfinite(d).all()):
        return None
    if abs(d[2]) < 1e-9 or -o[2] / d[2] <= 0:
        return None
    hit = o - d * o[2] / d[2]
    return float(hit[0]), float(hit[1])
