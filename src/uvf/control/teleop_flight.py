"""What an operator wants of an aircraft's surfaces: steps from keys, which stay where they are put, or the sticks of a gamepad."""

from typing import NamedTuple

from uvf.control.teleop_drive import GamepadState, beyond_dead_zone

STEP = 0.05  # of a surface's way, the flaps' or the throttle's, for each press
THROTTLE_RATE = 0.5  # 1/s, with the right stick fully forward
LONGEST_TURN = 0.2  # s that one reading of the gamepad counts at most

KEYS = {
    "a": ("aileron", -1.0),
    "left": ("aileron", -1.0),
    "d": ("aileron", 1.0),
    "right": ("aileron", 1.0),
    "w": ("elevator", 1.0),
    "up": ("elevator", 1.0),
    "s": ("elevator", -1.0),
    "down": ("elevator", -1.0),
    "q": ("rudder", 1.0),
    "e": ("rudder", -1.0),
    "r": ("throttle", 1.0),
    "f": ("throttle", -1.0),
    "t": ("flap", 1.0),
    "g": ("flap", -1.0),
}
"""Key -> what a press moves, and which way: up is the stick pushed forward, nose down; q is the left pedal."""


class SurfaceLimits(NamedTuple):
    """Largest deflections [rad], to either side; the flap's from 0."""

    aileron: float
    elevator: float
    rudder: float
    flap: float


class SurfaceSetting(NamedTuple):
    """Surface deflections and flap [rad] with the signs of SurfaceCommand; throttle and brake 0..1."""

    aileron: float = 0.0
    elevator: float = 0.0
    rudder: float = 0.0
    throttle: float = 0.0
    flap: float = 0.0
    brake: float = 0.0


PARKED = SurfaceSetting(brake=1.0)


class FlightTeleop:
    """One operator who flies one aircraft by its surfaces. Times [s] come from one clock that never goes back."""

    def __init__(self, limits: SurfaceLimits) -> None:
        self.setting = PARKED
        self.neutral = 0.0  # rad, the elevator's place when nobody moves it
        self._followed = False
        self._limits = limits
        self._pad = GamepadState()
        self._read_at = 0.0

    def follow(self, setting: SurfaceSetting, straight: bool = True) -> None:
        """Takes over the surfaces that somebody else has set, to go on from them once the operator takes control.

        In a turn the elevator is that of a slower straight flight: once there is a neutral place, a turn does not move it.
        """
        self.setting = setting
        if straight or not self._followed:
            self.neutral = setting.elevator
        self._followed = True

    def key(self, name: str) -> None:
        """Takes one press, or one repetition, of a key; keys without a meaning change nothing."""
        if name in KEYS:
            self._move(*KEYS[name], STEP)
        elif name in (" ", "c"):
            self.centre()
        elif name == "n":
            self.neutral = self.setting.elevator
        elif name == "b":
            self.setting = self.setting._replace(brake=0.0 if self.setting.brake else 1.0)

    def centre(self) -> None:
        """Centres aileron and rudder, and puts the elevator to its neutral place."""
        self.setting = self.setting._replace(aileron=0.0, elevator=self.neutral, rudder=0.0)

    def pad(self, t: float, pad: GamepadState) -> None:
        """Takes the gamepad's state at ``t`` [s]; its sticks count while the dead-man button is held, on release surfaces are centred."""
        before, self._pad = self._pad, pad
        dt, self._read_at = min(t - self._read_at, LONGEST_TURN), t
        if pad.linear_step != before.linear_step:
            self._trim(pad.linear_step)
        if pad.angular_step != before.angular_step:
            self._move("flap", pad.angular_step, 2 * STEP)
        if pad.stop != before.stop:
            self.setting = self.setting._replace(brake=float(pad.stop))
        if pad.dead_man:
            self._sticks(pad, dt)
        elif before.dead_man:
            self.centre()

    def _sticks(self, pad: GamepadState, dt: float) -> None:
        limits = self._limits
        self.setting = self.setting._replace(
            aileron=-beyond_dead_zone(pad.left) * limits.aileron,
            elevator=_within(self.neutral + beyond_dead_zone(pad.forward) * limits.elevator, -limits.elevator, limits.elevator),
            rudder=beyond_dead_zone(pad.right_left) * limits.rudder,
        )
        self._move("throttle", beyond_dead_zone(pad.right_forward), THROTTLE_RATE * dt)

    def _trim(self, way: float) -> None:
        limit = self._limits.elevator
        self.neutral = _within(self.neutral + way * STEP * limit, -limit, limit)
        self.setting = self.setting._replace(elevator=self.neutral)

    def _move(self, what: str, way: float, step: float) -> None:
        """By a part of its whole way, within it."""
        limit = getattr(self._limits, what, 1.0)
        lowest = 0.0 if what in ("throttle", "flap") else -limit
        moved = _within(getattr(self.setting, what) + way * step * limit, lowest, limit)
        self.setting = self.setting._replace(**{what: 0.0 if abs(moved) < 1e-9 else moved})


def _within(value: float, lowest: float, highest: float) -> float:
    return min(max(value, lowest), highest)
