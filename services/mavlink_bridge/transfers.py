"""The mission protocol as a client: plans up and down, one after the other, however many packets are lost."""

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from services.mavlink_bridge.connection import TEXT_WITHIN, Wire
from services.mavlink_bridge.station import COMPONENT, SYSTEM
from uvf.mavlink import dialect as mav
from uvf.runtime.mavlink.mission_items import ORIGIN, Body, packed, unpacked

LIST_AGAIN, ITEM_AGAIN = 0.8, 0.4  # s
TRIES = 10
SILENT_FOR = 5.0  # s, after which an upload has failed: the autopilot asks for what it wants
STANDS_FOR = 30.0  # s, after which it has failed, too: always the same items are asked for
ACK_WITHIN = 1.5  # s after the last item was sent; then the plan is read back, to see what has become of it
LARGEST = 5000  # items
WAITING_MOST = 8
"""Plans that are being read or written."""
RESULTS = {
    mav.MAV_MISSION_ERROR: "the autopilot did not take it",
    mav.MAV_MISSION_UNSUPPORTED_FRAME: "an altitude or place in a frame that it does not know",
    mav.MAV_MISSION_UNSUPPORTED: "an item that it does not know",
    mav.MAV_MISSION_NO_SPACE: "too many items",
    mav.MAV_MISSION_INVALID: "an item that makes no sense to it",
    mav.MAV_MISSION_INVALID_SEQUENCE: "items out of order",
    mav.MAV_MISSION_DENIED: "denied: perhaps another ground station is at it",
    mav.MAV_MISSION_OPERATION_CANCELLED: "cancelled by the autopilot",
} | {mav.MAV_MISSION_INVALID + n: f"parameter {n} of an item is out of range" for n in range(1, 8)}

Read = Callable[[list[Body] | None, str, int], None]
"""Called once with the items, or None and the reason, and the plan's opaque id (0: not told)."""


@dataclass
class Download:
    """A plan being downloaded."""

    kind: int
    done: Read
    count: int = -1
    opaque_id: int = 0
    items: list[Body] = field(default_factory=list)
    sent_at: float = 0.0
    tries: int = 0


@dataclass
class UploadTransfer:
    """A plan being uploaded."""

    kind: int
    items: Sequence[Body]
    done: Callable[[bool, str, int], None]
    """(accepted, reason, opaque id)."""
    begun: float = 0.0
    asked_at: float | None = None
    """When the autopilot has asked for an item last; None: not yet."""
    farthest: int = -1
    """The last item that has been asked for."""
    got_on_at: float = 0.0
    """When it was asked for first."""
    last_sent: float | None = None
    """When the last item of all went out."""
    sent_at: float = 0.0
    tries: int = 0
    refused: str = ""


class Transfers:
    """The mission protocol of a client; plans are transferred one after the other."""

    def __init__(self, wire: Wire) -> None:
        self._wire = wire
        self._queue: deque[Download | UploadTransfer] = deque()

    def handlers(self) -> dict[int, Callable[[Any], None]]:
        """Handlers of the mission protocol, by message id."""
        return {
            mav.MAVLINK_MSG_ID_MISSION_COUNT: self._on_count,
            mav.MAVLINK_MSG_ID_MISSION_ITEM_INT: self._on_item,
            mav.MAVLINK_MSG_ID_MISSION_REQUEST_INT: self._on_request,
            mav.MAVLINK_MSG_ID_MISSION_REQUEST: self._on_request,
            mav.MAVLINK_MSG_ID_MISSION_ACK: self._on_ack,
        }

    def read(self, kind: int, done: Read) -> None:
        """Downloads a plan."""
        self._queue.append(Download(kind, done))
        self.tick()

    def write(self, kind: int, items: Sequence[Body], done: Callable[[bool, str, int], None]) -> None:
        """Uploads a plan; ``done`` hears (accepted, reason, opaque id)."""
        if len(items) > LARGEST:
            done(False, f"a plan of {len(items)} items: at most {LARGEST} go over the bridge", 0)
        elif len(self._queue) >= WAITING_MOST:
            done(False, f"{WAITING_MOST} plans are being read or written already: ask again later, and less often", 0)
        else:
            self._queue.append(UploadTransfer(kind, items, done, self._wire.t))
            self.tick()

    def give_up(self, reason: str) -> None:
        """Ends all transfers without success."""
        queue, self._queue = self._queue, deque()
        for job in queue:
            self._tell(job, reason)

    def tick(self) -> None:
        """Continues the current transfer."""
        job = self._queue[0] if self._queue else None
        if isinstance(job, Download):
            self._pull(job)
        elif job is not None:
            self._push(job)

    def _pull(self, job: Download) -> None:
        """Asks for what is missing; again, when it does not come."""
        if job.tries and self._wire.t - job.sent_at < (LIST_AGAIN if job.count < 0 else ITEM_AGAIN) - 1e-9:
            return
        if job.tries >= TRIES:
            self._fail(job, "the autopilot does not send its plan")
            return
        job.tries += 1
        job.sent_at = self._wire.t
        to = self._wire.system, self._wire.component
        if job.count < 0:
            self._wire.send(mav.MAVLink_mission_request_list_message(*to, job.kind))
        else:
            self._wire.send(mav.MAVLink_mission_request_int_message(*to, len(job.items), job.kind))

    def _on_count(self, message: mav.MAVLink_mission_count_message) -> None:
        job = self._current(Download, message)
        if job is None or job.count >= 0:
            return
        if message.count > LARGEST:
            self._fail(job, f"a plan of {message.count} items")
            return
        job.count, job.opaque_id, job.tries = message.count, message.opaque_id, 0
        self._go_on(job)

    def _on_item(self, message: mav.MAVLink_mission_item_int_message) -> None:
        job = self._current(Download, message)
        if job is None or job.count < 0 or message.seq != len(job.items):
            return
        job.items.append(unpacked(packed(message)))
        job.tries = 0
        self._go_on(job)

    def _go_on(self, job: Download) -> None:
        if len(job.items) < job.count:
            self._pull(job)
            return
        self._ack(job.kind, mav.MAV_MISSION_ACCEPTED)
        self._queue.popleft()
        job.done(job.items, "", job.opaque_id)
        self.tick()

    def _push(self, job: UploadTransfer) -> None:
        now = self._wire.t
        if job.refused:
            words = self._wire.worry_since(job.begun)
            if words or now - job.sent_at > TEXT_WITHIN:
                self._fail(job, f"{job.refused}: {words}" if words else job.refused)
        elif job.asked_at is None:
            self._announce(job)
        elif job.last_sent is not None and now - job.last_sent > ACK_WITHIN:
            self._look_what_became(job)
        elif now - job.asked_at > SILENT_FOR:
            self._fail(job, f"the autopilot stopped asking for items {SILENT_FOR:g} s ago")
        elif now - job.got_on_at > STANDS_FOR:
            self._fail(job, f"for {STANDS_FOR:g} s the autopilot has asked for no item after item {job.farthest}")

    def _announce(self, job: UploadTransfer) -> None:
        """The count, or that there shall be no plan; again until the autopilot answers."""
        if job.tries and self._wire.t - job.sent_at < LIST_AGAIN - 1e-9:
            return
        if job.tries >= TRIES:
            self._fail(job, "the autopilot does not answer")
            return
        if not job.tries:
            job.begun = self._wire.t
        job.tries += 1
        job.sent_at = self._wire.t
        to = self._wire.system, self._wire.component
        if job.items:
            self._wire.send(mav.MAVLink_mission_count_message(*to, len(job.items), job.kind, 0))
        else:
            self._wire.send(mav.MAVLink_mission_clear_all_message(*to, job.kind))

    def _on_request(self, message: mav.MAVLink_mission_request_int_message) -> None:
        """Any item, in any order and as often as it is wanted."""
        job = self._current(UploadTransfer, message)
        if job is None or job.refused or message.seq >= len(job.items):
            return
        job.asked_at = self._wire.t
        if message.seq > job.farthest:
            job.farthest, job.got_on_at = message.seq, self._wire.t
        frame, command, autocontinue, p1, p2, p3, p4, x, y, z = job.items[message.seq]
        head = (self._wire.system, self._wire.component, message.seq, frame, command, int(message.seq == 0), autocontinue)
        self._wire.send(mav.MAVLink_mission_item_int_message(*head, p1, p2, p3, p4, x, y, z, job.kind))
        if message.seq == len(job.items) - 1:
            job.last_sent = self._wire.t

    def _on_ack(self, message: mav.MAVLink_mission_ack_message) -> None:
        reading = self._current(Download, message)
        if reading is not None and message.type != mav.MAV_MISSION_ACCEPTED:
            self._fail(reading, RESULTS.get(message.type, f"result {message.type}"))
            return
        job = self._current(UploadTransfer, message)
        if job is None or job.refused:
            return
        if message.type != mav.MAV_MISSION_ACCEPTED:
            job.refused = RESULTS.get(message.type, f"result {message.type}")
            job.sent_at = self._wire.t
            self._push(job)
        elif job.last_sent is not None or not job.items:
            self._queue.popleft()
            job.done(True, "", message.opaque_id)
            self.tick()

    def _look_what_became(self, job: UploadTransfer) -> None:
        """The last word was lost, perhaps: what the autopilot has now says it."""

        def seen(items: list[Body] | None, reason: str, opaque_id: int) -> None:
            same = items is not None and [ORIGIN.pack(*item) for item in items] == [ORIGIN.pack(*item) for item in job.items]
            job.done(same, "" if same else reason or "the autopilot has another plan than was sent", opaque_id)

        self._queue[0] = Download(job.kind, seen)
        self.tick()

    def _current(self, type_: type[Any], message: Any) -> Any:
        """The job that a message is about."""
        job = self._queue[0] if self._queue else None
        ours = message.target_system in (0, SYSTEM) and message.target_component in (0, COMPONENT)
        return job if isinstance(job, type_) and ours and message.mission_type == job.kind else None

    def _ack(self, kind: int, result: int) -> None:
        self._wire.send(mav.MAVLink_mission_ack_message(self._wire.system, self._wire.component, result, kind, 0))

    def _fail(self, job: Download | UploadTransfer, reason: str) -> None:
        self._queue.popleft()
        self._tell(job, reason)
        self.tick()

    def _tell(self, job: Download | UploadTransfer, reason: str) -> None:
        if isinstance(job, Download):
            job.done(None, reason, 0)
        else:
            job.done(False, reason, 0)
