"""A rover explores with its lidar anywhere and looking anywhere: physics, slam, planner and autopilot together in lockstep."""

import shutil

import numpy as np
import pytest
import yaml

from schemas import topics
from services.autopilot.ground.build import hosts
from services.planner.build import build as build_planner
from services.planner.exploration_goals import SETTLING
from services.sim_ground.build import build as build_simulator
from services.slam.build import build as build_slam
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.messages.maps.mapped_floor import MappedFloor
from uvf.runtime.time.lockstep import Lockstep

FIRST, LAST = 3.0, SETTLING + 15.0  # s
MOUNTS = {  # x, y [m], yaw, field of view [deg]
    "front corner": (0.11, 0.08, 0.0, 180),
    "rear corner": (-0.11, -0.08, 180.0, 180),
    "narrow": (0.0, 0.0, 0.0, 60),
}


def mission(folder, mount):
    """A copy of the burger with another lidar, which explores the house."""
    x, y, yaw, view = mount
    shutil.copytree(ROOT / "vehicles" / "burger", folder / "vehicles" / "rover")
    path = folder / "vehicles" / "rover" / "vehicle.yaml"
    vehicle = yaml.safe_load(path.read_text())
    seen = {"beams": view + 1, "angle_min": -np.radians(view / 2).item(), "angle_increment": np.radians(1.0).item()}
    fitted = {"mount": {"xyz": [x, y, 0.2], "rpy": [0.0, 0.0, np.radians(yaw).item()]}}
    vehicle["sensors"]["lidar"] = {"hz": 10.0, "range_min": 0.05, "range_max": 8.0, "noise": 0.01, **seen, **fitted}
    path.write_text(yaml.safe_dump(vehicle))
    shutil.copytree(ROOT / "worlds" / "house", folder / "worlds" / "house")
    rover = {"model": "rover", "system_id": 1, "start": {"x": 2.2, "y": 1.3, "yaw": 0.5}, "job": {"explore": True}}
    (folder / "mission.yaml").write_text(
        yaml.safe_dump({"about": "a test", "world": "house", "duration": LAST, "vehicles": {"rover": rover}})
    )
    return load_scenario(folder / "mission.yaml", folder)


@pytest.mark.parametrize("mount", MOUNTS.values(), ids=MOUNTS.keys())
def test_exploring_begins_and_the_mapped_floor_grows(mount, tmp_path):
    site = mission(tmp_path, mount)
    run = Lockstep([host for part in (build_simulator, build_slam, build_planner, hosts) for host in part(site)])
    kept = {topic: [] for topic in (topics.MAP, topics.NAV_STATUS, topics.CONTACT)}
    for topic, messages in kept.items():
        run.bus.subscribe(topic.at("rover"), topic.qos, lambda s, t=topic, m=messages: m.append(t.message.FromString(s.payload)))
    floor = MappedFloor(site.world, site.members["rover"])
    run.run(FIRST)
    first = floor.share(kept[topics.MAP][0])
    run.run(LAST)
    run.close()
    assert all(status.explored < 1.0 for status in kept[topics.NAV_STATUS])
    assert floor.share(kept[topics.MAP][-1]) > first + 0.1
    assert not any(contact.touching for contact in kept[topics.CONTACT])
