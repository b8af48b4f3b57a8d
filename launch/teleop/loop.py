"""The loop of ``uvf teleop``, whatever is driven or flown: keys as they come, gamepad and commands at a fixed rate."""

from collections.abc import Callable
from typing import Protocol

from schemas import topics
from uvf.control.teleop_drive import GamepadState

PERIOD = 1 / topics.DRIVE.hz  # s between commands
END = "x"  # the key
SHOW_EVERY = 4  # commands between two refreshments of the line


class Console(Protocol):
    def read(self, patience: float) -> list[str]: ...

    def show(self, line: str) -> None: ...


class Padlike(Protocol):
    @property
    def name(self) -> str: ...

    def read(self) -> GamepadState: ...


class Post(Protocol):
    """Where an operator sits."""

    def take_over(self) -> str:
        """Asks for mode MANUAL and arms; what was refused and why, "" if nothing."""

    def key(self, t: float, name: str) -> None: ...

    def turn(self, t: float, pad: GamepadState) -> None:
        """Takes the gamepad as it is now, and sends the commands that are due."""

    def line(self, t: float, pad: str) -> str:
        """What the operator sees. pad: the gamepad's name."""

    def leave(self) -> None: ...


def operate(post: Post, console: Console, pad: Padlike, clock: Callable[[], float]) -> None:
    """Until the key x, or an exception; in every case the post is left."""
    note = post.take_over()
    due, turn = clock(), 0
    try:
        while True:
            keys = console.read(max(due - clock(), 0.0))
            t = clock()
            if END in keys:
                return
            for name in keys:
                post.key(t, name)
            if "m" in keys:
                note = post.take_over()
            if t < due:
                continue
            post.turn(t, pad.read())
            if turn % SHOW_EVERY == 0:
                console.show((f"{note} | " if note else "") + post.line(t, pad.name))  # first, for a narrow terminal cuts the end
            due, turn = t + PERIOD, turn + 1
    finally:
        post.leave()
