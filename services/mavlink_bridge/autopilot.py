"""One autopilot at the far end: its link, what is asked of it, and what the bus is told of it."""

import math
from collections.abc import Callable, Sequence
from typing import Any

from schemas.messages import Event, MissionProgress, VehicleStatus
from services.mavlink_bridge.commands import CommandSender
from services.mavlink_bridge.connecting import Connecting
from services.mavlink_bridge.connection import StatusText, Wire
from services.mavlink_bridge.frame import BridgeOrigin, Chart
from services.mavlink_bridge.modes import Modes
from services.mavlink_bridge.parameters import ParameterClient
from services.mavlink_bridge.plan_book import PlanBook
from services.mavlink_bridge.refusals import LinkRefusals
from services.mavlink_bridge.station import LOST_AFTER
from services.mavlink_bridge.status import Told, progress_of, status_of
from services.mavlink_bridge.telemetry import Telemetry
from services.mavlink_bridge.transfers import Transfers
from uvf.mavlink import dialect as mav
from uvf.mavlink.text_bucket import TEXTS_PER_SECOND, TextBucket

BOOT_BACK = 2000  # ms: a clock that goes back by more has started anew
RESTARTS_APART = 5.0  # s: clocks that jump to and fro are none
PLACED_APART = 1.0  # s, between two places of home for which the plans are told anew
PLANS_AFTER = 2.0  # s after the connection, at the latest: before, the autopilot may say which plans it can have
CLOCKS = (mav.MAVLINK_MSG_ID_GLOBAL_POSITION_INT, mav.MAVLINK_MSG_ID_ATTITUDE, mav.MAVLINK_MSG_ID_ATTITUDE_QUATERNION)
SEVERITY = {
    mav.MAV_SEVERITY_EMERGENCY: Event.CRITICAL,
    mav.MAV_SEVERITY_ALERT: Event.CRITICAL,
    mav.MAV_SEVERITY_CRITICAL: Event.CRITICAL,
    mav.MAV_SEVERITY_ERROR: Event.ERROR,
    mav.MAV_SEVERITY_WARNING: Event.WARNING,
    mav.MAV_SEVERITY_NOTICE: Event.NOTICE,
    mav.MAV_SEVERITY_INFO: Event.INFO,
    mav.MAV_SEVERITY_DEBUG: Event.INFO,
}


class Autopilot:
    """One autopilot at the far end: its link, the requests to it, and what is published of it."""

    def __init__(self, system: int, component: int, heartbeat: mav.MAVLink_heartbeat_message, origin: BridgeOrigin) -> None:
        self.wire = Wire(system, component)
        self.commands = CommandSender(self.wire)
        self.transfers = Transfers(self.wire)
        self.parameters = ParameterClient(self.wire)
        self.events: list[tuple[Event.Severity, str]] = []
        self.refusals = LinkRefusals(self.say)
        self.telemetry = Telemetry(self.refusals.refuse)
        self.is_ardupilot = heartbeat.autopilot == mav.MAV_AUTOPILOT_ARDUPILOTMEGA
        self.parameters.bytewise = not self.is_ardupilot
        self.modes = Modes(heartbeat.autopilot, heartbeat.type)
        self.told = Told(self.wire, self.telemetry, self.modes, heartbeat)
        self.first = 1 if self.is_ardupilot else 0
        """Where its mission begins: ArduPilot keeps home in item 0."""
        self.plans = PlanBook(self.transfers, self.telemetry, self.first, self.say)
        self.is_lost = True
        self._heard_at = -math.inf
        self._origin = origin
        self._connecting = Connecting(self.wire, self.commands, self.modes)
        self._plans_due: float | None = None
        self._reached = -1
        self._home: tuple[float, float, float] | None = None
        """For which the plans have been written out: their heights are above it."""
        self._placed_at = -math.inf
        self._boot_ms = 0
        self._started_at = -math.inf
        self._texts = TextBucket(self.wire.t)
        self._handlers = self._merged()

    def _merged(self) -> dict[int, list[Callable[[Any], None]]]:
        own: dict[int, Callable[[Any], None]] = {
            mav.MAVLINK_MSG_ID_HEARTBEAT: self._on_heartbeat,
            mav.MAVLINK_MSG_ID_COMMAND_ACK: self.commands.on_ack,
            mav.MAVLINK_MSG_ID_STATUSTEXT: self._on_text,
            mav.MAVLINK_MSG_ID_MISSION_ITEM_REACHED: self._on_reached,
            mav.MAVLINK_MSG_ID_MISSION_CURRENT: self.plans.on_current,
            **dict.fromkeys(CLOCKS, self._on_clock),
        }
        merged: dict[int, list[Callable[[Any], None]]] = {}
        parts = (self.telemetry.handlers(), self.transfers.handlers(), self.parameters.handlers(), self._connecting.handlers(), own)
        for handlers in parts:
            for number, handler in handlers.items():
                merged.setdefault(number, []).append(handler)
        return merged

    @property
    def chart(self) -> Chart | None:
        """The vehicle's world frame; None before it is known where the world lies."""
        return self.plans.chart

    def say(self, severity: Event.Severity, text: str) -> None:
        """Queues an event to be published."""
        self.events.append((severity, text))

    def step(self, t: float, messages: Sequence[mav.MAVLink_message]) -> None:
        """Handles the messages received until ``t`` [s, wall], and goes on with what is under way."""
        self.wire.t = self.telemetry.t = t
        for message in messages:
            for handler in self._handlers.get(message.get_msgId(), ()):
                handler(message)
        for text in self.wire.unfinished_texts():
            self._say_text(text)
        self._watch_link()
        self._find_place()
        if self._plans_due is not None and (self._connecting.capabilities or t >= self._plans_due):
            self._plans_due = None
            self.plans.read_all(self._connecting.capabilities)
        self.commands.tick()
        self.transfers.tick()
        self.parameters.tick()

    def _on_heartbeat(self, message: mav.MAVLink_heartbeat_message) -> None:
        self.told.heartbeat = message
        self._heard_at = self.wire.t
        if self.is_lost:
            self.is_lost = False
            self.say(Event.NOTICE, f"in touch with system {self.wire.system}")
            self._connect()

    def _connect(self) -> None:
        self._connecting.begin()
        self._plans_due = self.wire.t + PLANS_AFTER

    def _watch_link(self) -> None:
        if not self.is_lost and self.wire.t - self._heard_at > LOST_AFTER:
            self.is_lost = True
            self.say(Event.ERROR, f"link lost: no heartbeat for {LOST_AFTER:g} s")
            self.give_up("the link was lost")

    def give_up(self, reason: str) -> None:
        """Refuses all open requests."""
        self._plans_due = None
        self.commands.give_up(reason)
        self.transfers.give_up(reason)
        self.parameters.give_up(reason)

    def _on_clock(self, message: Any) -> None:
        """Its own clock, which goes back only when it starts anew."""
        went_back = message.time_boot_ms < self._boot_ms - BOOT_BACK and not self.is_lost
        if went_back and self.wire.t - self._started_at < RESTARTS_APART:
            self.refusals.refuse("the time since its start", "it goes to and fro")
        elif went_back:
            self._started_at = self.wire.t
            self.say(Event.WARNING, "the autopilot has started anew")
            self.give_up("the autopilot has started anew")
            self.telemetry.forget()
            self._reached = -1
            self._connect()
        self._boot_ms = message.time_boot_ms

    def _on_text(self, message: mav.MAVLink_statustext_message) -> None:
        for text in self.wire.hear_text(message):
            self._say_text(text)

    def _say_text(self, text: StatusText) -> None:
        if not text.text:
            return
        if not self._texts.take(self.wire.t):
            self.refusals.refuse("STATUSTEXT", f"there are more than {TEXTS_PER_SECOND:g} each second, of which the others are left out")
            return
        self.say(SEVERITY.get(text.severity, Event.WARNING), text.text)

    def _on_reached(self, message: mav.MAVLink_mission_item_reached_message) -> None:
        self._reached = message.seq

    def _find_place(self) -> None:
        """Without a site, home is where the world begins."""
        home = self.telemetry.home
        if home is not None and self._origin.settle(*home):
            self.say(Event.NOTICE, f"no site is given: the world begins at home, {home[0]:.6f}, {home[1]:.6f}, {home[2]:.1f} m")
        tangent = self._origin.tangent
        waits = self.wire.t - self._placed_at < PLACED_APART
        if tangent is not None and (self.chart is None or (home != self._home and not waits)):
            self._home, self._placed_at = home, self.wire.t
            self.plans.place(Chart(tangent, self.told.heartbeat.type == mav.MAV_TYPE_GROUND_ROVER))

    def status(self) -> VehicleStatus:
        """The vehicle's status as a message."""
        status = status_of(self.told, self.chart, self.first)
        if self.plans.mission is not None:
            status.waypoint = min(status.waypoint, len(self.plans.mission.items))
        if self.is_lost:
            silence = self.wire.t - self._heard_at
            words = f"link lost: no heartbeat for {silence:.0f} s" if math.isfinite(silence) else "link lost"
            status.failsafes.append(words)
            status.reason = words
        return status

    def progress(self) -> MissionProgress | None:
        """The mission's progress as a message; None while the mission is unknown."""
        mission = self.plans.mission
        if mission is None:
            return None
        return progress_of(self.told, len(mission.items), mission.id, self.first, self._reached)
