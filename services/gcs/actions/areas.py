"""What a browser can ask for of the areas that are drawn for a vehicle: fence, rally points, a field to survey."""

from dataclasses import dataclass
from typing import Annotated, Literal

import msgspec

from services.gcs.actions.page import Metres, Name, PageAction
from services.gcs.actions.plans import Index

Part = Literal["fence", "rally", "survey"]


@dataclass(frozen=True)
class PlanPart(PageAction):
    """Show this part of the tab Plan, by its label."""

    label: Name


@dataclass(frozen=True)
class OfArea(PageAction):
    """Base of these actions. vehicle: for whom it is drawn."""

    vehicle: Name


@dataclass(frozen=True)
class AreaAdd(OfArea):
    """Add a corner, or a rally point, at x, y [m, world]."""

    part: Part
    x: Metres
    y: Metres


@dataclass(frozen=True)
class AreaMove(OfArea):
    """Move a corner of a ring to x, y [m, world]."""

    part: Part
    ring: Index
    index: Index
    x: Metres
    y: Metres


@dataclass(frozen=True)
class AreaDrop(OfArea):
    """Take a corner out."""

    part: Part
    ring: Index
    index: Index


@dataclass(frozen=True)
class AreaSet(OfArea):
    """Set a number of an area: height, floor, ceiling [m, world], radius [m] of the chosen circle, overlaps; none takes a limit away."""

    part: Part
    field: Literal["height", "floor", "ceiling", "radius", "sidelap", "frontlap"]
    value: Metres | None


@dataclass(frozen=True)
class ZoneBegin(OfArea):
    """Begin another zone of the fence."""

    kind: Literal["keep in", "keep out", "circle in", "circle out"]


@dataclass(frozen=True)
class ZoneChoose(OfArea):
    """The next corners belong to this zone."""

    ring: Index


@dataclass(frozen=True)
class ZoneEnd(OfArea):
    """Take a zone out."""

    ring: Index


@dataclass(frozen=True)
class FenceActs(OfArea):
    """What the vehicle does at its fence."""

    action: Annotated[str, msgspec.Meta(max_length=10)]


@dataclass(frozen=True)
class AreaTake(OfArea):
    """Begin anew with what is in force."""

    part: Part


@dataclass(frozen=True)
class AreaClear(OfArea):
    """Take all corners out."""

    part: Part


@dataclass(frozen=True)
class AreaUpload(OfArea):
    """Put what is drawn into force."""

    part: Literal["fence", "rally"]


@dataclass(frozen=True)
class SurveyMake(OfArea):
    """Make a mission of the field."""
