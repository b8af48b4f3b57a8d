"""What is known of a drawn mission before it is flown: its line, length and time, whether it can be flown, and what is flown otherwise."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from services.gcs.state.plans.plan_draft import PLACED, PlanDraft
from uvf.guidance import flyable
from uvf.guidance.mission_preview import MissionPreview, places_passed
from uvf.models.vehicle.flight_params import AirParams
from uvf.runtime.messages.plans.plan_items import plan_items

Floats = NDArray[np.float64]

MOST_ADVICE = 6


@dataclass
class PlanOutlook:
    """The outlook for one state of a draft."""

    edits: int
    """Of the draft that it is about."""
    places: Floats = field(default_factory=lambda: np.zeros((0, 3)))
    """(n, 3) m, world: the items that have a place, in their order."""
    fault: str = ""
    """Why it cannot be flown; empty if it can."""
    advice: tuple[tuple[str, str], ...] = ()
    """(what, why) of what is flown otherwise than it is drawn."""
    line: Floats = field(default_factory=lambda: np.zeros((0, 3)))
    """(n, 3) m, world: the path that will be flown, as far as it has been worked out."""
    s: Floats = field(default_factory=lambda: np.zeros(0))
    """(n,) m over ground from its first point."""
    passed: tuple[tuple[int, float, float], ...] = ()
    """(item, distance [m], height [m]) where each item is done."""
    length: float = 0.0
    """m"""
    time: float = 0.0
    """s"""
    goes_on: bool = False
    """Whether the mission does not end by itself."""
    is_flown: bool = False
    is_checked: bool = False
    """Whether it is known if it can be flown."""

    def check(self, draft: PlanDraft, params: AirParams) -> None:
        """Finds out whether an aircraft can fly it, and what of it otherwise than drawn; takes a while for hundreds of items."""
        self.is_checked = True
        try:
            items = plan_items(draft.items)
        except ValueError as error:
            self.fault = str(error)
            return
        self.fault = flyable.fault(items, params)
        if not self.fault:
            self.advice = tuple(flyable.advice(items, params))[:MOST_ADVICE]

    def show(self, flown: MissionPreview) -> None:
        """Takes what has been flown ahead by now."""
        self.line = flown.points[:, (1, 0, 2)]
        self.passed = tuple(places_passed(flown))
        self.s = flown.s
        self.length = float(self.s[-1]) if len(self.s) else 0.0
        self.time = float(flown.t[-1]) if len(flown.t) else 0.0
        self.goes_on = flown.goes_on


def outlook_of(draft: PlanDraft, flies: bool) -> PlanOutlook:
    """What can be told of a draft at once; of a ground vehicle, which drives from place to place, that is all."""
    placed = [item.position for item in draft.items if item.kind in PLACED]
    outlook = PlanOutlook(draft.edits, np.array([(p.x, p.y, p.z) for p in placed]).reshape(-1, 3))
    if not flies:
        outlook.length = float(np.hypot(*np.diff(outlook.places[:, :2], axis=0).T).sum())
        outlook.is_flown = outlook.is_checked = True
    return outlook
