"""What an operator wants of the vehicles: directions from keys, a gamepad or a page, scaled, as long as a key or the dead-man is held."""

from collections.abc import Sequence
from math import inf
from typing import NamedTuple

from uvf.maths.kinematics import Twist

FIRST_HOLD = 0.5  # s a key counts after it is pressed: keyboards wait about that long before they repeat it
REPEAT_HOLD = 0.2  # s it counts once it repeats: its being let go is seen that fast
ZEROS = 0.5  # s of standing still that are sent after the last motion, then silence
START_LINEAR, START_ANGULAR = 0.5, 0.5  # m/s, rad/s
STEP = 1.1  # of the scales
LEAST = 0.02  # m/s and rad/s, the smallest scales
DEAD_ZONE = 0.1  # of a stick's way: sticks seldom come to rest at zero

DIRECTIONS = {
    "w": Twist(1.0, 0.0),
    "up": Twist(1.0, 0.0),
    "s": Twist(-1.0, 0.0),
    "down": Twist(-1.0, 0.0),
    "a": Twist(0.0, 1.0),
    "left": Twist(0.0, 1.0),
    "d": Twist(0.0, -1.0),
    "right": Twist(0.0, -1.0),
    "q": Twist(1.0, 1.0),
    "e": Twist(1.0, -1.0),
    "z": Twist(-1.0, -1.0),
    "c": Twist(-1.0, 1.0),
}
"""Key -> parts (-1..1) of the scales; the lower row drives the curves of the upper one backwards."""
SIDEWAYS = {
    "A": Twist(0.0, 0.0, 1.0),
    "D": Twist(0.0, 0.0, -1.0),
    "Q": Twist(1.0, 0.0, 1.0),
    "E": Twist(1.0, 0.0, -1.0),
    "Z": Twist(-1.0, 0.0, 1.0),
    "C": Twist(-1.0, 0.0, -1.0),
}
"""With Shift, for vehicles that go sideways: to where the key lies, without turning."""
SCALINGS = {"r": (STEP, 1.0), "f": (1 / STEP, 1.0), "t": (1.0, STEP), "g": (1.0, 1 / STEP)}
"""Key -> factors of the linear and the angular scale."""


class GamepadState(NamedTuple):
    """A gamepad's state. forward, left: -1..1 of the left stick; linear_step, angular_step: -1, 0 or 1, counted when they change."""

    forward: float = 0.0
    left: float = 0.0
    dead_man: bool = False
    stop: bool = False
    linear_step: int = 0
    angular_step: int = 0
    right_forward: float = 0.0
    right_left: float = 0.0
    """Of the right stick, with which aircraft are flown; to the side it moves vehicles that go sideways."""


STILL = Twist(0.0, 0.0)


class DriveTeleop:
    """One operator who drives several vehicles. Times [s] come from one clock that never goes back."""

    def __init__(self, vehicles: Sequence[str], most: Twist) -> None:
        """most: what the slowest of the vehicles can do; no sideways velocity where one of them has none."""
        self.vehicles = tuple(vehicles)
        self.active = set(vehicles)
        self.scale = Twist(*map(min, (START_LINEAR, START_ANGULAR, START_LINEAR), most))
        self._most = most
        self._direction = STILL
        self._pressed_at = -inf
        self._until = -inf
        self._pad = GamepadState()
        self._silent_from = dict.fromkeys(vehicles, -inf)

    def key(self, t: float, name: str) -> None:
        """Takes one press, or one repetition, of a key at ``t`` [s]; keys without a meaning change nothing.

        Letters come as typed: with Shift they move sideways, and count as without it where nothing goes sideways.
        """
        if self._most.lateral > 0 and name in SIDEWAYS:
            self._press(t, SIDEWAYS[name])
            return
        name = name.lower()
        if name in DIRECTIONS:
            self._press(t, DIRECTIONS[name])
        elif name in SCALINGS:
            self._rescale(*SCALINGS[name])
        elif name == " ":
            self.stop(t)
        elif name.isdecimal() and 1 <= int(name) <= len(self.vehicles):
            self.active ^= {self.vehicles[int(name) - 1]}

    def pad(self, t: float, pad: GamepadState) -> None:
        """Takes the gamepad's state at ``t`` [s]; it drives while its dead-man button is held, and stops when that is released."""
        before, self._pad = self._pad, pad
        self._rescale(
            STEP**pad.linear_step if pad.linear_step != before.linear_step else 1.0,
            STEP**pad.angular_step if pad.angular_step != before.angular_step else 1.0,
        )
        if pad.stop or (before.dead_man and not pad.dead_man):
            self.stop(t)
        elif pad.dead_man:
            self.hold(t, Twist(*map(beyond_dead_zone, (pad.forward, pad.left, pad.right_left))), REPEAT_HOLD)

    def hold(self, t: float, direction: Twist, patience: float) -> None:
        """Drives in a direction [parts of the scales, -1..1] from ``t`` for ``patience`` [s], unless held anew."""
        self._direction, self._until = direction, t + patience
        self._keep(t)

    def stop(self, t: float) -> None:
        """Stops the active vehicles at ``t`` [s]; zero commands are sent to them for ``ZEROS`` seconds."""
        self._until = -inf
        self._keep(t)

    def wanted(self, t: float) -> Twist:
        """The velocity commanded to the active vehicles at ``t`` [s]."""
        if t >= self._until:
            return STILL
        way, scale = self._direction, self.scale
        return Twist(way.linear * scale.linear, way.angular * scale.angular, way.lateral * scale.lateral)

    def commands(self, t: float) -> dict[str, Twist]:
        """Commands to send at ``t`` [s], by vehicle; none to a vehicle that has been sent zeros for long enough."""
        wanted = self.wanted(t)
        found = {name: wanted if name in self.active else STILL for name in self.vehicles}
        self._silent_from |= {name: t + ZEROS for name, command in found.items() if command != STILL}
        return {name: command for name, command in found.items() if t < self._silent_from[name]}

    def _keep(self, t: float) -> None:
        """Keeps the active vehicles for a while, though they stand."""
        self._silent_from |= dict.fromkeys(self.active, t + ZEROS)

    def _press(self, t: float, direction: Twist) -> None:
        repeats = direction == self._direction and t - self._pressed_at <= REPEAT_HOLD
        self._direction, self._pressed_at = direction, t
        self._until = t + (REPEAT_HOLD if repeats else FIRST_HOLD)

    def _rescale(self, linear: float, angular: float) -> None:
        scale, most = self.scale, self._most
        speed = _within(scale.linear * linear, most.linear)
        self.scale = Twist(speed, _within(scale.angular * angular, most.angular), min(speed, most.lateral))


def _within(scale: float, most: float) -> float:
    return min(max(scale, LEAST), most)


def beyond_dead_zone(way: float) -> float:
    """Stick deflection ``way`` [-1..1] without its dead zone: 0 within it, from there rising linearly to +-1 at full deflection."""
    return max(abs(way) - DEAD_ZONE, 0.0) / (1 - DEAD_ZONE) * (1.0 if way > 0 else -1.0)
