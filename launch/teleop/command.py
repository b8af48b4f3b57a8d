"""``uvf teleop``: vehicles driven or flown from the keyboard of a terminal, or with a gamepad."""

import signal
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager, suppress
from types import FrameType
from typing import Protocol

import uvf
from launch import settings
from launch.running_mission import wanted_mission
from launch.teleop import aircraft
from launch.teleop.gamepad import Gamepad
from launch.teleop.link import TeleopLink
from launch.teleop.loop import END, Console, Padlike, Post, operate
from launch.teleop.terminal import Terminal, TerminalClosed, key_by_key
from uvf.client import Client
from uvf.control.teleop_drive import STILL, DriveTeleop, GamepadState
from uvf.maths.kinematics import Twist
from uvf.models.scenario import Scenario, load_scenario
from uvf.models.yaml_data import BadInput, nearest

GREETING = """w a s d or arrows: drive    q e z c: curves    space: stop    x or Ctrl-C: end
r f: linear speed up, down    t g: turn rate up, down    1..9: vehicle on, off    m: take over again
gamepad: hold the left shoulder button and use the left stick; d-pad: speeds; B: stop"""
SIDEWAYS_GREETING = "Shift with a d: sideways, with q e z c: diagonally, without turning    gamepad: right stick"


class Vehicles(Protocol):
    """The connection to the vehicles."""

    def send(self, vehicle: str, command: Twist) -> None:
        """Sends a velocity command to a vehicle."""
        ...

    def take_over(self, vehicle: str) -> str:
        """Asks for mode MANUAL and arms; what was refused and why, "" if nothing."""

    def state(self, vehicle: str) -> str:
        """State of the connection to a vehicle, in words."""
        ...


class WheelPost:
    """The control post of a driver of ground vehicles; leaving it stops all of them."""

    def __init__(self, hand: DriveTeleop, vehicles: Vehicles) -> None:
        self._hand, self._vehicles = hand, vehicles

    def take_over(self) -> str:
        """Takes over all active vehicles; what was refused and why, "" if nothing."""
        return "; ".join(filter(None, (self._vehicles.take_over(name) for name in self._hand.vehicles if name in self._hand.active)))

    def key(self, t: float, name: str) -> None:
        """Passes a key pressed at ``t`` [s] on to the teleoperation."""
        self._hand.key(t, name)

    def turn(self, t: float, pad: GamepadState) -> None:
        """Takes the gamepad at ``t`` [s] and sends each vehicle its velocity command."""
        self._hand.pad(t, pad)
        for name, command in self._hand.commands(t).items():
            self._vehicles.send(name, command)

    def line(self, t: float, pad: str) -> str:
        """Status line at ``t`` [s] for the terminal; pad: the gamepad's name."""
        return status_line(self._hand, self._vehicles, pad, t)

    def leave(self) -> None:
        """Commands zero velocity to every vehicle."""
        for name in self._hand.vehicles:
            self._vehicles.send(name, STILL)


def drive(hand: DriveTeleop, vehicles: Vehicles, console: Console, pad: Padlike, clock: Callable[[], float]) -> None:
    """Drives until the key x or an exception; then all vehicles are told to stop. clock: seconds, monotonic."""
    operate(WheelPost(hand, vehicles), console, pad, clock)


def status_line(hand: DriveTeleop, vehicles: Vehicles, pad: str, t: float) -> str:
    """Vehicles with their links (those switched off in brackets), speed scales, velocity commanded at ``t`` [s], the gamepad."""
    names = [f"{i} {name}" if name in hand.active else f"({i} {name})" for i, name in enumerate(hand.vehicles, 1)]
    links = ", ".join(f"{shown} {vehicles.state(name)}" for shown, name in zip(names, hand.vehicles, strict=True))
    scale, now = hand.scale, hand.wanted(t)
    speeds = f"{scale.linear:.2f} m/s {scale.angular:.2f} rad/s | now {now.linear:+.2f} {now.angular:+.2f}"
    if now.lateral:
        speeds += f" sideways {now.lateral:+.2f}"
    return f"{links} | {speeds}" + (f" | {pad}" if pad else "")


def wanted_vehicles(site: Scenario, names: Sequence[str]) -> tuple[list[str], Twist]:
    """The ground vehicles asked for, and the speed limits of the slowest of them. Raises BadInput."""
    bodies = {m.name: m.file.ground for m in site.of_kind("ground") if m.file.ground is not None}
    chosen = list(dict.fromkeys(names)) or list(bodies)
    for name in chosen:
        if name not in bodies:
            raise BadInput(f"{site.mission_path}: no ground vehicle '{name}' there; {nearest(name, bodies)}")
    if not names and len(chosen) != 1:
        raise BadInput(f"{site.mission_path}: say which vehicle; {nearest('', bodies)}")
    return chosen, Twist(*map(min, zip(*(bodies[name].max_twist for name in chosen), strict=True)))


@contextmanager
def _signals_are_the_key(end: str, terminal: Terminal) -> Iterator[None]:
    """Ctrl-C, a terminal that is closed and a polite kill end it in good order; it cannot be put to sleep with a vehicle under way.

    Ctrl-C too is asked for in so many words: whoever starts a process in the background may have it ignored there.
    """

    def press(number: int, frame: FrameType | None) -> None:
        terminal.press(end)

    before = {number: signal.signal(number, press) for number in (signal.SIGINT, signal.SIGHUP, signal.SIGTERM)}
    before[signal.SIGTSTP] = signal.signal(signal.SIGTSTP, signal.SIG_IGN)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def wanted_aircraft(site: Scenario, names: Sequence[str]) -> str:
    """The aircraft asked for, "" when it is not one. Raises BadInput for several of them."""
    flying = [name for name in dict.fromkeys(names) if name in site.members and site.members[name].file.air is not None]
    if flying and len(set(names)) > 1:
        raise BadInput(f"{site.mission_path}: '{flying[0]}' flies, and one flies one aircraft at a time; name it alone")
    return flying[0] if flying else ""


def post_for(site: Scenario, names: Sequence[str]) -> tuple[str, Callable[[Client], Post]]:
    """(greeting for the operator, function that makes the control post on a connection). Raises BadInput."""
    name = wanted_aircraft(site, names)
    body = site.members[name].file.air if name else None
    if body is not None:
        return aircraft.GREETING, lambda client: aircraft.cockpit(client, name, body)
    chosen, most = wanted_vehicles(site, names)
    greeting = f"{GREETING}\n{SIDEWAYS_GREETING}" if most.lateral > 0 else GREETING
    return greeting, lambda client: WheelPost(DriveTeleop(chosen, most), TeleopLink(client))


def teleop(names: Sequence[str], mission: str | None, say: Callable[[str], None]) -> None:
    """Drives or flies until the operator ends it; without a mission that of the running system counts. Raises BadInput."""
    greeting, post = post_for(load_scenario(settings.mission_path(wanted_mission(mission))), names)
    with (
        uvf.connect() as client,
        key_by_key() as terminal,
        _signals_are_the_key(END, terminal),
        closing(Gamepad()) as pad,
        suppress(TerminalClosed),
    ):
        say(greeting)
        operate(post(client), terminal, pad, time.monotonic)
