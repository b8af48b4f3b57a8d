"""Frames: a service asks where its lidar was in the world when a scan was taken.

    .venv/bin/python examples/04_frames.py

Simulator, odometry and mapping of the demo's rover run in lockstep beside it; nobody hands transforms around by hand.
"""

import numpy as np

from launch import catalogue
from schemas import topics
from schemas.messages import Event, LaserScan
from uvf.maths.se3 import apply
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.contract.declaration import Reads, Writes, frames, topic
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import scan_points, seconds, stamp
from uvf.runtime.messages.frames import FrameBuffer, FrameError
from uvf.runtime.time.lockstep import Lockstep


class Nearest(Service):
    """Says where in the world the nearest thing stands, once a second."""

    name = "nearest"
    hz = 1.0

    class Inputs(Reads):
        scan: LaserScan = topic(topics.SCAN)
        frames: FrameBuffer = frames()

    class Outputs(Writes):
        events: list[Event] | None = topic(topics.EVENTS.by("nearest"))

    def step(self, t: float, now: Inputs) -> Outputs:
        try:
            world_from_lidar = now.frames.lookup("world", now.scan.frame_id, seconds(now.scan.timestamp))
        except FrameError as error:  # a frame is not known yet, or not yet at that time
            return self.Outputs(events=Event(timestamp=stamp(t), text=str(error), source="nearest"))
        flat = scan_points(now.scan)
        nearest = flat[np.hypot(*flat.T).argmin()]
        x, y, z = apply(world_from_lidar, np.array([(*nearest, 0.0)]))[0]
        return self.Outputs(events=Event(timestamp=stamp(t), text=f"nearest thing at ({x:.2f}, {y:.2f}, {z:.2f}) m", source="nearest"))


site = load_scenario(ROOT / "missions" / "demo.yaml")
hosts = catalogue.hosts(site, [catalogue.kind("sim_ground"), catalogue.kind("slam")])
lockstep = Lockstep([*hosts, ServiceInstance(Nearest, Nearest, "burger")])
events = topics.EVENTS.by("nearest")
lockstep.bus.subscribe(events.at("burger"), events.qos, lambda s: print(Event.FromString(s.payload).text))
lockstep.run(until=4.0)
lockstep.close()
