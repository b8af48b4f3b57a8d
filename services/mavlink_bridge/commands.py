"""Commands to an autopilot: sent again while it is silent, answered by its COMMAND_ACK, a refusal with the words it has for it."""

import math
from collections import deque
from dataclasses import dataclass

from services.mavlink_bridge.connection import TEXT_WITHIN, Done, Wire
from services.mavlink_bridge.station import COMPONENT, SYSTEM
from uvf.mavlink import dialect as mav

ANSWER_WITHIN = 4.5  # s: whoever asks over the bus hears nothing after 5
AGAIN_AFTER = 0.8  # s; autopilots take a repetition (confirmation > 0) for the same command
TRIES = 4
IN_PROGRESS_FOR = 3.0  # s, after which a command that was "in progress" is asked for again
LONGEST = 60.0  # s, after which one that is "in progress" still has failed
WAITING_MOST = 32
"""Commands of one number."""
RESULTS = {
    mav.MAV_RESULT_TEMPORARILY_REJECTED: "not now",
    mav.MAV_RESULT_DENIED: "denied",
    mav.MAV_RESULT_UNSUPPORTED: "the autopilot does not know this command",
    mav.MAV_RESULT_FAILED: "it failed",
    mav.MAV_RESULT_CANCELLED: "cancelled",
    mav.MAV_RESULT_COMMAND_LONG_ONLY: "the autopilot takes it only as COMMAND_LONG",
    mav.MAV_RESULT_COMMAND_INT_ONLY: "the autopilot takes it only as COMMAND_INT",
    mav.MAV_RESULT_COMMAND_UNSUPPORTED_MAV_FRAME: "the autopilot does not take places in this frame",
}
NAN = math.nan


@dataclass
class PendingCommand:
    """A command that waits. p: parameters 1 to 7, NaN = left out.

    frame: of a COMMAND_INT, whose parameters 5 and 6 are degrees; None = COMMAND_LONG.
    """

    number: int
    p: tuple[float, ...]
    done: Done
    frame: int | None = None
    begun: float = 0.0
    sent_at: float = -math.inf
    wait: float = AGAIN_AFTER
    tries: int = 0
    until: float = math.inf
    """If its turn comes later [s], it is not sent any more."""
    refused: str = ""
    """Why, once it is; its words are still waited for."""
    overtaken: bool = False
    """It is not repeated; its answer is waited for only because it could not be told from that to the one behind it."""


def command(number: int, p: tuple[float, ...], done: Done, frame: int | None = None) -> PendingCommand:
    """A command with parameters ``p`` (k,) [units of the MAV_CMD]; those left out at the end are NaN."""
    return PendingCommand(number, (*p, *(NAN,) * (7 - len(p))), done, frame)


class CommandSender:
    """Sends commands; one at a time of each number, for an ACK names nothing else. The others wait for their turn."""

    def __init__(self, wire: Wire) -> None:
        self._wire = wire
        self._queues: dict[int, deque[PendingCommand]] = {}

    def ask(self, asked: PendingCommand, patience: float = ANSWER_WITHIN) -> None:
        """Queues a command; patience: how long it may wait for its turn [s], for a vehicle must not obey what was given up long ago."""
        queue = self._queues.setdefault(asked.number, deque())
        if len(queue) >= WAITING_MOST:
            asked.done(False, f"{WAITING_MOST} commands of this kind wait for the autopilot already: ask again later, and less often")
            return
        asked.until = self._wire.t + patience
        queue.append(asked)
        self.tick()

    def ask_first(self, asked: PendingCommand) -> None:
        """Sends a command at once, ahead of those that wait, which are dropped: to hold, to disarm."""
        queue = self._queues.setdefault(asked.number, deque())
        under_way = [each for each in queue if each.tries]
        unsent = [each for each in queue if not each.tries]
        self._queues[asked.number] = deque((*under_way, asked))
        for each in under_way:
            each.overtaken, each.wait = True, AGAIN_AFTER
        if under_way:
            self._wire.send(self._message(asked))  # and again when its turn comes: only then an ACK is its own
        for each in unsent:
            each.done(False, "not sent: a command to hold or to disarm came first")
        self.tick()

    def on_ack(self, message: mav.MAVLink_command_ack_message) -> None:
        """Handles COMMAND_ACK, only of own commands: an autopilot answers other stations, too."""
        queue = self._queues.get(message.command)
        if not queue or queue[0].tries == 0 or queue[0].refused or not _for_us(message):
            return
        asked = queue[0]
        if message.result == mav.MAV_RESULT_IN_PROGRESS and self._wire.t - asked.begun > LONGEST:
            self._end(asked, False, f"the autopilot says that it is in progress, for more than {LONGEST:g} s")
        elif message.result == mav.MAV_RESULT_IN_PROGRESS:
            asked.sent_at, asked.wait = self._wire.t, AGAIN_AFTER if asked.overtaken else IN_PROGRESS_FOR
        elif message.result == mav.MAV_RESULT_ACCEPTED:
            self._end(asked, True, "")
        else:
            asked.refused = RESULTS.get(message.result, f"result {message.result}")
            asked.sent_at = self._wire.t
            self.tick()

    def tick(self) -> None:
        """Repeats commands without an answer, and ends those that were refused."""
        for queue in list(self._queues.values()):
            if not queue:
                continue  # or it is empty by now: whoever hears of an end may ask for something else
            asked = queue[0]
            silent = self._wire.t - asked.sent_at
            if asked.refused:
                words = self._wire.worry_since(asked.begun)
                if words or silent >= TEXT_WITHIN:
                    self._end(asked, False, f"{asked.refused}: {words}" if words else asked.refused)
            elif silent >= asked.wait:
                self._try(asked)

    def _try(self, asked: PendingCommand) -> None:
        if asked.overtaken:
            self._end(asked, False, "not sent again: a command to hold or to disarm came after it")
            self.tick()
            return
        if asked.tries >= TRIES:
            self._end(asked, False, f"no answer from the autopilot within {self._wire.t - asked.begun:.1f} s")
            return
        if asked.tries == 0 and self._wire.t > asked.until:
            self._end(asked, False, "it was not sent: the autopilot was busy with earlier commands of this kind")
            return
        if asked.tries == 0:
            asked.begun = self._wire.t
        self._wire.send(self._message(asked))
        asked.tries += 1
        asked.sent_at, asked.wait = self._wire.t, AGAIN_AFTER

    def _message(self, asked: PendingCommand) -> mav.MAVLink_message:
        system, component = self._wire.system, self._wire.component
        if asked.frame is None:
            return mav.MAVLink_command_long_message(system, component, asked.number, asked.tries, *asked.p)
        x, y = (round(v * 1e7) if math.isfinite(v) else 2**31 - 1 for v in asked.p[4:6])
        p1, p2, p3, p4 = asked.p[:4]
        return mav.MAVLink_command_int_message(system, component, asked.frame, asked.number, 0, 0, p1, p2, p3, p4, x, y, asked.p[6])

    def _end(self, asked: PendingCommand, accepted: bool, reason: str) -> None:
        self._queues[asked.number].popleft()
        asked.done(accepted, reason)

    def give_up(self, reason: str) -> None:
        """Refuses all open commands."""
        queues, self._queues = self._queues, {}
        for asked in (asked for queue in queues.values() for asked in queue):
            asked.done(False, reason)


def _for_us(message: mav.MAVLink_command_ack_message) -> bool:
    """Older autopilots leave the addressee out."""
    return message.target_system in (0, SYSTEM) and message.target_component in (0, COMPONENT)
