"""Position, velocity and attitude targets: setpoints of mode Offboard; a position that comes alone is a place to go to.

Programs stream targets, at least twice a second, before and while they fly Offboard. Mission Planner sends a single one
and means: go there.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from schemas.limits import PLACE
from schemas.messages import (
    AttitudeSetpoint,
    CircleSetpoint,
    FlightSetpoint,
    GoalRequest,
    LineSetpoint,
    Mode,
    Vector3,
)
from services.autopilot.mavlink.commands.actions import SOURCE
from services.autopilot.mavlink.commands.guided import go_to
from services.autopilot.mavlink.commands.places import BadPlace, place_of
from services.autopilot.mavlink.connection.line import Holder, Sender, VehicleConnection
from uvf.maths.geodesy import Floats
from uvf.maths.kinematics import DriveKinematics, Twist
from uvf.maths.rotations import to_euler
from uvf.mavlink import dialect as mav
from uvf.mavlink.names import frame_name
from uvf.runtime.mavlink.limits import FASTEST, HIGHEST
from uvf.runtime.messages.convert import array, stamp, yaw_of
from uvf.runtime.messages.wheels import drive_command

ALONE = 1.0  # s, wall: after which a target without another is no stream
IGNORE_PLACE, IGNORE_Z, IGNORE_VELOCITY, IGNORE_VZ, IGNORE_RATE = 0b011, 0b100, 0b011_000, 0b100_000, 1 << 11
ATTITUDE_IGNORED, THRUST_IGNORED = 1 << 7, 1 << 6
BODY_FRAMES = (mav.MAV_FRAME_BODY_NED, mav.MAV_FRAME_BODY_OFFSET_NED, mav.MAV_FRAME_BODY_FRD)
CREEPS = 0.3  # of the speed asked for, at which a car turns round
TURN_P = 2.0  # 1/s, turn rate of a ground vehicle per error of heading
TO_GO = {False: (Mode.MODE_HOLD,), True: (Mode.MODE_HOLD, Mode.MODE_MISSION)}
"""Modes, of aircraft and of ground vehicles, in which a position that comes alone is gone to."""


@dataclass(frozen=True, slots=True)
class Target:
    """A position and velocity target in the world frame (ENU): place (3,) [m], velocity (3,) [m/s]; NaN = not given."""

    place: Floats
    velocity: Floats

    @property
    def has_place(self) -> bool:
        """Whether a horizontal position is given."""
        return bool(np.isfinite(self.place[:2]).all())

    @property
    def has_velocity(self) -> bool:
        """Whether a horizontal velocity is given."""
        return bool(np.isfinite(self.velocity[:2]).all())

    @property
    def absurd(self) -> str:
        """Why the target cannot be followed, "" if it can; without figures, so that a stream of them is reported once."""
        if np.isinf(self.place).any() or np.isinf(self.velocity).any() or (self.has_velocity and math.isnan(self.velocity[2])):
            return "a place or a velocity is not finite"
        if self.has_place and math.hypot(*self.place[:2]) > PLACE:
            return f"the place is more than {PLACE / 1e3:g} km away from the field"
        if abs(self.place[2]) > HIGHEST:
            return f"the place is more than {HIGHEST:g} m high"
        if self.has_velocity and math.hypot(*self.velocity) > FASTEST:
            return f"the velocity is beyond {FASTEST:g} m/s"
        return ""


def given(mask: int, velocity: tuple[float, float, float], place: Vector3) -> Target:
    """The target without what the type mask leaves out; velocity: (3,) NED [m/s], place: (x, y, z) [m, world]."""
    nan = math.nan
    v = (nan, nan) if mask & IGNORE_VELOCITY else (velocity[1], velocity[0])
    xy = (nan, nan) if mask & IGNORE_PLACE else (place.x, place.y)
    z, climb = nan if mask & IGNORE_Z else place.z, 0.0 if mask & IGNORE_VZ else -velocity[2]
    return Target(np.array((*xy, z)), np.array((*v, climb)))


class Alone(NamedTuple):
    """A position target that was not followed by another: time [s, wall], place [m, world], sender."""

    t: float
    place: Vector3
    sender: Sender


class Setpoints:
    """Handles the SET_POSITION_TARGET and SET_ATTITUDE_TARGET messages of one vehicle."""

    def __init__(self, line: VehicleConnection) -> None:
        self._line = line
        self._holder = Holder(line, "Setpoints ignored")
        self._alone: Alone | None = None
        self._streamed = -math.inf
        self._anchor: tuple[Floats, Floats] | None = None
        """(velocity, place where it was asked for first)."""

    def handlers(self) -> dict[int, Callable[[Any, Sender], None]]:
        """Handlers of the target messages, by message id."""
        return {
            mav.MAVLINK_MSG_ID_SET_POSITION_TARGET_LOCAL_NED: self._on_local,
            mav.MAVLINK_MSG_ID_SET_POSITION_TARGET_GLOBAL_INT: self._on_global,
            mav.MAVLINK_MSG_ID_SET_ATTITUDE_TARGET: self._on_attitude,
        }

    def tick(self) -> None:
        """Goes to a position target that was not followed by another."""
        alone, line, status = self._alone, self._line, self._line.latest.status
        if alone is None or line.t - alone.t < ALONE:
            return
        self._alone = None
        with line.hearing(alone.sender.peer):
            if status is None or status.mode not in TO_GO[line.facts.is_ground]:
                line.refusal("Go to")(False, "a position target needs mode Hold, or Offboard and two each second")
            else:
                go_to(line, GoalRequest(position=alone.place, yaw=math.nan, source=SOURCE), True, line.refusal("Go to"))

    def _on_local(self, m: mav.MAVLink_set_position_target_local_ned_message, sender: Sender) -> None:
        velocity = (m.vx, m.vy, m.vz)
        if m.coordinate_frame in BODY_FRAMES and self._line.facts.is_ground:
            rate = 0.0 if m.type_mask & IGNORE_RATE else m.yaw_rate
            ahead, aside = (math.nan, math.nan) if m.type_mask & IGNORE_VELOCITY else (m.vx, -m.vy)
            self._drive(sender, Twist(ahead, -rate, aside if self._kinematics.goes_sideways else 0.0))
        elif m.coordinate_frame != mav.MAV_FRAME_LOCAL_NED:
            self._refuse(sender, f"{frame_name(m.coordinate_frame)} is not supported: choose LOCAL_NED")
        else:
            self._take(given(m.type_mask, velocity, Vector3(x=m.y, y=m.x, z=-m.z)), sender)

    def _on_global(self, m: mav.MAVLink_set_position_target_global_int_message, sender: Sender) -> None:
        nan, wants = math.nan, not m.type_mask & IGNORE_PLACE
        degrees = (m.lat_int * 1e-7, m.lon_int * 1e-7) if wants else (nan, nan)
        try:
            place = place_of(self._line, m.coordinate_frame, degrees, nan if m.type_mask & IGNORE_Z else m.alt)
        except BadPlace as bad:
            self._refuse(sender, bad.reason)
            return
        self._take(given(m.type_mask, (m.vx, m.vy, m.vz), place), sender)

    def _take(self, target: Target, sender: Sender) -> None:
        """What nobody can follow keeps no other program from steering."""
        if why := target.absurd or self._lacking(target):
            self._refuse(sender, why)
            return
        if not self._holder.admits(sender):
            return
        if target.has_place and not target.has_velocity:
            self._maybe_alone(target, sender)
        if self._line.facts.is_ground:
            self._drive_along(target, sender)
        elif (setpoint := self._setpoint(target)) is not None:
            setpoint.timestamp.CopyFrom(stamp(self._line.latest.sim_time))
            self._line.commands["setpoint"] = setpoint

    def _lacking(self, target: Target) -> str:
        moves = math.hypot(*target.velocity[:2]) > 0 if target.has_velocity else target.has_place
        return "" if moves or self._line.facts.is_ground else "a place or a velocity over ground that is not zero is needed"

    def _maybe_alone(self, target: Target, sender: Sender) -> None:
        t, status = self._line.t, self._line.latest.status
        streams = t - self._streamed < ALONE or (status is not None and status.mode == Mode.MODE_OFFBOARD)
        self._streamed = t
        here = self._line.latest.position
        z = float(target.place[2]) if math.isfinite(target.place[2]) or here is None else float(here[2])
        self._alone = None if streams else Alone(t, Vector3(x=float(target.place[0]), y=float(target.place[1]), z=z), sender)

    def _setpoint(self, target: Target) -> FlightSetpoint | None:
        """Place and velocity: the line through the place; a velocity alone: from where it was asked for first; a place alone: round it."""
        nav = self._line.latest.nav
        if nav is None:
            return None
        place = np.where(np.isfinite(target.place), target.place, array(nav.position))
        if not target.has_velocity:
            return FlightSetpoint(circle=CircleSetpoint(centre=_vector(place), radius=self._line.latest.own["hold_radius"]))
        if not target.has_place:
            place = np.array((*self._anchored(target.velocity, place)[:2], place[2] if math.isfinite(target.place[2]) else self._anchor_z))
        airspeed = math.hypot(target.velocity[0] - nav.wind.x, target.velocity[1] - nav.wind.y)
        return FlightSetpoint(line=LineSetpoint(origin=_vector(place), direction=_vector(target.velocity), airspeed=airspeed))

    def _anchored(self, velocity: Floats, here: Floats) -> Floats:
        if self._anchor is None or not np.array_equal(self._anchor[0], velocity):
            self._anchor = (velocity, here)
        return self._anchor[1]

    @property
    def _anchor_z(self) -> float:
        return float(self._anchor[1][2]) if self._anchor is not None else 0.0

    @property
    def _kinematics(self) -> DriveKinematics:
        body = self._line.facts.file.ground
        assert body is not None
        return body.drive.kinematics

    def _drive_along(self, target: Target, sender: Sender) -> None:
        """A velocity over ground: turns to it, and drives as far as it looks that way, or goes there as it stands where it can.

        A car drives on while it turns. A place is for ``tick``.
        """
        nav = self._line.latest.nav
        if nav is None or not target.has_velocity:
            return
        east, north = target.velocity[:2]
        speed = math.hypot(east, north)
        off = math.remainder(math.atan2(north, east) - yaw_of(nav.orientation), math.tau) if speed > 0 else 0.0
        if self._kinematics.goes_sideways:
            self._drive(sender, Twist(speed * math.cos(off), 0.0, speed * math.sin(off)))
        else:
            least = CREEPS if self._kinematics.turning_radius else 0.0
            self._drive(sender, Twist(speed * max(math.cos(off), least), TURN_P * off))

    def _drive(self, sender: Sender, twist: Twist) -> None:
        status = self._line.latest.status
        if status is None or status.mode != Mode.MODE_OFFBOARD:
            return
        if not all(map(math.isfinite, twist)):
            self._refuse(sender, "a finite velocity is needed")
            return
        if max(map(abs, twist)) > FASTEST:
            self._refuse(sender, f"the velocity is beyond {FASTEST:g} m/s, or the rate beyond {FASTEST:g} rad/s")
            return
        if not self._holder.admits(sender):
            return
        now = stamp(self._line.latest.sim_time)
        self._line.commands["drive"] = drive_command(twist, now)

    def _on_attitude(self, m: mav.MAVLink_set_attitude_target_message, sender: Sender) -> None:
        """Attitude with thrust; rates alone are not flown, the heading follows from the bank."""
        norm = math.sqrt(sum(part * part for part in m.q))
        if self._line.facts.is_ground or m.type_mask & (ATTITUDE_IGNORED | THRUST_IGNORED):
            self._refuse(sender, "an aircraft's attitude with thrust is needed")
        elif not (0.5 < norm < 2.0 and math.isfinite(m.thrust)):
            self._refuse(sender, "the attitude or the thrust is none")
        elif self._holder.admits(sender):
            roll, pitch, _ = to_euler(np.array(m.q) / norm)
            asked = AttitudeSetpoint(bank=roll, pitch=pitch, throttle=min(max(m.thrust, 0.0), 1.0))
            self._line.commands["setpoint"] = FlightSetpoint(timestamp=stamp(self._line.latest.sim_time), attitude=asked)

    def _refuse(self, sender: Sender, why: str) -> None:
        self._line.text(mav.MAV_SEVERITY_WARNING, f"Setpoints refused: {why}", sender.peer)


def _vector(v: Floats) -> Vector3:
    return Vector3(x=float(v[0]), y=float(v[1]), z=float(v[2]))
