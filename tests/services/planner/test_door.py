"""Two rovers want through the same narrow door at the same time, in opposite directions: both come through, and touch nothing."""

import numpy as np
import pytest
import yaml

from launch import catalogue
from schemas import topics
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.time.lockstep import Lockstep

KINDS = ("sim_ground", "slam", "planner", "autopilot")
DOOR = 0.44  # m, 0.24 m wider than one rover and 0.04 m wider than two
LAST = 80.0  # s
BEGUN = {"left": (0.8, 1.5, 0.0), "right": (3.2, 1.5, np.pi)}
"""Start (x, y [m], yaw [rad])."""
WANTED = {"left": (3.3, 1.5), "right": (0.7, 1.5)}
"""m."""


def two_rooms(folder):
    """Rooms of 2 x 3 m with a door between, and a rover in each."""
    (folder / "worlds" / "rooms").mkdir(parents=True)
    low, high = 1.5 - DOOR / 2, 1.5 + DOOR / 2
    walls = [[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [0.0, 0.0]], [[2.0, 0.0], [2.0, low]], [[2.0, high], [2.0, 3.0]]]
    boxes = [{"name": f"box_{k}", "centre": [x, y, 0.25], "size": [0.3, 0.3, 0.5]} for k, (x, y) in enumerate(((0.5, 0.4), (3.4, 2.6)))]
    origin = {"latitude": 40.77, "longitude": 14.79, "altitude": 300.0}
    world = {
        "about": "Two rooms.",
        "origin": origin,
        "floor": [0.0, 0.0, 4.0, 3.0],
        "walls": [{"points": points, "height": 1.0} for points in walls],
    }
    (folder / "worlds" / "rooms" / "world.yaml").write_text(yaml.safe_dump(world | {"boxes": boxes}))
    (folder / "vehicles").symlink_to(ROOT / "vehicles")
    rovers = {
        name: {
            "model": "burger",
            "system_id": n,
            "start": dict(zip(("x", "y", "yaw"), map(float, BEGUN[name]), strict=True)),
            "job": {"mission": [dict(zip("xy", WANTED[name], strict=True))]},
        }
        for n, name in enumerate(BEGUN, start=1)
    }
    path = folder / "mission.yaml"
    path.write_text(yaml.safe_dump({"about": "A door.", "world": "rooms", "seed": 1, "vehicles": rovers}))
    return load_scenario(path, folder)


@pytest.fixture(scope="module")
def met(tmp_path_factory):
    """What was said, by topic and vehicle."""
    run = Lockstep(catalogue.hosts(two_rooms(tmp_path_factory.mktemp("door")), [catalogue.kind(kind) for kind in KINDS]))
    heard = (topics.TRUTH, topics.CONTACT, topics.NAV_STATUS)
    kept = {(topic.key, name): [] for topic in heard for name in BEGUN}
    for topic in heard:
        for name in BEGUN:
            into = kept[topic.key, name]
            run.bus.subscribe(topic.at(name), topic.qos, lambda s, k=topic, m=into: m.append(k.message.FromString(s.payload)))
    run.run(LAST)
    run.close()
    return kept


def test_both_come_through(met):
    for name, (x, y) in WANTED.items():
        end = met[topics.TRUTH.key, name][-1].position
        assert np.hypot(end.x - x, end.y - y) < 0.3, name


def test_one_waited_for_the_other_and_nothing_was_touched(met):
    waited = {name: any("waits for" in said.reason for said in met[topics.NAV_STATUS.key, name]) for name in BEGUN}
    assert sorted(waited.values()) == [False, True]
    assert not any(said.touching for name in BEGUN for said in met[topics.CONTACT.key, name])
