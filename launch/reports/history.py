"""What a log tells of each vehicle, as arrays over time: thinned out while it is read, so that hours fit into memory."""

from array import array
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from schemas.messages import (
    Battery,
    Contact,
    DriveCommand,
    Event,
    FrameTransform,
    Grid,
    Kind,
    Mission,
    MissionProgress,
    NavState,
    NavStatus,
    Odometry,
    ParamValues,
    PoseInFrame,
    PosesInFrame,
    SurfaceCommand,
    VehicleStatus,
)
from uvf.runtime.bus.interface import Sample
from uvf.runtime.bus.wire import decode_sample
from uvf.runtime.messages.convert import pose2_of

Floats = NDArray[np.float64]

PERIOD = 0.1  # s, between samples that are kept


def _motion(m: NavState) -> tuple[float, ...]:
    p, v, q, w = m.position, m.velocity, m.orientation, m.wind
    return p.x, p.y, p.z, v.x, v.y, v.z, q.w, q.x, q.y, q.z, m.airspeed, w.x, w.y


def _status(m: VehicleStatus) -> tuple[float, ...]:
    return m.mode, m.landed, m.cross_track, m.altitude_error, m.battery_remaining


@dataclass(frozen=True)
class RecordedStream:
    """A topic of a vehicle, the numbers kept of each message, and the least time [s] between two of them."""

    message: Any
    numbers: Callable[[Any], tuple[float, ...]]
    width: int
    period: float = PERIOD


STREAMS = {
    "truth/state": RecordedStream(NavState, _motion, 13),
    "nav/state": RecordedStream(NavState, _motion, 13),
    "state/vehicle": RecordedStream(VehicleStatus, _status, 5, 0.0),
    # At every command: the way of the surfaces is summed up.
    "actuator/surfaces": RecordedStream(SurfaceCommand, lambda m: (m.aileron, m.elevator, m.rudder, m.throttle, m.flap), 5, 0.0),
    "sensor/battery": RecordedStream(Battery, lambda m: (m.voltage, m.current, m.remaining), 3),
    "mission/progress": RecordedStream(MissionProgress, lambda m: (m.reached, m.laps), 2, 0.0),
    "nav/pose": RecordedStream(PoseInFrame, lambda m: tuple(pose2_of(m.pose)), 3),
    "nav/odometry": RecordedStream(Odometry, lambda m: (m.linear_velocity.x, m.angular_velocity.z), 2),
    "nav/status": RecordedStream(NavStatus, lambda m: (m.state, m.distance_left, m.explored, m.recoveries), 4, 0.0),
    "sensor/contact": RecordedStream(Contact, lambda m: (float(m.touching),), 1, 0.0),
}
DRIVES = RecordedStream(DriveCommand, lambda m: (m.linear, m.angular), 2, 0.0)
"""``cmd/<source>``, of the source that the vehicle obeys at the time."""
MAPS = ("map/grid", "map/team")


class Series:
    """Numbers of a stream over time, a row each."""

    def __init__(self, width: int) -> None:
        self.width = width
        self._values = array("d")
        self._next = -np.inf

    def add(self, t: float, numbers: tuple[float, ...], period: float) -> None:
        """Adds a row at ``t`` [s] unless it comes within ``period`` [s] of the one before."""
        if t >= self._next:
            self._next = t + period - 1e-6
            self._values.extend((t, *numbers))

    @property
    def rows(self) -> Floats:
        """Rows (k, 1 + width): t [s] and the numbers in the units of the message."""
        return np.array(self._values).reshape(-1, 1 + self.width)


@dataclass(frozen=True)
class FlownMotion:
    """Estimated or true motion, arrays of one length k; world frame ENU, attitude of NED/FRD as pilots give it."""

    t: Floats  # (k,) s
    position: Floats  # (k, 3) m
    velocity: Floats  # (k, 3) m/s
    roll: Floats  # (k,) rad, right wing down
    pitch: Floats  # (k,) rad, nose up
    heading: Floats  # (k,) rad from north, clockwise
    airspeed: Floats  # (k,) m/s
    wind: Floats  # (k, 2) m/s east and north, the way it blows to

    def at(self, t: Floats) -> "FlownMotion":
        """The motion interpolated at times ``t`` (k,) [s]; angles along the shorter way."""

        def over(values: Floats) -> Floats:
            return np.array([np.interp(t, self.t, column) for column in values.T]).T

        roll, pitch, heading = (np.interp(t, self.t, np.unwrap(angle)) for angle in (self.roll, self.pitch, self.heading))
        airspeed = np.interp(t, self.t, self.airspeed)
        return FlownMotion(t, over(self.position), over(self.velocity), roll, pitch, heading, airspeed, over(self.wind))


def motion(rows: Floats) -> FlownMotion:
    """The motion over time from rows (k, 14): t [s] and the numbers of ``_motion`` (position, velocity, quaternion, airspeed, wind)."""
    w, x, y, z = rows[:, 7:11].T
    roll = np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
    pitch = -np.arcsin(np.clip(2 * (w * y - z * x), -1, 1))
    heading = np.pi / 2 - np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
    return FlownMotion(rows[:, 0], rows[:, 1:4], rows[:, 4:7], roll, pitch, heading, rows[:, 11], rows[:, 12:14])


@dataclass
class History:
    """The recorded messages of one vehicle."""

    name: str
    series: dict[str, Series] = field(default_factory=lambda: {key: Series(s.width) for key, s in STREAMS.items()})
    events: list[tuple[float, Event]] = field(default_factory=list)
    plans: list[Mission] = field(default_factory=list)
    path: PosesInFrame | None = None  # the first one that is followed
    kind: int = Kind.KIND_UNSPECIFIED
    command_source: str = ""
    drives: Series = field(default_factory=lambda: Series(2))
    navigation: list[tuple[float, NavStatus]] = field(default_factory=list)  # at each change of job, goal, state or reason
    maps: dict[str, bytes] = field(default_factory=dict)  # the last message of each of MAPS
    placing: FrameTransform | None = None  # world from the vehicle's map
    params: dict[str, ParamValues] = field(default_factory=dict)  # of each service, the last ones

    def heard(self, name: str, sample: Sample) -> None:
        """Stores a sample of the topic ``name`` (without the vehicle). Raises Malformed."""
        t = sample.stamp_ns / 1e9
        if name in STREAMS:
            stream = STREAMS[name]
            message = decode_sample(sample, stream.message)
            self.series[name].add(t, stream.numbers(message), stream.period)
            if isinstance(message, VehicleStatus):
                self.kind, self.command_source = message.kind, message.command_source
            elif isinstance(message, NavStatus) and (not self.navigation or _is_news(self.navigation[-1][1], message)):
                self.navigation.append((t, message))
        elif name == f"cmd/{self.command_source}":
            self.drives.add(t, DRIVES.numbers(decode_sample(sample, DRIVES.message)), DRIVES.period)
        elif name in MAPS:
            decode_sample(sample, Grid)
            self.maps[name] = sample.payload
        elif name == "tf/world":
            self.placing = decode_sample(sample, FrameTransform)
        elif name.startswith("state/params/"):
            self.params[name.removeprefix("state/params/")] = decode_sample(sample, ParamValues)
        elif name.startswith("state/events/"):
            self.events.append((t, decode_sample(sample, Event)))
        elif name == "mission/plan":
            self.plans.append(decode_sample(sample, Mission))
        elif name == "nav/path" and self.path is None:
            path = decode_sample(sample, PosesInFrame)
            self.path = path if path.poses else None

    def rows(self, name: str) -> Floats:
        """Rows (k, 1 + width) of a stream: t [s] and its numbers in the units of the message."""
        return self.series[name].rows

    @property
    def is_aircraft(self) -> bool:
        """Whether it said that it is a fixed-wing aircraft, or has commanded control surfaces."""
        return self.kind == Kind.KIND_FIXED_WING or len(self.rows("actuator/surfaces")) > 0

    @property
    def truth(self) -> FlownMotion | None:
        """True motion; None in the log of a real flight."""
        rows = self.rows("truth/state")
        return motion(rows) if len(rows) > 1 else None

    @property
    def estimate(self) -> FlownMotion | None:
        """Estimated motion (``nav/state``); None with fewer than two samples."""
        rows = self.rows("nav/state")
        return motion(rows) if len(rows) > 1 else None


def _is_news(before: NavStatus, now: NavStatus) -> bool:
    def said(status: NavStatus) -> tuple[object, ...]:
        return status.job, status.state, status.goal.x, status.goal.y, status.reason

    return said(before) != said(now)
