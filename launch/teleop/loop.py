"""The loop of ``uvf teleop``, whatever is driven or flown: keys as they come, gamepad and commands at a fixed rate."""

from collections.abc import Callable
from typing import Protocol

from schemas import topics
from uvf.control.teleop_drive import GamepadState

PERIOD = 1 / topics.DRIVE.hz  # s between commands
END = "x"  # the key
SHOW_EVERY = 4  # commands between two refreshments of the line


class Console(Protocol):
    """Where keys come from and the status line goes to."""

    def read(self, patience: float) -> list[str]:
        """Keys pressed, waiting at most ``patience`` [s]."""
        ...

    def show(self, line: str) -> None:
        """Shows the status line."""
        ...


class Padlike(Protocol):
    """A gamepad, or what stands in for one."""

    @property
    def name(self) -> str:
        """Name of the gamepad; "" while there is none."""
        ...

    def read(self) -> GamepadState:
        """Present state of the gamepad."""
        ...


class Post(Protocol):
    """The operator's control post of one or more vehicles."""

    def take_over(self) -> str:
        """Asks for mode MANUAL and arms; what was refused and why, "" if nothing."""

    def key(self, t: float, name: str) -> None:
        """Handles a key pressed at ``t`` [s]."""
        ...

    def turn(self, t: float, pad: GamepadState) -> None:
        """Takes the gamepad as it is at ``t`` [s], and sends the commands that are due."""

    def line(self, t: float, pad: str) -> str:
        """Status line at ``t`` [s]. pad: the gamepad's name."""

    def leave(self) -> None:
        """Gives up control of the vehicles."""
        ...


def operate(post: Post, console: Console, pad: Padlike, clock: Callable[[], float]) -> None:
    """Runs the post until the key x or an exception, and leaves it in every case. clock: seconds, monotonic."""
    note = post.take_over()
    due, turn = clock(), 0
    try:
        while True:
            keys = console.read(max(due - clock(), 0.0))
            t = clock()
            if END in (pressed := {name.lower() for name in keys}):
                return
            for name in keys:
                post.key(t, name)
            if "m" in pressed:
                note = post.take_over()
            if t < due:
                continue
            post.turn(t, pad.read())
            if turn % SHOW_EVERY == 0:
                console.show((f"{note} | " if note else "") + post.line(t, pad.name))  # first, for a narrow terminal cuts the end
            due, turn = t + PERIOD, turn + 1
    finally:
        post.leave()
