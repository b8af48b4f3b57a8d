"""The mission protocol: upload as a transaction, download in any order, clear, set current.

Fence and rally points are not enforced, so they are not claimed: their lists are empty and stay so.
"""

from dataclasses import dataclass, field

from schemas.messages import Mission, MissionItem, MissionRequest
from services.autopilot.mavlink import dialect as mav
from services.autopilot.mavlink.actions import SOURCE, set_current
from services.autopilot.mavlink.guided import goal_of_item
from services.autopilot.mavlink.line import Line, Sender
from services.autopilot.mavlink.mission_items import BadItem, check_whole, from_wire, is_skipped, mission_of, to_wire

MISSION = mav.MAV_MISSION_TYPE_MISSION
PLANS = (mav.MAV_MISSION_TYPE_FENCE, mav.MAV_MISSION_TYPE_RALLY)
LARGEST = 500  # items
ASK_AGAIN = 0.25  # s
TRIES = 8
GUIDED = 2  # in the field `current` of an item: not part of a plan, fly there now


@dataclass
class Upload:
    """The old plan stays in force until the last item is in and the autopilot has taken the new one."""

    sender: Sender
    count: int
    asked_at: float
    items: list[MissionItem] = field(default_factory=list)
    skipped: bool = False
    tries: int = 1
    is_complete: bool = False


class Missions:
    def __init__(self, line: Line) -> None:
        self._line = line
        self._upload: Upload | None = None
        self._accepted: tuple[int, Mission] | None = None
        """(id of the plan that was published before, plan just taken): serves downloads until the autopilot's shows up."""

    @property
    def plan(self) -> Mission:
        published = self._line.latest.mission or Mission()
        if self._accepted is not None and published.id != self._accepted[0]:
            self._accepted = None
        return self._accepted[1] if self._accepted is not None else published

    @property
    def _home_z(self) -> float:
        """m, world; of the origin while home is unknown."""
        home = self._line.latest.home
        return float(home[2]) if home is not None else 0.0

    def on_count(self, message: mav.MAVLink_mission_count_message, sender: Sender) -> None:
        kind, line = message.mission_type, self._line
        busy = self._upload
        if kind in PLANS and message.count == 0:
            self._ack(sender, mav.MAV_MISSION_ACCEPTED, kind)
        elif kind != MISSION:
            self._refuse(sender, BadItem(mav.MAV_MISSION_UNSUPPORTED, "fence and rally points are not supported"), kind)
        elif busy is not None and (busy.is_complete or busy.sender[1:] != sender[1:]):
            self._ack(sender, mav.MAV_MISSION_DENIED, kind)
        elif message.count > LARGEST:
            self._refuse(sender, BadItem(mav.MAV_MISSION_NO_SPACE, f"{message.count} items; {LARGEST} are possible"), kind)
        else:
            self._upload = Upload(sender, message.count, line.t)
            self._proceed(self._upload)

    def on_item(self, message: mav.MAVLink_mission_item_int_message, sender: Sender) -> None:
        """Duplicates are ignored, items out of order bring the wanted one's request again."""
        upload = self._upload
        if message.current == GUIDED and message.mission_type == MISSION:
            goal_of_item(self._line, message, lambda accepted, reason: self._guided(sender, accepted, reason))
            return
        if upload is None or upload.is_complete or upload.sender[1:] != sender[1:] or message.mission_type != MISSION:
            return
        if message.seq > len(upload.items):
            self._request_next(upload)
        elif message.seq == len(upload.items):
            self._accept(upload, message)

    def _accept(self, upload: Upload, message: mav.MAVLink_mission_item_int_message) -> None:
        try:
            upload.items.append(from_wire(message, self._line.facts, self._home_z))
            if len(upload.items) == upload.count:
                check_whole(upload.items)
        except BadItem as bad:
            self._upload = None
            self._refuse(upload.sender, bad, MISSION)
            return
        upload.skipped |= is_skipped(message.command, self._line.facts)
        upload.tries = 0
        self._proceed(upload)

    def _proceed(self, upload: Upload) -> None:
        if len(upload.items) < upload.count:
            self._request_next(upload)
            return
        upload.is_complete = True
        plan = mission_of(upload.items)

        def done(accepted: bool, reason: str) -> None:
            self._upload = None
            if not accepted:
                self._refuse(upload.sender, BadItem(mav.MAV_MISSION_ERROR, reason or "refused"), MISSION)
                return
            before = self._line.latest.mission
            if before is None or before.id != plan.id:
                self._accepted = (before.id if before is not None else 0, plan)
            self._ack(upload.sender, mav.MAV_MISSION_ACCEPTED, MISSION, plan.id)
            if upload.skipped:
                self._line.text(mav.MAV_SEVERITY_WARNING, "Mission: camera and gimbal items are skipped")

        self._line.ask("set_mission", MissionRequest(mission=plan, source=SOURCE), done)

    def _request_next(self, upload: Upload) -> None:
        upload.asked_at = self._line.t
        upload.tries += 1
        _, system, component = upload.sender
        self._line.send(mav.MAVLink_mission_request_int_message(system, component, len(upload.items), MISSION), upload.sender.peer)

    def tick(self) -> None:
        """Asks again for an item that does not come, and gives up in the end."""
        upload = self._upload
        if upload is None or upload.is_complete or self._line.t - upload.asked_at < ASK_AGAIN - 1e-9:
            return
        if upload.tries < TRIES:
            self._request_next(upload)
            return
        self._upload = None
        self._ack(upload.sender, mav.MAV_MISSION_OPERATION_CANCELLED, MISSION)

    def on_request_list(self, message: mav.MAVLink_mission_request_list_message, sender: Sender) -> None:
        kind = message.mission_type
        if kind != MISSION and kind not in PLANS:
            self._ack(sender, mav.MAV_MISSION_UNSUPPORTED, kind)
            return
        plan = self.plan if kind == MISSION else Mission()
        count = mav.MAVLink_mission_count_message(sender.system, sender.component, len(plan.items), kind, plan.id)
        self._line.send(count, sender.peer)

    def on_request(self, message: mav.MAVLink_mission_request_int_message, sender: Sender) -> None:
        """MISSION_REQUEST_INT, or the older MISSION_REQUEST: the same item either way."""
        items = self.plan.items if message.mission_type == MISSION else ()
        if message.seq >= len(items):
            self._ack(sender, mav.MAV_MISSION_INVALID_SEQUENCE, message.mission_type)
            return
        progress = self._line.latest.progress
        current = int(progress is not None and progress.current == message.seq)
        frame, command, autocontinue, p1, p2, p3, p4, x, y, z = to_wire(items[message.seq], self._line.facts, self._home_z)
        head = (sender.system, sender.component, message.seq, frame, command, current, autocontinue)
        self._line.send(mav.MAVLink_mission_item_int_message(*head, p1, p2, p3, p4, x, y, z, MISSION), sender.peer)

    def on_ack(self, message: mav.MAVLink_mission_ack_message, sender: Sender) -> None:
        """Ends a download; anything but "accepted" ends the sender's own upload too."""
        upload = self._upload
        if upload is not None and not upload.is_complete and upload.sender[1:] == sender[1:] and message.type != mav.MAV_MISSION_ACCEPTED:
            self._upload = None

    def on_clear(self, message: mav.MAVLink_mission_clear_all_message, sender: Sender) -> None:
        kind = message.mission_type
        if kind in PLANS:
            self._ack(sender, mav.MAV_MISSION_ACCEPTED, kind)
        elif kind in (MISSION, mav.MAV_MISSION_TYPE_ALL):
            empty = mav.MAVLink_mission_count_message(0, 0, 0, MISSION)
            self.on_count(empty, sender)
        else:
            self._ack(sender, mav.MAV_MISSION_UNSUPPORTED, kind)

    def on_write_partial(self, message: mav.MAVLink_mission_write_partial_list_message, sender: Sender) -> None:
        self._ack(sender, mav.MAV_MISSION_UNSUPPORTED, message.mission_type)

    def on_set_current(self, message: mav.MAVLink_mission_set_current_message, sender: Sender) -> None:
        def done(accepted: bool, reason: str) -> None:
            if not accepted:
                self._line.text(mav.MAV_SEVERITY_WARNING, f"Set waypoint refused: {reason}")

        set_current(self._line, message.seq, done)

    def _guided(self, sender: Sender, accepted: bool, reason: str) -> None:
        if accepted:
            self._ack(sender, mav.MAV_MISSION_ACCEPTED, MISSION)
        else:
            self._refuse(sender, BadItem(mav.MAV_MISSION_ERROR, f"go to refused: {reason}"), MISSION)

    def _refuse(self, sender: Sender, bad: BadItem, kind: int) -> None:
        self._ack(sender, bad.result, kind)
        self._line.text(mav.MAV_SEVERITY_WARNING, f"Mission refused: {bad.reason}")

    def _ack(self, to: Sender, result: int, kind: int, opaque_id: int = 0) -> None:
        self._line.send(mav.MAVLink_mission_ack_message(to.system, to.component, result, kind, opaque_id), to.peer)
