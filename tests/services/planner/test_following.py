"""A rover follows another one that explores: physics, slam, planner and autopilot of both in lockstep."""

import numpy as np
import yaml

from launch import catalogue
from schemas import topics
from schemas.messages import ArmRequest, FollowRequest, Mode, ModeRequest
from uvf.models.scenario import load_scenario
from uvf.runtime.time.lockstep import Lockstep

KINDS = ("sim_ground", "slam", "planner", "autopilot")
LAST = 45.0  # s


def test_it_stays_behind_the_one_that_explores_and_touches_nothing(tmp_path):
    rovers = {
        name: {"model": "burger", "system_id": n, "start": {"x": x, "y": y, "yaw": 0.5}, "job": job}
        for n, (name, x, y, job) in enumerate((("lead", 2.2, 1.3, {"explore": True}), ("tail", 1.4, 1.0, {})), start=1)
    }
    path = tmp_path / "two.yaml"
    path.write_text(yaml.safe_dump({"about": "Two.", "world": "house", "seed": 1, "vehicles": rovers}))
    run = Lockstep(catalogue.hosts(load_scenario(path), [catalogue.kind(kind) for kind in KINDS]))
    places, touched = {name: [] for name in rovers}, []

    def hear(topic, name, take):
        run.bus.subscribe(topic.at(name), topic.qos, lambda s: take(s.stamp_ns / 1e9, topic.message.FromString(s.payload)))

    for name in rovers:
        hear(topics.TRUTH, name, lambda t, m, n=name: places[n].append((t, m.position.x, m.position.y)))
        hear(topics.CONTACT, name, lambda t, m: touched.append(t) if m.touching else None)
    accepted = []

    def ask(request, message, t):
        run.run(t)
        reply = request.reply.FromString
        run.bus.call(
            request.at("tail"), message.SerializeToString(), round(t * 1e9), lambda r, why, at: accepted.append(r and reply(r).accepted)
        )

    ask(topics.ARM, ArmRequest(arm=True, source="test"), 1.0)
    ask(topics.SET_MODE, ModeRequest(mode=Mode.MODE_MISSION, source="test"), 2.0)
    ask(topics.FOLLOW, FollowRequest(vehicle="lead", distance=0.8, source="test"), 3.0)
    run.run(LAST)
    run.close()
    lead, tail = (np.array(places[name])[::50] for name in ("lead", "tail"))
    apart = np.hypot(*(lead - tail)[:, 1:].T)
    assert accepted == [True, True, True]
    assert np.hypot(*np.diff(tail[:, 1:], axis=0).T).sum() > 6.0
    assert apart[len(apart) // 3 :].max() < 2.2
    assert apart.min() > 0.3
    assert touched == []
