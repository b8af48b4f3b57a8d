"""The autopilot's three plans as the bus knows them: read at connect and when somebody else has changed them, replaced on request."""

import math
from collections.abc import Callable
from typing import Any

from schemas.messages import Event, Fence, Mission, RallyPoints
from services.mavlink_bridge import plans
from services.mavlink_bridge.connection import Done
from services.mavlink_bridge.frame import Chart
from services.mavlink_bridge.telemetry import Telemetry
from services.mavlink_bridge.transfers import Transfers
from uvf.mavlink import dialect as mav
from uvf.runtime.mavlink.mission_items import BadItem, Body

MISSION, FENCE, RALLY = mav.MAV_MISSION_TYPE_MISSION, mav.MAV_MISSION_TYPE_FENCE, mav.MAV_MISSION_TYPE_RALLY
NAMES = {MISSION: "mission", FENCE: "fence", RALLY: "rally points"}
CAPABILITY = {
    MISSION: 0,
    FENCE: mav.MAV_PROTOCOL_CAPABILITY_MISSION_FENCE,
    RALLY: mav.MAV_PROTOCOL_CAPABILITY_MISSION_RALLY,
}
UNKNOWN = 0xFFFF
READ_APART = 1.0  # s, between two downloads of a plan, however often its id changes
Say = Callable[[Event.Severity, str], None]
Plan = Mission | Fence | RallyPoints


class PlanBook:
    """The plans of one autopilot; ``news`` are those not published yet, by output."""

    def __init__(self, transfers: Transfers, telemetry: Telemetry, first: int, say: Say) -> None:
        self._transfers, self._telemetry, self._say = transfers, telemetry, say
        self._scribe = plans.MissionScribe(first)
        self.chart: Chart | None = None
        self.mission: Mission | None = None
        self.news: dict[str, Plan] = {}
        self._bodies: dict[int, list[Body]] = {}
        self._ids: dict[int, int] = {}
        """Opaque id of each plan as it was read or written last."""
        self._total = 0
        self._reading: set[int] = set()
        self._read_at: dict[int, float] = {}

    @property
    def home_z(self) -> float:
        """Height z of home [m, world]; that of the origin while home is unknown."""
        home = self._telemetry.home
        return home[2] - self.chart.origin.altitude if home is not None and self.chart is not None else 0.0

    def read_all(self, capabilities: int) -> None:
        """Downloads the mission, and fence and rally points unless the capabilities exclude them; 0 = unknown."""
        for kind, needed in CAPABILITY.items():
            if not needed or not capabilities or capabilities & needed:
                self._read(kind)

    def _read(self, kind: int) -> None:
        if kind in self._reading:
            return
        self._reading.add(kind)
        self._read_at[kind] = self._telemetry.t

        def done(items: list[Body] | None, reason: str, opaque_id: int) -> None:
            self._reading.discard(kind)
            if items is not None:
                self._take(kind, items, opaque_id)
            elif kind == MISSION:
                self._say(Event.WARNING, f"its mission could not be read: {reason}")

        self._transfers.read(kind, done)

    def _take(self, kind: int, items: list[Body], opaque_id: int) -> None:
        self._bodies[kind] = items
        self._ids[kind] = opaque_id or self._ids.get(kind, 0)
        if kind == MISSION:
            self._total = len(items)
        self._write_out(kind)

    def place(self, chart: Chart) -> None:
        """Sets the world frame (anew), and publishes what has been read in it."""
        self.chart = chart
        self.tell_again()

    def _write_out(self, kind: int) -> None:
        if self.chart is None:
            return
        items = self._bodies[kind]
        try:
            if kind == MISSION:
                self.mission = self.news["mission"] = self._scribe.mission(items, self.chart, self.home_z)
            elif kind == FENCE:
                self.news["fence"] = plans.fence_read(items, self.chart, self.home_z)
            else:
                self.news["rally"] = plans.rally_read(items, self.chart, self.home_z)
        except BadItem as bad:
            self._say(Event.WARNING, f"its {NAMES[kind]} cannot be told: {bad.reason}")

    def on_current(self, message: mav.MAVLink_mission_current_message) -> None:
        """Downloads plans that somebody else has replaced: known by their id, or by the mission's length where there are no ids."""
        told = {MISSION: message.mission_id, FENCE: message.fence_id, RALLY: message.rally_points_id}
        for kind in [kind for kind in told if kind in self._ids and told[kind] != self._ids[kind] and self._is_due(kind)]:
            if any(self._ids.values()) or any(told.values()):
                self._ids[kind] = told[kind]
                self._read(kind)
        is_other = message.total not in (0, UNKNOWN, self._total, self._total - 1)
        if not any(told.values()) and is_other and MISSION in self._ids and self._is_due(MISSION):
            self._total = message.total
            self._read(MISSION)

    def _is_due(self, kind: int) -> bool:
        """Otherwise it is looked at again when the next id comes."""
        return kind not in self._reading and self._telemetry.t - self._read_at.get(kind, -math.inf) >= READ_APART

    def write(self, plan: Plan, done: Done) -> None:
        """Replaces a plan; it is published once the autopilot has it."""
        kind = MISSION if isinstance(plan, Mission) else FENCE if isinstance(plan, Fence) else RALLY
        if self.chart is None:
            done(False, "the autopilot has not told yet where it is")
            return
        try:
            bodies = self._bodies_of(plan, self.chart)
        except BadItem as bad:
            done(False, bad.reason)
            return

        def written(accepted: bool, reason: str, opaque_id: int) -> None:
            if accepted:
                self._take(kind, bodies, opaque_id)
            done(accepted, reason)

        self._transfers.write(kind, bodies, written)

    def _bodies_of(self, plan: Plan, chart: Chart) -> list[Body]:
        if isinstance(plan, Mission):
            self._check_home(any(item.HasField("position") for item in plan.items))
            return self._scribe.bodies(plan, chart, self._telemetry.home, self.home_z)
        if isinstance(plan, Fence):
            return plans.fence_bodies(plan, chart, self.home_z)
        self._check_home(bool(plan.points))
        return plans.rally_bodies(plan, chart, self.home_z)

    def _check_home(self, has_heights: bool) -> None:
        """Raises BadItem: heights are sent as above home, and would be wrong by the home's own."""
        if has_heights and self._telemetry.home is None:
            raise BadItem(mav.MAV_MISSION_ERROR, "the autopilot has not told its home yet, above which heights count: try again")

    def tell_again(self) -> None:
        """Publishes the plans again, as to a bus whose time has started over."""
        for kind in self._bodies:
            self._write_out(kind)

    def take_news(self) -> dict[str, Any]:
        """Takes the plans to be published, by output."""
        news, self.news = self.news, {}
        return news
