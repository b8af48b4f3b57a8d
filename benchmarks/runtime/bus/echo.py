"""The far end of the round-trip benchmark, its three messages and how they are read.

``python -m benchmarks.runtime.bus.echo raw|uvf|unchecked ENDPOINT``; ends with its parent.
"""

import json
import os
import sys
import time
from collections.abc import Callable

import numpy as np
import zenoh
from google.protobuf.message import Message

from schemas.messages import LaserScan, PoseInFrame
from schemas.topics import Qos
from uvf.runtime.bus.interface import Publisher, Sample
from uvf.runtime.bus.wire import decode_sample
from uvf.runtime.bus.zenoh_bus import ZenohBus
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

PARENT = os.getppid()


def raw(endpoint: str) -> None:
    """Sends bytes back from the callback: as little as zenoh lets one do."""
    config = zenoh.Config()
    config.insert_json5("mode", '"client"')
    config.insert_json5("connect/endpoints", json.dumps([endpoint]))
    with zenoh.open(config) as session:
        for name in MESSAGES:
            back = session.declare_publisher(f"raw/back/{name}", express=True)
            session.declare_subscriber(f"raw/there/{name}", lambda s, p=back: p.put(s.payload))
        while os.getppid() == PARENT:
            time.sleep(0.2)


def uvf(kind: str, endpoint: str) -> None:
    """Decodes, encodes anew and sends back, as a service does; ``unchecked``: without looking at the content."""
    read = READERS[kind]
    with ZenohBus(endpoint) as bus:
        for name, (message, qos) in MESSAGES.items():
            type_ = type(message)
            publisher = bus.publisher(f"uvf/{kind}/back/{name}", type_.DESCRIPTOR.full_name, qos)

            def echo(sample: Sample, type_: type[Message] = type_, publisher: Publisher = publisher) -> None:
                publisher.put(read(sample, type_).SerializeToString(deterministic=True), sample.stamp_ns)

            bus.subscribe(f"uvf/{kind}/there/{name}", qos, echo, depth=8, wake=True)
        while os.getppid() == PARENT:
            bus.wait(0.2)
            bus.poll()


if __name__ == "__main__":
    if sys.argv[1] == "raw":
        raw(sys.argv[2])
    else:
        uvf(*sys.argv[1:])
