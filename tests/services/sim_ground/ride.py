"""A ride in lockstep: real physics, wheel commands by a script, every message kept."""

from collections import defaultdict
from dataclasses import dataclass, field

import numpy as np
import yaml

from schemas import topics
from schemas.messages import WheelCommand
from services.sim_ground.build import build
from uvf.maths.kinematics import DifferentialDrive, Twist
from uvf.maths.se2 import Pose2
from uvf.models.scenario import load_scenario
from uvf.runtime.contract.declaration import Writes, topic
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service import Service
from uvf.runtime.messages.convert import stamp, yaw_of
from uvf.runtime.time.lockstep import Lockstep

BURGER = DifferentialDrive(wheel_radius=0.033, track=0.16)
STILL = Twist(0.0, 0.0)


class Driver(Service):
    """Sends the wheel speeds of ``script(t)``; nothing where that is None."""

    name = "driver"
    hz = 50.0

    class Outputs(Writes):
        wheels: WheelCommand | None = topic(topics.WHEEL_COMMAND)

    def __init__(self, script):
        self.script = script

    def step(self, t: float, now) -> Outputs:
        twist = self.script(t)
        if twist is None:
            return self.Outputs()
        left, right = BURGER.wheels(twist)
        return self.Outputs(wheels=WheelCommand(timestamp=stamp(t), left=left, right=right))


def site_with(folder, starts, seed=1, world="house"):
    """A mission in a world; starts: vehicle -> (x, y, yaw)."""
    vehicles = {
        name: {"model": "burger", "system_id": i, "start": dict(zip(("x", "y", "yaw"), start, strict=True))}
        for i, (name, start) in enumerate(starts.items(), 1)
    }
    path = folder / "ride.yaml"
    path.write_text(yaml.safe_dump({"about": "test", "world": world, "seed": seed, "vehicles": vehicles}))
    return load_scenario(path)


@dataclass
class Record:
    """messages: topic key under the vehicle -> all of it, oldest first; data: all bytes in the order sent."""

    messages: dict = field(default_factory=lambda: defaultdict(list))
    data: list = field(default_factory=list)

    def of(self, topic, vehicle="burger"):
        return self.messages[topic.at(vehicle)]

    def pose(self, index, vehicle="burger"):
        truth = self.of(topics.TRUTH, vehicle)[index]
        return Pose2(truth.position.x, truth.position.y, yaw_of(truth.orientation))

    def tilts(self):
        """Angle [rad] between the body's up axis and the vertical, at each truth."""
        up = [1 - 2 * (s.orientation.x**2 + s.orientation.y**2) for s in self.of(topics.TRUTH)]
        return np.arccos(np.clip(up, -1.0, 1.0))


WRITTEN = (topics.IMU, topics.SCAN, topics.WHEELS, topics.CONTACT, topics.JOINTS, topics.TF_JOINTS, topics.TF_STATIC, topics.TRUTH)


def ride(site, until, scripts):
    """scripts: vehicle -> function of t [s] giving a Twist or None."""
    drivers = [ServiceInstance(Driver, lambda s=script: Driver(s), name) for name, script in scripts.items()]
    lockstep = Lockstep(build(site) + drivers)
    record = Record()

    def keep(topic, sample):
        record.messages[sample.key].append(topic.message.FromString(sample.payload))
        record.data.append((sample.key, sample.stamp_ns, sample.payload))

    for of in WRITTEN:
        lockstep.bus.subscribe(of.at("*"), of.qos, lambda sample, which=of: keep(which, sample))
    lockstep.run(until)
    lockstep.close()
    return record
