"""``uvf teleop``: ground vehicles driven from the keyboard of a terminal, or with a gamepad."""

import signal
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager
from types import FrameType
from typing import Protocol

import uvf
from schemas import topics
from schemas.messages import ArmRequest, DriveCommand, Mode, ModeRequest
from uvf.client import Client
from uvf.launch import settings
from uvf.launch.teleop_gamepad import Gamepad
from uvf.launch.teleop_terminal import TerminalClosed, key_by_key
from uvf.runtime.params import BadInput, nearest
from uvf.runtime.site import Site, load_site
from uvf.runtime.teleop_hand import STILL, Command, Hand, Pad

SOURCE = "teleop"
PERIOD = 1 / topics.DRIVE.hz  # s between commands
SHOW_EVERY = 4  # commands between two refreshments of the line
LOST_AFTER = 1.5  # s without a status
ANSWER_WITHIN = 1.0  # s
GREETING = """w a s d or arrows: drive    q e z c: curves    space: stop    x or Ctrl-C: end
r f: linear speed up, down    t g: turn rate up, down    1..9: vehicle on, off    m: take over again
gamepad: hold the left shoulder button and use the left stick; d-pad: speeds; B: stop"""


class Console(Protocol):
    def read(self, patience: float) -> list[str]: ...

    def show(self, line: str) -> None: ...


class Padlike(Protocol):
    @property
    def name(self) -> str: ...

    def read(self) -> Pad: ...


class Vehicles(Protocol):
    """The way to the vehicles."""

    def send(self, vehicle: str, command: Command) -> None: ...

    def take_over(self, vehicle: str) -> str:
        """Asks for mode MANUAL and arms; what was refused and why, "" if nothing."""

    def state(self, vehicle: str) -> str: ...


class Link:
    """Vehicles over the bus."""

    def __init__(self, client: Client) -> None:
        self._client = client
        self._count: dict[str, int] = {}
        self._heard_at: dict[str, float] = {}

    def send(self, vehicle: str, command: Command) -> None:
        self._client.send(vehicle, topics.DRIVE.by(SOURCE), DriveCommand(linear=command.linear, angular=command.angular))

    def take_over(self, vehicle: str) -> str:
        try:
            replies = (
                self._client.ask(vehicle, topics.SET_MODE, ModeRequest(mode=Mode.MODE_MANUAL, source=SOURCE), ANSWER_WITHIN),
                self._client.ask(vehicle, topics.ARM, ArmRequest(arm=True, source=SOURCE), ANSWER_WITHIN),
            )
        except TimeoutError as error:
            return f"{vehicle}: {error}"
        return next((f"{vehicle}: {reply.reason}" for reply in replies if not reply.accepted), "")

    def state(self, vehicle: str) -> str:
        """LIVE and whose commands count, or for how long nothing has been heard."""
        now, count = time.monotonic(), self._client.heard(vehicle, topics.STATUS)
        if count != self._count.get(vehicle, 0):
            self._count[vehicle], self._heard_at[vehicle] = count, now
        if vehicle not in self._heard_at:
            return "NO LINK"
        age = now - self._heard_at[vehicle]
        if age > LOST_AFTER:
            return f"LINK LOST {age:.0f} s"
        status = self._client.read(vehicle, topics.STATUS)
        return "LIVE STOP ALL" if status.stopped else f"LIVE {status.command_source or status.reason}"


def drive(hand: Hand, vehicles: Vehicles, console: Console, pad: Padlike, clock: Callable[[], float]) -> None:
    """Until the key x, or an exception; in every case all vehicles are told to stand."""
    note = _take_over(hand, vehicles)
    due, turn = clock(), 0
    try:
        while True:
            keys = console.read(max(due - clock(), 0.0))
            t = clock()
            if "x" in keys:
                return
            for name in keys:
                hand.key(t, name)
            if "m" in keys:
                note = _take_over(hand, vehicles)
            if t < due:
                continue
            hand.pad(t, pad.read())
            for name, command in hand.commands(t).items():
                vehicles.send(name, command)
            if turn % SHOW_EVERY == 0:
                console.show(status_line(hand, vehicles, pad.name, t) + (f" | {note}" if note else ""))
            due, turn = t + PERIOD, turn + 1
    finally:
        for name in hand.vehicles:
            vehicles.send(name, STILL)


def _take_over(hand: Hand, vehicles: Vehicles) -> str:
    return "; ".join(filter(None, (vehicles.take_over(name) for name in hand.vehicles if name in hand.active)))


def status_line(hand: Hand, vehicles: Vehicles, pad: str, t: float) -> str:
    """Vehicles with their links (those switched off in brackets), the scales, the velocity now, the gamepad."""
    names = [f"{i} {name}" if name in hand.active else f"({i} {name})" for i, name in enumerate(hand.vehicles, 1)]
    links = ", ".join(f"{shown} {vehicles.state(name)}" for shown, name in zip(names, hand.vehicles, strict=True))
    scale, now = hand.scale, hand.wanted(t)
    speeds = f"{scale.linear:.2f} m/s {scale.angular:.2f} rad/s | now {now.linear:+.2f} {now.angular:+.2f}"
    return f"{links} | {speeds}" + (f" | {pad}" if pad else "")


def wanted_vehicles(site: Site, names: Sequence[str]) -> tuple[list[str], Command]:
    """The vehicles meant, and what the slowest of them can do. Raises BadInput."""
    bodies = {m.name: m.file.ground for m in site.of_kind("ground") if m.file.ground is not None}
    chosen = list(dict.fromkeys(names)) or list(bodies)
    for name in chosen:
        if name not in bodies:
            raise BadInput(f"{site.mission_path}: no ground vehicle '{name}' there; {nearest(name, bodies)}")
    if not names and len(chosen) != 1:
        raise BadInput(f"{site.mission_path}: say which vehicle; {nearest('', bodies)}")
    linear, angular = ([getattr(bodies[name], limit) for name in chosen] for limit in ("max_linear", "max_angular"))
    return chosen, Command(min(linear), min(angular))


@contextmanager
def _signals_end_it() -> Iterator[None]:
    """A terminal that is closed and a polite kill end it like Ctrl-C; it cannot be put to sleep with a vehicle under way."""

    def end(number: int, frame: FrameType | None) -> None:
        raise KeyboardInterrupt

    before = {number: signal.signal(number, end) for number in (signal.SIGHUP, signal.SIGTERM)}
    before[signal.SIGTSTP] = signal.signal(signal.SIGTSTP, signal.SIG_IGN)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def teleop(names: Sequence[str], mission: str, say: Callable[[str], None]) -> None:
    """Drives until the operator ends it. Raises BadInput."""
    chosen, most = wanted_vehicles(load_site(settings.mission_path(mission)), names)
    with uvf.connect() as client, _signals_end_it(), key_by_key() as terminal, closing(Gamepad()) as pad:
        say(GREETING)
        try:
            drive(Hand(chosen, most), Link(client), terminal, pad, time.monotonic)
        except (KeyboardInterrupt, TerminalClosed):
            return
