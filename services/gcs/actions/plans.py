"""What a browser can ask for of the mission that is drawn for a vehicle."""

from dataclasses import dataclass
from typing import Annotated, Literal

import msgspec

from services.gcs.actions.page import Metres, Name, PageAction

FILE_MOST = 48_000  # characters of a plan file
Index = Annotated[int, msgspec.Meta(ge=0, le=1000)]


@dataclass(frozen=True)
class OfPlan(PageAction):
    """Base of these actions. vehicle: whose mission."""

    vehicle: Name


@dataclass(frozen=True)
class PlanAdd(OfPlan):
    """Add an item of a kind (``plan_draft.KINDS``) at x, y [m, world]."""

    kind: Name
    x: Metres
    y: Metres


@dataclass(frozen=True)
class PlanSet(OfPlan):
    """Set a field of an item (``plan_draft.FIELDS``) to a value [SI units]."""

    index: Index
    field: Name
    value: Metres


@dataclass(frozen=True)
class PlanMove(OfPlan):
    """Move an item to x, y [m, world]."""

    index: Index
    x: Metres
    y: Metres


@dataclass(frozen=True)
class PlanRemove(OfPlan):
    """Take an item out."""

    index: Index


@dataclass(frozen=True)
class PlanShift(OfPlan):
    """Exchange an item with the one before or after it."""

    index: Index
    by: Literal[-1, 1]


@dataclass(frozen=True)
class PlanChoose(OfPlan):
    """Show the fields of an item."""

    index: Index


@dataclass(frozen=True)
class PlanTake(OfPlan):
    """Begin anew with the mission that is in force."""


@dataclass(frozen=True)
class PlanClear(OfPlan):
    """Take all items out."""


@dataclass(frozen=True)
class PlanUpload(OfPlan):
    """Put the drawn mission into force."""


@dataclass(frozen=True)
class PlanGoTo(OfPlan):
    """Go on with this item of the mission in force."""

    index: Index


@dataclass(frozen=True)
class PlanLoad(OfPlan):
    """Draw what a file holds, in place of what is drawn."""

    name: Name
    text: Annotated[str, msgspec.Meta(max_length=FILE_MOST + 1)]
