"""Everything that one vehicle hears and says: messages to the protocols, telemetry by schedule, changes at once."""

import re
from collections.abc import Callable, Sequence
from typing import Any

from schemas.messages import Event
from services.autopilot.mavlink.commands.actions import ACTIONS, FENCE_SWITCH, on_set_mode
from services.autopilot.mavlink.commands.guided import GUIDED
from services.autopilot.mavlink.commands.manual import ManualControl
from services.autopilot.mavlink.commands.not_offered import NOT_OFFERED
from services.autopilot.mavlink.commands.not_offered import handlers as not_offered
from services.autopilot.mavlink.commands.orders import ORDERS, on_set_home_position, on_set_origin
from services.autopilot.mavlink.commands.setpoints import Setpoints
from services.autopilot.mavlink.connection.command_server import CommandServer
from services.autopilot.mavlink.connection.facts import VehicleInfo
from services.autopilot.mavlink.connection.line import Sender, VehicleConnection
from services.autopilot.mavlink.connection.statustext import SEVERITY, event_text
from services.autopilot.mavlink.missions.missions import Missions
from services.autopilot.mavlink.missions.reached import ReachedItems
from services.autopilot.mavlink.parameters.component_metadata import files_of
from services.autopilot.mavlink.parameters.ftp import FileServer
from services.autopilot.mavlink.parameters.parameter_store import Store
from services.autopilot.mavlink.parameters.parameters import ParameterServer
from services.autopilot.mavlink.queries import Queries
from services.autopilot.mavlink.telemetry.data_streams import set_rates
from services.autopilot.mavlink.telemetry.events import EventNews
from services.autopilot.mavlink.telemetry.health import health
from services.autopilot.mavlink.telemetry.identity import greeting
from services.autopilot.mavlink.telemetry.streams import Schedule
from services.autopilot.mavlink.telemetry.telemetry import STREAMS, mission_current
from uvf.mavlink import dialect as mav
from uvf.mavlink.endpoint import Peer

FIXED = {**ACTIONS, **GUIDED, **ORDERS, **FENCE_SWITCH, **NOT_OFFERED}
"""Commands whose handlers keep nothing."""
HEARTBEAT_WITHIN = 1.5  # s: one a second goes out
Handler = Callable[[Any, Sender], None]
ON_CHANGE = (
    mav.MAVLINK_MSG_ID_HEARTBEAT,
    mav.MAVLINK_MSG_ID_EXTENDED_SYS_STATE,
    mav.MAVLINK_MSG_ID_CURRENT_MODE,
    mav.MAVLINK_MSG_ID_FENCE_STATUS,
    mav.MAVLINK_MSG_ID_SYS_STATUS,
)


class VehicleLink:
    """The MAVLink protocols of one vehicle."""

    def __init__(self, facts: VehicleInfo, store: Store) -> None:
        self.line = VehicleConnection(facts)
        self.schedule = Schedule({number: stream.hz for number, stream in STREAMS.items()})
        self._parameters = ParameterServer(self.line, store)
        self.line.files = files_of(facts, self._parameters.table)
        self._ftp = FileServer(self.line, self.line.files)
        self._missions = Missions(self.line)
        self._by_hand = ManualControl(self.line)
        self._setpoints = Setpoints(self.line)
        queries = Queries(self.schedule).handlers()
        self._commands = CommandServer(self.line, {**FIXED, **queries, **self._parameters.commands()})
        self._handlers = self._all_handlers()
        self._state: tuple[object, ...] = ()
        self._item: tuple[object, ...] = ()
        self._home: tuple[float, ...] = ()
        self._reached = ReachedItems()
        self._complaints: tuple[str, ...] = ()
        self._news = EventNews()
        self._to_greet: dict[Peer, float] = {}
        """Who is new, and when [s] it has heard a heartbeat at the latest."""

    def _all_handlers(self) -> dict[int, Handler]:
        line = self.line
        parameters, commands = self._parameters, self._commands
        return {
            mav.MAVLINK_MSG_ID_COMMAND_LONG: commands.on_long,
            mav.MAVLINK_MSG_ID_COMMAND_INT: commands.on_int,
            mav.MAVLINK_MSG_ID_COMMAND_CANCEL: commands.on_cancel,
            mav.MAVLINK_MSG_ID_SET_HOME_POSITION: lambda m, sender: on_set_home_position(line, m),
            mav.MAVLINK_MSG_ID_SET_GPS_GLOBAL_ORIGIN: lambda m, sender: on_set_origin(line, m, sender),
            mav.MAVLINK_MSG_ID_SET_MODE: lambda m, sender: on_set_mode(line, m, sender),
            mav.MAVLINK_MSG_ID_PARAM_REQUEST_LIST: parameters.on_request_list,
            mav.MAVLINK_MSG_ID_PARAM_REQUEST_READ: parameters.on_request_read,
            mav.MAVLINK_MSG_ID_PARAM_SET: parameters.on_set,
            **self._missions.handlers(),
            mav.MAVLINK_MSG_ID_FILE_TRANSFER_PROTOCOL: self._ftp.on_ftp,
            mav.MAVLINK_MSG_ID_REQUEST_DATA_STREAM: lambda m, sender: set_rates(self.schedule, m, sender.peer),
            **self._by_hand.handlers(),
            **self._setpoints.handlers(),
            mav.MAVLINK_MSG_ID_PING: self._on_ping,
            mav.MAVLINK_MSG_ID_TIMESYNC: self._on_timesync,
            **not_offered(line),
        }

    def hear(self, message: mav.MAVLink_message, sender: Sender) -> None:
        """Handles a message for this vehicle."""
        if sender.peer in self._to_greet and getattr(message, "target_system", 0) == self.line.facts.system_id:
            self._greet(sender.peer)
        handler = self._handlers.get(message.get_msgId())
        if handler is not None:
            with self.line.hearing(sender.peer):
                handler(message, sender)

    def welcome(self, peer: Peer) -> None:
        """Greets a new peer: ground stations drop texts of a vehicle whose heartbeat they have not heard yet."""
        self._to_greet[peer] = self.line.t + HEARTBEAT_WITHIN

    def _greet(self, peer: Peer) -> None:
        """What this vehicle is, and why it should not arm."""
        del self._to_greet[peer]
        self.line.text(mav.MAV_SEVERITY_INFO, greeting(self.line.facts), peer)
        if self._parameters.note:
            self.line.text(mav.MAV_SEVERITY_WARNING, self._parameters.note, peer)
        for complaint in self._complaints:
            self.line.text(mav.MAV_SEVERITY_WARNING, f"PreArm: {complaint}", peer)

    def tick(self, peers: Sequence[Peer], events: Sequence[Event]) -> list[tuple[mav.MAVLink_message, list[Peer]]]:
        """The outgoing messages and their receivers, after the messages of this step have been heard."""
        line = self.line
        line.settle()
        self._parameters.tick()
        self._missions.tick()
        self._by_hand.tick()
        self._setpoints.tick()
        self._ftp.tick()
        for peer in [peer for peer, at in self._to_greet.items() if line.t >= at]:
            self._greet(peer)
        for event in self._news.of(line.latest, events):
            line.text(SEVERITY.get(event.severity, mav.MAV_SEVERITY_INFO), event_text(event))
        self._note_changes()
        out = line.take_out(peers)
        for number, to in self.schedule.due(line.t, peers):
            hearing = [peer for peer in to if line.tells(number, peer)]
            out += [(message, hearing) for message in STREAMS[number].messages(line.facts, line.latest, line.t)]
        return out

    def forget(self, peers: Sequence[Peer]) -> None:
        """Drops the message rates requested by peers that are gone."""
        self.schedule.forget(peers)
        self._parameters.forget(peers)
        self._to_greet = {peer: at for peer, at in self._to_greet.items() if peer in peers}
        self._commands.forget()

    def _note_changes(self) -> None:
        """Mode, arming, mission item and reasons against arming are told at once, not at their next turn."""
        status, progress = self.line.latest.status, self.line.latest.progress
        state = (status.mode, status.armed, status.landed, status.stopped, status.breach) if status is not None else ()
        if state != self._state:
            if status is not None and status.breach and not any(self._state[-1:]):
                self.line.latest.breached_at = self.line.t
            self._state = state
            self._hurry(*ON_CHANGE)
        home = tuple(self.line.latest.home) if self.line.latest.home is not None else ()
        if home != self._home:
            self._home = home
            self._hurry(mav.MAVLINK_MSG_ID_HOME_POSITION)
        item = (progress.current, progress.state, progress.mission_id) if progress is not None else ()
        if item != self._item:
            self._item = item
            self._hurry(mav.MAVLINK_MSG_ID_MISSION_CURRENT)
        self._note_reached()
        self._note_complaints()

    def _note_reached(self) -> None:
        progress, mission = self.line.latest.progress, self.line.latest.mission
        if progress is None or mission is None:
            return
        for index in self._reached.look(progress, mission.items):
            if index == progress.current:  # stations count the last item as done once they hear this of the one they take for current
                self.line.send(mission_current(self.line.latest))
            self.line.send(mav.MAVLink_mission_item_reached_message(index))

    def _note_complaints(self) -> None:
        latest = self.line.latest
        complaints = health(self.line.facts, latest).complaints if latest.status is not None else ()
        known, kinds = (tuple(map(_without_figures, some)) for some in (self._complaints, complaints))
        for complaint, kind in zip(complaints, kinds, strict=True):
            if kind not in known:
                self.line.text(mav.MAV_SEVERITY_WARNING, f"PreArm: {complaint}")
        self._complaints = complaints
        if kinds != known:
            self._hurry(mav.MAVLINK_MSG_ID_SYS_STATUS)

    def _hurry(self, *messages: int) -> None:
        for message in messages:
            self.schedule.hurry(message, self.line.t)

    def _on_ping(self, message: mav.MAVLink_ping_message, sender: Sender) -> None:
        if message.target_system == 0:
            reply = mav.MAVLink_ping_message(message.time_usec, message.seq, sender.system, sender.component)
            self.line.send(reply, sender.peer)

    def _on_timesync(self, message: mav.MAVLink_timesync_message, sender: Sender) -> None:
        if message.tc1 == 0:
            now = round(self.line.t * 1e9)
            self.line.send(mav.MAVLink_timesync_message(now, message.ts1, sender.system, sender.component), sender.peer)


def _without_figures(complaint: str) -> str:
    """A speed that is another one at each step is no new complaint."""
    return re.sub(r"[\d.]+", "", complaint)
