"""The three messages of the round-trip benchmark, and how they are read."""

from collections.abc import Callable

import numpy as np
from google.protobuf.message import Message

from schemas.messages import LaserScan, PoseInFrame
from schemas.topics import Qos
from uvf.runtime.bus.interface import Sample
from uvf.runtime.bus.wire import decode_sample
from uvf.runtime.messages.convert import occupancy_grid, planar_pose, stamp

MESSAGES = {
    "pose": (PoseInFrame(timestamp=stamp(1.5), frame_id="world", pose=planar_pose(1.0, 2.0, 0.3)), Qos.STATE),
    "scan 360": (LaserScan(timestamp=stamp(1.5), frame_id="v/lidar", end_angle=6.28, ranges=np.linspace(0.1, 3.5, 360)), Qos.SENSOR),
    "grid 200x200": (occupancy_grid(np.zeros((200, 200), dtype=np.int8), 0.05, -5, -5, "v/map", 1.5), Qos.SENSOR),
}
MESSAGES = {name.replace(" ", "_"): pair for name, pair in MESSAGES.items()}

READERS: dict[str, Callable[[Sample, type[Message]], Message]] = {
    "uvf": decode_sample,
    "unchecked": lambda sample, type_: type_.FromString(sample.payload),
}
