"""Ten vehicles on the bus that only move: what a run of that size says, 20 times a second, so that nothing else costs processor time.

Each goes round a circle once in ``PERIOD`` seconds of the wall clock, so where it is drawn tells when that was said.
"""

import io
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from math import cos, pi, sin, tau
from typing import Any

import numpy as np
from google.protobuf.message import Message
from PIL import Image

from schemas import topics
from schemas.messages import (
    Clock,
    CompressedImage,
    Kind,
    LaserScan,
    Mode,
    NavState,
    NavStatus,
    Odometry,
    PoseInFrame,
    PosesInFrame,
    Vector3,
    VehicleStatus,
)
from uvf.maths.rotations import from_euler
from uvf.runtime.bus.interface import Publisher
from uvf.runtime.bus.zenoh_bus import ZenohBus
from uvf.runtime.messages.convert import occupancy_grid, planar_pose, quaternion, stamp

HZ = 20.0
PERIOD = 60.0  # s
CELLS = 200  # of a map's side
EVERY_SCAN, EVERY_PICTURE, EVERY_MAP = 2, 2, 20  # steps: 10 Hz, 10 Hz, 1 Hz


@dataclass(frozen=True)
class Circle:
    """Where a vehicle goes round, world frame [m]."""

    x: float
    y: float
    z: float
    radius: float

    def at(self, wall: float) -> tuple[float, float, float]:
        """Position and yaw at a time of the wall clock [s]."""
        a = tau * (wall % PERIOD) / PERIOD
        return self.x + self.radius * cos(a), self.y + self.radius * sin(a), a + pi / 2

    def age(self, x: float, y: float, wall: float) -> float:
        """How long ago [s] the vehicle was at this position, at ``wall``."""
        a = np.arctan2(y - self.y, x - self.x)
        return float((wall - a * PERIOD / tau + PERIOD / 2) % PERIOD - PERIOD / 2)


ROVERS = {f"rover{n}": Circle(5.0 + 5.0 * n, 15.0, 0.0, 2.0) for n in range(7)}
AIRCRAFT = {f"aircraft{n}": Circle(0.0, 400.0 * n, 80.0, 150.0) for n in range(3)}


def mission() -> str:
    """The mission file of these ten vehicles."""
    models = dict.fromkeys(ROVERS, "burger") | dict.fromkeys(AIRCRAFT, "milvus_survey")
    vehicles = (
        f"  {name}:\n    model: {models[name]}\n    system_id: {number}\n"
        f"    start: {{x: {circle.x}, y: {circle.y}, z: {circle.z}{', speed: 25.0' if circle.z else ''}}}\n"
        for number, (name, circle) in enumerate((ROVERS | AIRCRAFT).items(), 1)
    )
    return f"about: Ten vehicles.\nworld: plaza\nseed: 1\nduration: 10.0\nvehicles:\n{''.join(vehicles)}criteria: []\n"


class Feeder:
    """Says everything that is newest, once a step."""

    def __init__(self, bus: ZenohBus) -> None:
        self._bus = bus
        self._publishers: dict[str, Publisher] = {}
        self._pictures = [_picture(n) for n in range(8)]
        self._map = np.full((CELLS, CELLS), -1, dtype=np.int8)

    def tick(self, number: int, t: float) -> None:
        """The clock, at ``t`` [s] of the simulation."""
        self._put("sys", topics.CLOCK, Clock(tick=number, t_ns=round(t * 1e9), rate=1.0, rate_wanted=1.0), t)

    def say(self, name: str, number: int, t: float, wall: float) -> None:
        """A vehicle's messages of its step ``number``."""
        circle = (ROVERS | AIRCRAFT)[name]
        at = circle.at(wall)
        for topic, message in self._rover(number, t, at) if name in ROVERS else self._aircraft(number, t, at, circle.z):
            self._put(name, topic, message, t)

    def _put(self, owner: str, topic: topics.Topic[Any], message: Message, t: float) -> None:
        key = topic.at(owner)
        if key not in self._publishers:
            self._publishers[key] = self._bus.publisher(key, topic.message.DESCRIPTOR.full_name, topic.qos)
        self._publishers[key].put(message.SerializeToString(deterministic=True), round(t * 1e9))

    def _rover(self, number: int, t: float, at: tuple[float, float, float]) -> Iterator[tuple[topics.Topic[Any], Message]]:
        x, y, yaw = at
        pose = planar_pose(x, y, yaw)
        yield topics.POSE, PoseInFrame(timestamp=stamp(t), frame_id="world", pose=pose)
        yield topics.ODOMETRY, Odometry(timestamp=stamp(t), linear_velocity=Vector3(x=0.4), angular_velocity=Vector3(z=0.1))
        yield topics.STATUS, _status(Kind.KIND_GROUND)
        yield topics.NAV_STATUS, NavStatus(state=NavStatus.DRIVING, job="goal", goal=Vector3(x=20.0, y=25.0), distance_left=8.0)
        if number % EVERY_SCAN == 0:
            angles = np.linspace(0.0, tau, 360, endpoint=False)
            ranges = 2.0 + 0.5 * np.sin(3 * angles + t)
            yield topics.SCAN, LaserScan(timestamp=stamp(t), frame_id="lidar", start_angle=0.0, end_angle=angles[-1], ranges=ranges)
            ahead = [planar_pose(x + 0.1 * n, y, 0.0) for n in range(30)]
            yield topics.PATH, PosesInFrame(timestamp=stamp(t), frame_id="world", poses=ahead)
        if number % EVERY_MAP == 0:
            yield topics.MAP, occupancy_grid(self._drawn(number), 0.05, x - 5, y - 5, "world", t)

    def _drawn(self, number: int) -> np.ndarray[Any, np.dtype[np.int8]]:
        """A map that goes on changing, by a few rows at a time."""
        row = number // EVERY_MAP * 3 % CELLS
        self._map[row : row + 3] = np.where(np.arange(CELLS) % 17 == number % 17, 100, 0)
        return self._map

    def _aircraft(self, number: int, t: float, at: tuple[float, float, float], z: float) -> Iterator[tuple[topics.Topic[Any], Message]]:
        x, y, yaw = at
        state = NavState(
            timestamp=stamp(t),
            position=Vector3(x=x, y=y, z=z),
            velocity=Vector3(x=16 * cos(yaw), y=16 * sin(yaw)),
            orientation=quaternion(from_euler(0.1 * sin(t), 0.0, yaw)),
            airspeed=16.0,
        )
        yield topics.NAV_STATE, state
        yield topics.TRUTH, state
        yield topics.STATUS, _status(Kind.KIND_FIXED_WING)
        if number % EVERY_PICTURE == 0:
            picture = self._pictures[number // EVERY_PICTURE % 8]
            yield topics.VIEW.by("gimbal"), CompressedImage(timestamp=stamp(t), format="jpeg", data=picture)


def _status(kind: Kind) -> VehicleStatus:
    return VehicleStatus(kind=kind, mode=Mode.MODE_MISSION, armed=True, command_source="mission", battery_remaining=0.8)


def _picture(seed: int) -> bytes:
    """640 x 480, about as large as that of a camera."""
    y, x = np.mgrid[0:480, 0:640]
    noise = np.random.default_rng(seed).normal(0.0, 12.0, (480, 640))
    grey = np.clip(110 + 60 * np.sin(x / 40) * np.cos(y / 30) + noise, 0, 255).astype(np.uint8)
    out = io.BytesIO()
    Image.fromarray(grey).convert("RGB").save(out, "JPEG", quality=70)
    return out.getvalue()


def feed(endpoint: str) -> None:
    """Until it is ended: the vehicles speak in turn within each step, so that no rhythm of a listener meets all of them alike."""
    names = [*ROVERS, *AIRCRAFT]
    with ZenohBus(endpoint) as bus:
        feeder, began = Feeder(bus), time.monotonic()
        turn = 0
        while True:
            t, (number, which) = turn / (HZ * len(names)), divmod(turn, len(names))
            time.sleep(max(0.0, began + t - time.monotonic()))
            if which == 0:
                feeder.tick(number, t)
            feeder.say(names[which], number, t, time.time())
            turn += 1


if __name__ == "__main__":
    feed(sys.argv[1])
