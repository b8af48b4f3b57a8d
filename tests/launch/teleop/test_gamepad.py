"""A gamepad that SDL itself pretends to have: which stick and button is which."""

import ctypes

import pytest

from launch.teleop.gamepad import Gamepad, _load
from uvf.control.teleop_drive import GamepadState

sdl2 = _load()


@pytest.fixture
def gamepad():
    pad = Gamepad()
    yield pad
    pad.close()


@pytest.fixture
def plugged(gamepad):
    index = sdl2.SDL_JoystickAttachVirtual(sdl2.SDL_JOYSTICK_TYPE_GAMECONTROLLER, 6, 15, 0)
    gamepad.read()
    yield sdl2.SDL_JoystickFromInstanceID(sdl2.SDL_JoystickGetDeviceInstanceID(index))
    if sdl2.SDL_NumJoysticks():
        sdl2.SDL_JoystickDetachVirtual(index)


def test_without_one_nothing_is_pressed(gamepad):
    assert (gamepad.name, gamepad.read()) == ("", GamepadState())


def test_one_that_is_plugged_in_later_is_found_and_one_that_is_pulled_out_lets_go(gamepad, plugged):
    assert gamepad.name == "Virtual Controller"
    sdl2.SDL_JoystickSetVirtualButton(plugged, sdl2.SDL_CONTROLLER_BUTTON_LEFTSHOULDER, 1)
    assert gamepad.read().dead_man
    sdl2.SDL_JoystickDetachVirtual(0)
    assert (gamepad.read(), gamepad.name) == (GamepadState(), "")


@pytest.mark.parametrize(
    ("axis", "value", "seen"),
    [
        (sdl2.SDL_CONTROLLER_AXIS_LEFTY, -32768, {"forward": 1.0}),
        (sdl2.SDL_CONTROLLER_AXIS_LEFTY, 32767, {"forward": -1.0}),
        (sdl2.SDL_CONTROLLER_AXIS_LEFTX, -32768, {"left": 1.0}),
        (sdl2.SDL_CONTROLLER_AXIS_LEFTX, 16384, {"left": -0.5}),
        (sdl2.SDL_CONTROLLER_AXIS_RIGHTX, 32767, {"right_left": -1.0}),
        (sdl2.SDL_CONTROLLER_AXIS_RIGHTY, -32768, {"right_forward": 1.0}),
    ],
)
def test_the_sticks(gamepad, plugged, axis, value, seen):
    sdl2.SDL_JoystickSetVirtualAxis(plugged, axis, ctypes.c_int16(value))
    assert gamepad.read() == pytest.approx(GamepadState()._replace(**seen), abs=1e-3)


@pytest.mark.parametrize(
    ("button", "seen"),
    [
        ("LEFTSHOULDER", {"dead_man": True}),
        ("B", {"stop": True}),
        ("DPAD_UP", {"linear_step": 1}),
        ("DPAD_DOWN", {"linear_step": -1}),
        ("DPAD_RIGHT", {"angular_step": 1}),
        ("DPAD_LEFT", {"angular_step": -1}),
        ("A", {}),
    ],
)
def test_the_buttons(gamepad, plugged, button, seen):
    sdl2.SDL_JoystickSetVirtualButton(plugged, getattr(sdl2, f"SDL_CONTROLLER_BUTTON_{button}"), 1)
    assert gamepad.read() == GamepadState()._replace(**seen)
