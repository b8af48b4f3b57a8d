"""The first gamepad that is plugged in, read through SDL; the only file here that knows SDL.

Its table of gamepads gives the same names to the sticks and buttons of all of them.
"""

import os
from typing import Any

from uvf.control.teleop_drive import GamepadState

STICK_FULL = 32767.0


class Gamepad:
    """The first gamepad.

    Left stick: drive, or roll and pitch; right one: throttle and rudder. Left shoulder: dead-man. B: stop, or brakes.
    D-pad: up and down the linear, right and left the angular scale; trim and flaps of an aircraft.
    """

    def __init__(self) -> None:
        os.environ.setdefault("SDL_JOYSTICK_ALLOW_BACKGROUND_EVENTS", "1")  # there is no window that could have the focus
        self._sdl = _load()
        self._sdl.SDL_SetHint(b"SDL_NO_SIGNAL_HANDLERS", b"1")
        self._sdl.SDL_Init(self._sdl.SDL_INIT_GAMECONTROLLER)
        self._pad: Any = None

    @property
    def name(self) -> str:
        """The maker's name of the gamepad; "" while there is none."""
        return self._sdl.SDL_GameControllerName(self._pad).decode("utf-8", "replace") if self._pad else ""

    def read(self) -> GamepadState:
        """Its present state; all zero and the dead-man switch not held while there is none."""
        sdl = self._sdl
        sdl.SDL_GameControllerUpdate()
        if self._pad and not sdl.SDL_GameControllerGetAttached(self._pad):
            sdl.SDL_GameControllerClose(self._pad)
            self._pad = None
        if not self._pad:
            self._pad = self._first()
        if not self._pad:
            return GamepadState()
        return GamepadState(
            forward=-self._axis(sdl.SDL_CONTROLLER_AXIS_LEFTY),
            left=-self._axis(sdl.SDL_CONTROLLER_AXIS_LEFTX),
            dead_man=self._pressed(sdl.SDL_CONTROLLER_BUTTON_LEFTSHOULDER),
            stop=self._pressed(sdl.SDL_CONTROLLER_BUTTON_B),
            linear_step=self._pressed(sdl.SDL_CONTROLLER_BUTTON_DPAD_UP) - self._pressed(sdl.SDL_CONTROLLER_BUTTON_DPAD_DOWN),
            right_forward=-self._axis(sdl.SDL_CONTROLLER_AXIS_RIGHTY),
            right_left=-self._axis(sdl.SDL_CONTROLLER_AXIS_RIGHTX),
            angular_step=self._pressed(sdl.SDL_CONTROLLER_BUTTON_DPAD_RIGHT) - self._pressed(sdl.SDL_CONTROLLER_BUTTON_DPAD_LEFT),
        )

    def close(self) -> None:
        """Closes the gamepad and SDL's part for it."""
        if self._pad:
            self._sdl.SDL_GameControllerClose(self._pad)
        self._sdl.SDL_QuitSubSystem(self._sdl.SDL_INIT_GAMECONTROLLER)

    def _first(self) -> Any:
        found = (i for i in range(self._sdl.SDL_NumJoysticks()) if self._sdl.SDL_IsGameController(i))
        index = next(found, None)
        return None if index is None else self._sdl.SDL_GameControllerOpen(index)

    def _axis(self, axis: int) -> float:
        way: int = self._sdl.SDL_GameControllerGetAxis(self._pad, axis)
        return max(way / STICK_FULL, -1.0)

    def _pressed(self, button: int) -> bool:
        return bool(self._sdl.SDL_GameControllerGetButton(self._pad, button))


def _load() -> Any:
    """Imported here, for it tells on import where its binaries come from."""
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        import sdl2

    return sdl2
