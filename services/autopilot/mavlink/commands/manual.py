"""Sticks: MANUAL_CONTROL and RC_CHANNELS_OVERRIDE as the velocity of a ground vehicle, or the surfaces of an aircraft.

Of one station at a time, and only in a mode flown or driven by hand: a ground station with a virtual joystick sends sticks at rest
all the time; in the other modes they mean nothing.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from schemas.messages import Mode, SurfaceCommand
from services.autopilot.mavlink.connection.line import Holder, Sender, VehicleConnection
from uvf.maths.kinematics import Twist
from uvf.mavlink import dialect as mav
from uvf.runtime.messages.convert import stamp
from uvf.runtime.messages.wheels import drive_command

FULL = 1000.0
NOT_THERE = 2**15 - 1
BY_HAND = (Mode.MODE_MANUAL, Mode.MODE_STABILIZED, Mode.MODE_ALTITUDE, Mode.MODE_POSITION)
RELEASED, UNCHANGED, RELEASED_HIGH = 0, 0xFFFF, 0xFFFE
CHANNELS = 18
PLAIN = 8  # channels from 9 on have other words for released and unchanged
MIDDLE, HALF = 1500.0, 500.0  # us
ROLL, PITCH, THROTTLE, YAW = range(4)


@dataclass(frozen=True, slots=True)
class Sticks:
    """Stick positions -1..1 [-]: pitch forward (nose down), roll right, yaw right, throttle forward; an aircraft's throttle is 0..1."""

    pitch: float
    roll: float
    yaw: float
    throttle: float


def of_manual_control(m: mav.MAVLink_manual_control_message) -> Sticks | None:
    """The sticks of MANUAL_CONTROL; None without a throttle, any other axis that is missing is centred."""
    if m.z == NOT_THERE:
        return None
    x, y, r = (0 if axis == NOT_THERE else axis for axis in (m.x, m.y, m.r))
    return Sticks(_part(x / FULL), _part(y / FULL), _part(r / FULL), _part(m.z / FULL))


def of_channels(channels: list[int], is_ground: bool) -> Sticks | None:
    """The sticks of channels 1 to 4 [us]: roll, pitch (high = stick back), throttle, yaw. None without a throttle."""
    if not channels[THROTTLE]:
        return None
    roll, pitch, throttle, yaw = (_part((us - MIDDLE) / HALF) if us else 0.0 for us in channels[: YAW + 1])
    return Sticks(-pitch, roll, yaw, throttle if is_ground else (throttle + 1.0) / 2.0)


def merged(channels: list[int], m: mav.MAVLink_rc_channels_override_message) -> list[int]:
    """The channels [us] updated by an RC_CHANNELS_OVERRIDE."""
    new = list(channels)
    for i in range(CHANNELS):
        said = getattr(m, f"chan{i + 1}_raw")
        if i < PLAIN:
            new[i] = new[i] if said == UNCHANGED else said
        elif said not in (0, UNCHANGED):
            new[i] = RELEASED if said == RELEASED_HIGH else said
    return new


def _part(value: float) -> float:
    return min(max(value, -1.0), 1.0)


class ManualControl:
    """Turns stick messages into commands in ``line.commands``."""

    def __init__(self, line: VehicleConnection) -> None:
        self._line = line
        self._holder = Holder(line, "Sticks ignored")
        self._channels = [RELEASED] * CHANNELS
        self._channels_of: Sender | None = None
        """Nobody inherits channels that another one has set."""
        self._heard = -math.inf

    def handlers(self) -> dict[int, Callable[[Any, Sender], None]]:
        """Handlers of the stick messages, by message id."""
        return {
            mav.MAVLINK_MSG_ID_MANUAL_CONTROL: self._on_manual_control,
            mav.MAVLINK_MSG_ID_RC_CHANNELS_OVERRIDE: self._on_override,
        }

    def tick(self) -> None:
        """Releases channels that nobody has repeated for a while."""
        if self._line.t - self._heard > self._line.latest.own["stick_timeout"] and any(self._channels):
            self._forget()

    def _forget(self) -> None:
        self._channels, self._channels_of = [RELEASED] * CHANNELS, None
        self._line.latest.rc_channels = ()

    def _on_manual_control(self, m: mav.MAVLink_manual_control_message, sender: Sender) -> None:
        self._take(of_manual_control(m), sender)

    def _on_override(self, m: mav.MAVLink_rc_channels_override_message, sender: Sender) -> None:
        """Who releases all, or names no throttle, steers nothing, and keeps nobody else from steering."""
        if not self._listens:
            return
        is_own = sender == self._channels_of
        channels = merged(self._channels if is_own else [RELEASED] * CHANNELS, m)
        sticks = of_channels(channels, self._line.facts.is_ground)
        if sticks is not None:
            is_own = self._take(sticks, sender)
        if is_own:
            self._channels, self._channels_of, self._heard = channels, sender, self._line.t
            self._line.latest.rc_channels = tuple(channels)

    @property
    def _listens(self) -> bool:
        status = self._line.latest.status
        return status is not None and status.mode in BY_HAND

    def _take(self, sticks: Sticks | None, sender: Sender) -> bool:
        """Whether the sender steers with these."""
        if sticks is None or not self._listens or not self._holder.admits(sender):
            return False
        if self._channels_of not in (None, sender):
            self._forget()
        if self._line.facts.is_ground:
            self._drive(sticks)
        else:
            self._fly(sticks)
        return True

    def _drive(self, sticks: Sticks) -> None:
        """Throttle stick forward = forward; either stick right = right turn. Roll moves a vehicle to the right that can drive sideways.

        Of a car the sticks are the steering.
        """
        body = self._line.facts.file.ground
        assert body is not None
        drive, linear = body.drive.kinematics, sticks.throttle * body.max_linear
        aside, turn = (sticks.roll, sticks.yaw) if drive.goes_sideways else (0.0, _part(sticks.roll + sticks.yaw))
        fastest = linear / drive.turning_radius if drive.turning_radius else body.max_angular
        twist = Twist(linear, -turn * fastest, -aside * body.max_linear)
        self._line.commands["drive"] = drive_command(twist, stamp(self._line.latest.sim_time))

    def _fly(self, sticks: Sticks) -> None:
        """Full stick = the vehicle's limits."""
        body = self._line.facts.file.air
        assert body is not None
        limits = body.controls
        self._line.commands["surfaces"] = SurfaceCommand(
            timestamp=stamp(self._line.latest.sim_time),
            aileron=limits.aileron.deflection(sticks.roll),
            elevator=limits.elevator.deflection(sticks.pitch),
            rudder=limits.rudder.deflection(-sticks.yaw),
            throttle=max(sticks.throttle, 0.0),
        )
