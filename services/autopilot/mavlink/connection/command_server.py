"""The command protocol: COMMAND_LONG and COMMAND_INT alike, each answered by exactly one final COMMAND_ACK."""

import math
from collections.abc import Callable
from dataclasses import dataclass

from services.autopilot.mavlink.connection.line import Sender, VehicleConnection
from uvf.mavlink import dialect as mav
from uvf.mavlink.bounded import make_room
from uvf.mavlink.names import command_name

LARGEST = 1e9  # no parameter of any command means anything beyond
NOT_GIVEN = 2**31 - 1  # x or y of a COMMAND_INT without a place
SCALE = 1e-7  # deg per unit of x and y
REPEATED_WITHIN = 1.0  # s, of a COMMAND_INT: two tries of MAVSDK
CONFIRMED_WITHIN = 5.0  # s between two tries of a COMMAND_LONG: QGroundControl's are 3 s apart
MOST_SENDERS, MOST_COMMANDS = 64, 32
REMEMBERED_FOR = 10.0  # s: longer than anybody repeats, and than a command waits for its outcome


@dataclass(frozen=True)
class ReceivedCommand:
    """A received command. p: seven parameters, NaN = not given; p[4] and p[5] in degrees; frame: None for a COMMAND_LONG."""

    number: int
    p: tuple[float, ...]
    frame: int | None
    sender: Sender
    confirmation: int = 0

    @classmethod
    def from_long(cls, m: mav.MAVLink_command_long_message, sender: Sender) -> "ReceivedCommand":
        """The command of a COMMAND_LONG."""
        p = (m.param1, m.param2, m.param3, m.param4, m.param5, m.param6, m.param7)
        return cls(m.command, p, None, sender, m.confirmation)

    @classmethod
    def from_int(cls, m: mav.MAVLink_command_int_message, sender: Sender) -> "ReceivedCommand":
        """The command of a COMMAND_INT; x and y become degrees."""
        x, y = (math.nan if v == NOT_GIVEN else v * SCALE for v in (m.x, m.y))
        return cls(m.command, (m.param1, m.param2, m.param3, m.param4, x, y, m.z), m.frame, sender)

    @property
    def absurd(self) -> int | None:
        """The number, from 1, of the first parameter that is infinite or beyond any meaning; None if all make sense."""
        return next((n for n, v in enumerate(self.p, 1) if not (math.isnan(v) or abs(v) <= LARGEST)), None)

    def same_as(self, other: "ReceivedCommand") -> bool:
        """Whether number, sender and parameters are the same (NaN equals NaN)."""
        return (self.number, self.sender, repr(self.p)) == (other.number, other.sender, repr(other.p))


@dataclass
class Pending:
    """A command and its outcome, so that a repetition is answered and not executed again."""

    command: ReceivedCommand
    t: float
    """s, wall: when it came."""
    result: int | None = None
    confirmation: int = 0
    heard: float = -math.inf
    """Of the newest repetition, or of the command itself: its count, and when [s, wall]."""

    def __post_init__(self) -> None:
        self.hear(self.command, self.t)

    def hear(self, command: ReceivedCommand, t: float) -> None:
        """Notes a repetition at ``t`` [s, wall]."""
        self.confirmation, self.heard = command.confirmation, t


class Acknowledger:
    """Acknowledges one command once."""

    def __init__(self, line: VehicleConnection, pending: Pending) -> None:
        self._line = line
        self._pending = pending

    def __call__(self, result: int, why: str = "") -> None:
        """The final answer; ``why`` is said to who has asked, unless it was accepted."""
        self._pending.result = result
        acknowledge(self._line, self._pending.command, result)
        if why and result != mav.MAV_RESULT_ACCEPTED:
            self._line.text(mav.MAV_SEVERITY_WARNING, why, self._pending.command.sender.peer)

    def outcome(self, prefix: str) -> Callable[[bool, str], None]:
        """A callback for ``VehicleConnection.ask``: accepted, or temporarily rejected with the autopilot's reason."""

        def done(accepted: bool, reason: str) -> None:
            if accepted:
                self(mav.MAV_RESULT_ACCEPTED)
            else:
                self(mav.MAV_RESULT_TEMPORARILY_REJECTED, f"{prefix}: {reason or 'refused'}")

        return done


def acknowledge(line: VehicleConnection, command: ReceivedCommand, result: int) -> None:
    """Sends a COMMAND_ACK to the sender of a command."""
    to = command.sender
    line.send(mav.MAVLink_command_ack_message(command.number, result, 0, 0, to.system, to.component), to.peer)


Handler = Callable[[VehicleConnection, ReceivedCommand, Acknowledger], None]


class CommandServer:
    """Executes commands. handlers: by MAV_CMD; any other command is UNSUPPORTED."""

    def __init__(self, line: VehicleConnection, handlers: dict[int, Handler]) -> None:
        self._line = line
        self._handlers = handlers
        self._last: dict[Sender, dict[int, Pending]] = {}
        """The newest of each command, by number, of each sender."""

    def on_long(self, message: mav.MAVLink_command_long_message, sender: Sender) -> None:
        """Executes a COMMAND_LONG."""
        self._execute(ReceivedCommand.from_long(message, sender))

    def on_int(self, message: mav.MAVLink_command_int_message, sender: Sender) -> None:
        """Executes a COMMAND_INT."""
        self._execute(ReceivedCommand.from_int(message, sender))

    def on_cancel(self, message: mav.MAVLink_command_cancel_message, sender: Sender) -> None:
        """Handles COMMAND_CANCEL: what was asked of the autopilot cannot be recalled.

        A command that waits gets its own answer, which is the only one.
        """
        last = self._last.get(sender, {}).get(message.command)
        if last is not None and last.result is None:
            return
        ack = mav.MAVLink_command_ack_message(message.command, mav.MAV_RESULT_UNSUPPORTED, 0, 0, sender.system, sender.component)
        self._line.send(ack, sender.peer)

    def forget(self) -> None:
        """Drops commands that nobody will repeat any more."""
        since = self._line.t - REMEMBERED_FOR
        for sender, mine in list(self._last.items()):
            self._last[sender] = {number: pending for number, pending in mine.items() if pending.heard > since}
            if not self._last[sender]:
                del self._last[sender]

    def _remember(self, pending: Pending) -> None:
        """A command that waits for its outcome, or a sender with one, makes room after all others."""
        sender, number = pending.command.sender, pending.command.number
        make_room(self._last, sender, MOST_SENDERS, lambda who: max((p.result is None, p.t) for p in self._last[who].values()))
        mine = self._last.setdefault(sender, {})
        make_room(mine, number, MOST_COMMANDS, lambda other: (mine[other].result is None, mine[other].t))
        mine[number] = pending

    def _execute(self, command: ReceivedCommand) -> None:
        if self._is_repetition(command):
            return
        pending = Pending(command, self._line.t)
        self._remember(pending)
        done = Acknowledger(self._line, pending)
        handler = self._handlers.get(command.number)
        if handler is None:
            done(mav.MAV_RESULT_UNSUPPORTED)
        elif (n := command.absurd) is not None:
            why = f"parameter {n} is {command.p[n - 1]:.4g}: name a number within {LARGEST:g}, or NaN to leave it out"
            done(mav.MAV_RESULT_DENIED, f"{command_name(command.number)} refused: {why}")
        else:
            handler(self._line, command, done)

    def _is_repetition(self, command: ReceivedCommand) -> bool:
        """A sender repeats when the answer was late or lost: COMMAND_LONG counts ``confirmation`` up, COMMAND_INT cannot.

        A count that does not go up is another command, however high it is: taken for a repetition it would be
        acknowledged and not be done.
        """
        last, t = self._last.get(command.sender, {}).get(command.number), self._line.t
        if last is None or not last.command.same_as(command):
            return False
        if command.frame is not None:
            repeats = t - last.t < REPEATED_WITHIN
        else:
            repeats = command.confirmation > last.confirmation and t - last.heard <= CONFIRMED_WITHIN
        if last.result is None or repeats:
            last.hear(command, t)
        if last.result is None:
            return True  # no "in progress": MAVSDK takes it for a refusal, and version 4 ends its program at the answer that follows
        if repeats:
            acknowledge(self._line, command, last.result)
        return repeats
