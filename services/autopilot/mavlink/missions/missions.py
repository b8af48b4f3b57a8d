"""The mission protocol for mission, fence and rally points: upload as a transaction, download in any order, clear, set current."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from services.autopilot.mavlink.commands.actions import set_current
from services.autopilot.mavlink.commands.guided import goal_of_item
from services.autopilot.mavlink.connection.line import Sender, VehicleConnection, named
from services.autopilot.mavlink.missions.old_items import as_int
from services.autopilot.mavlink.missions.plans import FencePlan, MissionPlan, Plan, RallyPlan
from uvf.mavlink import dialect as mav
from uvf.mavlink.bounded import make_room
from uvf.runtime.mavlink.mission_items import BadItem, Body

MISSION = mav.MAV_MISSION_TYPE_MISSION
ASK_AGAIN = 0.25  # s
TRIES = 8
TOLD_WITHIN = 4.0  # s, wall: plans are told when an autopilot starts, and kept for who comes later
ASKED_FOR = 10.0  # s: QGroundControl asks six times, every 1.5 s
MOST_WAITING = 64
UPLOAD_WITHIN = 10.0  # s, wall: after which another station may upload instead of one that does not come to an end
GUIDED = 2  # in the field `current` of an item: not part of a plan, fly there now


@dataclass
class Upload:
    """An upload in progress; the old plan stays in force until the autopilot has accepted the new one."""

    sender: Sender
    kind: int
    count: int
    since: float
    """s: when its sender began; whoever begins again and again has begun once."""
    asked_at: float
    items: list[Any] = field(default_factory=list)
    tries: int = 1
    is_complete: bool = False
    is_over: bool = False
    """Without success: kept for the time at which it began."""


@dataclass
class Shown:
    """The plan that somebody downloads, as of its MISSION_COUNT, whatever another station uploads meanwhile."""

    bodies: list[Body]
    asked_at: float


class Missions:
    """The mission protocol of one vehicle, for its mission, fence and rally points."""

    def __init__(self, line: VehicleConnection) -> None:
        self._line = line
        self._plans: dict[int, Plan[Any]] = {
            MISSION: MissionPlan(line),
            mav.MAV_MISSION_TYPE_FENCE: FencePlan(line),
            mav.MAV_MISSION_TYPE_RALLY: RallyPlan(line),
        }
        self._uploads: dict[int, Upload] = {}
        """The newest of each kind of plan, until it has succeeded."""
        self._waiting: dict[tuple[Sender, int], float] = {}
        """Who has asked for a plan that is not known yet, and when [s]."""
        self._shown: dict[tuple[Sender, int], Shown] = {}
        """Who downloads a plan."""
        self._reporting: float | None = None
        """Since when [s] the autopilot has been heard."""

    def handlers(self) -> dict[int, Callable[[Any, Sender], None]]:
        """Handlers of the mission protocol, by message id."""
        return {
            mav.MAVLINK_MSG_ID_MISSION_COUNT: self.on_count,
            mav.MAVLINK_MSG_ID_MISSION_ITEM_INT: self.on_item,
            mav.MAVLINK_MSG_ID_MISSION_ITEM: lambda message, sender: self.on_item(as_int(message), sender),
            mav.MAVLINK_MSG_ID_MISSION_REQUEST_LIST: self.on_request_list,
            mav.MAVLINK_MSG_ID_MISSION_REQUEST_INT: self.on_request,
            mav.MAVLINK_MSG_ID_MISSION_REQUEST: self.on_request,
            mav.MAVLINK_MSG_ID_MISSION_ACK: self.on_ack,
            mav.MAVLINK_MSG_ID_MISSION_CLEAR_ALL: self.on_clear,
            mav.MAVLINK_MSG_ID_MISSION_WRITE_PARTIAL_LIST: self.on_write_partial,
            mav.MAVLINK_MSG_ID_MISSION_SET_CURRENT: self.on_set_current,
        }

    def on_count(self, message: mav.MAVLink_mission_count_message, sender: Sender) -> None:
        """Handles MISSION_COUNT: an upload begins."""
        kind, plan = message.mission_type, self._plans.get(message.mission_type)
        if plan is None:
            self._ack(sender, mav.MAV_MISSION_UNSUPPORTED, kind)
        elif self._is_free(kind, sender):
            if message.count > plan.largest:
                self._refuse(sender, BadItem(mav.MAV_MISSION_NO_SPACE, f"{message.count} items; {plan.largest} are possible"), kind)
                return
            self._uploads[kind] = Upload(sender, kind, message.count, self._since(kind, sender), self._line.t)
            self._proceed(self._uploads[kind])

    def _open(self, kind: int) -> Upload | None:
        upload = self._uploads.get(kind)
        return None if upload is None or upload.is_over else upload

    def _since(self, kind: int, sender: Sender) -> float:
        """When a sender began to upload: without success, and never long without a word."""
        t, before = self._line.t, self._uploads.get(kind)
        return before.since if before is not None and before.sender == sender and t - before.asked_at <= UPLOAD_WITHIN else t

    def _is_free(self, kind: int, sender: Sender, asked: int | None = None) -> bool:
        """Whether a sender may replace a plan now; whoever takes too long makes room for another, and is told.

        asked: the kind that is answered, where it is all of them.
        """
        busy, name = self._open(kind), self._plans[kind].name
        if busy is None or (busy.sender == sender and not busy.is_complete):
            return True
        if busy.sender != sender and not busy.is_complete and self._line.t - busy.since >= UPLOAD_WITHIN:
            busy.is_over = True
            self._ack(busy.sender, mav.MAV_MISSION_OPERATION_CANCELLED, kind)
            why = f"{name} upload ended after {UPLOAD_WITHIN:g} s: {named(sender, busy.sender)} uploads now"
            self._line.text(mav.MAV_SEVERITY_WARNING, why, busy.sender.peer)
            return True
        self._ack(sender, mav.MAV_MISSION_DENIED, kind if asked is None else asked)
        who = f"{named(busy.sender, sender)} uploads" if busy.sender != sender else "the autopilot is still taking the one before"
        self._line.text(mav.MAV_SEVERITY_WARNING, f"{name} refused: {who}", sender.peer)
        return False

    def on_item(self, message: mav.MAVLink_mission_item_int_message, sender: Sender) -> None:
        """Handles an item: duplicates are ignored, out-of-order items repeat the request for the expected one."""
        upload = self._open(message.mission_type)
        if message.current == GUIDED and message.mission_type == MISSION:
            goal_of_item(self._line, message, lambda accepted, reason: self._guided(sender, accepted, reason))
            return
        if upload is None or upload.is_complete or upload.sender != sender:
            return
        if message.seq > len(upload.items):
            self._request_next(upload)
        elif message.seq == len(upload.items):
            self._accept(upload, message)

    def _accept(self, upload: Upload, message: mav.MAVLink_mission_item_int_message) -> None:
        try:
            upload.items.append(self._plans[upload.kind].read(message))
        except BadItem as bad:
            upload.is_over = True
            self._refuse(upload.sender, BadItem(bad.result, f"item {message.seq}: {bad.reason}"), upload.kind)
            return
        upload.tries = 0
        self._proceed(upload)

    def _proceed(self, upload: Upload) -> None:
        if len(upload.items) < upload.count:
            self._request_next(upload)
            return
        upload.is_complete = True
        plan = self._plans[upload.kind]
        try:
            made = plan.made(upload.items)
        except BadItem as bad:
            upload.is_over = True
            self._refuse(upload.sender, bad, upload.kind)
            return

        def done(accepted: bool, reason: str) -> None:
            if not accepted:
                upload.is_over = True
                result = mav.MAV_MISSION_INVALID if reason.startswith("item ") else mav.MAV_MISSION_ERROR
                self._refuse(upload.sender, BadItem(result, reason or "refused"), upload.kind)
                return
            self._uploads.pop(upload.kind, None)
            self._shown.pop((upload.sender, upload.kind), None)
            plan.accept(made)
            self._ack(upload.sender, mav.MAV_MISSION_ACCEPTED, upload.kind, plan.id_of(made))
            if note := plan.note(upload.items):
                self._line.text(mav.MAV_SEVERITY_WARNING, note)

        self._line.ask(plan.call, plan.request(made), done)

    def _request_next(self, upload: Upload) -> None:
        upload.asked_at = self._line.t
        upload.tries += 1
        _, system, component = upload.sender
        request = mav.MAVLink_mission_request_int_message(system, component, len(upload.items), upload.kind)
        self._line.send(request, upload.sender.peer)

    def tick(self) -> None:
        """Reports plans that have become known; requests missing items again, and gives up in the end."""
        if self._reporting is None and self._line.latest.status is not None:
            self._reporting = self._line.t
        self._waiting = {who: t for who, t in self._waiting.items() if self._line.t - t < ASKED_FOR}
        self._shown = {who: shown for who, shown in self._shown.items() if self._line.t - shown.asked_at < ASKED_FOR}
        self._count()
        for upload in self._uploads.values():
            if not upload.is_over and not upload.is_complete and self._line.t - upload.asked_at >= ASK_AGAIN - 1e-9:
                self._ask_again(upload)

    def _ask_again(self, upload: Upload) -> None:
        if upload.tries < TRIES:
            self._request_next(upload)
            return
        upload.is_over = True
        self._ack(upload.sender, mav.MAV_MISSION_OPERATION_CANCELLED, upload.kind)

    def on_request_list(self, message: mav.MAVLink_mission_request_list_message, sender: Sender) -> None:
        """Handles MISSION_REQUEST_LIST once the plan is known: no station would ask again after a count of 0."""
        kind = message.mission_type
        if kind not in self._plans:
            self._ack(sender, mav.MAV_MISSION_UNSUPPORTED, kind)
            return
        make_room(self._waiting, (sender, kind), MOST_WAITING, lambda who: self._waiting[who])
        self._waiting[sender, kind] = self._line.t
        self._count()

    def _count(self) -> None:
        """MISSION_COUNT to who has asked for a plan that is known by now."""
        for sender, kind in list(self._waiting):
            plan = self._plans[kind]
            if plan.is_told or self._is_settled:
                del self._waiting[sender, kind]
                make_room(self._shown, (sender, kind), MOST_WAITING, lambda who: self._shown[who].asked_at)
                self._shown[sender, kind] = Shown(plan.bodies, self._line.t)
                found = len(plan.bodies), kind, plan.id_of(plan.now)
                self._line.send(mav.MAVLink_mission_count_message(sender.system, sender.component, *found), sender.peer)

    @property
    def _is_settled(self) -> bool:
        """The autopilot has been heard for so long that a plan which it has not told is none."""
        return self._reporting is not None and self._line.t - self._reporting >= TOLD_WITHIN

    def on_request(self, message: mav.MAVLink_mission_request_int_message, sender: Sender) -> None:
        """Answers MISSION_REQUEST_INT, or the older MISSION_REQUEST, with the item."""
        kind, seq = message.mission_type, message.seq
        in_force = self._plans[kind].bodies if kind in self._plans else []
        shown = self._shown.get((sender, kind))
        if shown is not None:
            shown.asked_at = self._line.t
        bodies = shown.bodies if shown is not None else in_force
        if seq >= len(bodies):
            self._ack(sender, mav.MAV_MISSION_INVALID_SEQUENCE, kind)
            return
        progress = self._line.latest.progress
        current = int(kind == MISSION and bodies is in_force and progress is not None and progress.current == seq)
        frame, command, autocontinue, p1, p2, p3, p4, x, y, z = bodies[seq]
        head = (sender.system, sender.component, seq, frame, command, current, autocontinue)
        self._line.send(mav.MAVLink_mission_item_int_message(*head, p1, p2, p3, p4, x, y, z, kind), sender.peer)

    def on_ack(self, message: mav.MAVLink_mission_ack_message, sender: Sender) -> None:
        """Handles MISSION_ACK: it ends a download; anything but "accepted" ends the sender's own upload too."""
        self._shown.pop((sender, message.mission_type), None)
        upload = self._open(message.mission_type)
        if upload is not None and not upload.is_complete and upload.sender == sender and message.type != mav.MAV_MISSION_ACCEPTED:
            upload.is_over = True

    def on_clear(self, message: mav.MAVLink_mission_clear_all_message, sender: Sender) -> None:
        """Clears the plans, one after the other: QGroundControl clears all three within a millisecond, and asks once."""
        kind = message.mission_type
        if kind not in (*self._plans, mav.MAV_MISSION_TYPE_ALL):
            self._ack(sender, mav.MAV_MISSION_UNSUPPORTED, kind)
            return
        kinds = list(self._plans) if kind == mav.MAV_MISSION_TYPE_ALL else [kind]
        busy = [upload for each in kinds if (upload := self._open(each)) is not None]
        if all(upload.sender == sender or self._is_free(upload.kind, sender, kind) for upload in busy):
            for upload in busy:
                upload.is_over = upload.is_over or not upload.is_complete
            self._clear([self._plans[each] for each in kinds], sender, kind)

    def _clear(self, plans: list[Plan[Any]], sender: Sender, kind: int) -> None:
        """One after the other, with one answer, which is the first refusal if there is one."""
        plan, *others = plans
        empty = plan.made([])

        def done(accepted: bool, reason: str) -> None:
            if not accepted:
                self._refuse(sender, BadItem(mav.MAV_MISSION_ERROR, reason), kind)
                return
            plan.accept(empty)
            self._shown.pop((sender, plan.kind), None)
            if others:
                self._clear(others, sender, kind)
            else:
                self._ack(sender, mav.MAV_MISSION_ACCEPTED, kind)

        self._line.ask(plan.call, plan.request(empty), done)

    def on_write_partial(self, message: mav.MAVLink_mission_write_partial_list_message, sender: Sender) -> None:
        """Refuses MISSION_WRITE_PARTIAL_LIST as unsupported."""
        self._ack(sender, mav.MAV_MISSION_UNSUPPORTED, message.mission_type)

    def on_set_current(self, message: mav.MAVLink_mission_set_current_message, sender: Sender) -> None:
        """Handles MISSION_SET_CURRENT; a refusal is reported as STATUSTEXT."""
        set_current(self._line, message.seq, self._line.refusal("Set waypoint"))

    def _guided(self, sender: Sender, accepted: bool, reason: str) -> None:
        if accepted:
            self._ack(sender, mav.MAV_MISSION_ACCEPTED, MISSION)
        else:
            self._refuse(sender, BadItem(mav.MAV_MISSION_ERROR, f"go to refused: {reason}"), MISSION)

    def _refuse(self, sender: Sender, bad: BadItem, kind: int) -> None:
        self._ack(sender, bad.result, kind)
        name = self._plans[kind].name if kind in self._plans else "Plan"
        self._line.text(mav.MAV_SEVERITY_WARNING, f"{name} refused: {bad.reason}", sender.peer)

    def _ack(self, to: Sender, result: int, kind: int, opaque_id: int = 0) -> None:
        self._line.send(mav.MAVLink_mission_ack_message(to.system, to.component, result, kind, opaque_id), to.peer)
