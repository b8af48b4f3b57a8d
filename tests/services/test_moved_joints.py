"""A lift, a pan and a spring, from the request to the picture: real physics, autopilot and camera in lockstep."""

import io
from math import nan, pi

import numpy as np
import pytest
from PIL import Image

from schemas import topics
from schemas.messages import ArmRequest, JointTarget, MoveJointsRequest, Reply, StopCommand
from services.autopilot.ground.build import hosts
from services.sim_camera.build import build as cameras
from services.sim_ground.build import build as simulator
from tests.services.mast import LIFT, PAN, mast_site
from uvf.runtime.messages.convert import stamp
from uvf.runtime.time.lockstep import Lockstep

HEARD = (topics.JOINTS, topics.TF_JOINTS, topics.TF_STATIC, topics.IMAGE, topics.JOINT_COMMAND, topics.EVENTS.by("autopilot"))


class Run:
    """A run of one mast; ``t`` [s] is how far it has come."""

    def __init__(self, folder, **entry):
        site = mast_site(folder, job={"armed": True}, **entry)
        self.lockstep = Lockstep([*simulator(site), *hosts(site), *cameras(site)])
        self.heard = {topic: [] for topic in HEARD}
        for topic in HEARD:
            keep = lambda sample, t=topic: self.heard[t].append(t.message.FromString(sample.payload))  # noqa: E731
            self.lockstep.bus.subscribe(topic.at("mast"), topic.qos, keep)
        self.t = 0.0

    def go(self, seconds):
        self.t += seconds
        self.lockstep.run(self.t)
        return self

    def ask(self, request, message):
        got = []
        self.lockstep.bus.call(request.at("mast"), message.SerializeToString(), round(self.t * 1e9) + 1, lambda *reply: got.append(reply))
        self.go(0.1)
        return Reply.FromString(got[0][0])

    def move(self, **targets):
        return self.ask(topics.MOVE_JOINTS, MoveJointsRequest(joints=[JointTarget(name=n, position=p) for n, p in targets.items()]))

    def at(self, name):
        return next(joint.position for joint in self.heard[topics.JOINTS][-1].joints if joint.name == name)

    def frame(self, child):
        told = [f for m in self.heard[topics.TF_JOINTS][-1:] for f in m.transforms]
        return next(f for f in told if f.child_frame_id == f"mast/{child}")

    def picture(self):
        return np.asarray(Image.open(io.BytesIO(self.heard[topics.IMAGE][-1].data))).astype(int)


@pytest.fixture
def run(tmp_path):
    made = Run(tmp_path).go(0.5)
    yield made
    made.lockstep.close()


def test_a_lift_goes_up_at_its_own_speed_and_stays_there(run):
    assert run.at(LIFT) == pytest.approx(0.0, abs=2e-3)
    assert run.move(**{LIFT: 0.2}).accepted
    run.go(0.9)
    assert run.at(LIFT) == pytest.approx(0.1, abs=0.015)
    run.go(2.0)
    assert run.at(LIFT) == pytest.approx(0.2, abs=2e-3)
    assert run.frame("lift").translation.z == pytest.approx(0.4, abs=2e-3)
    assert any(f"{LIFT} to 0.2" in event.text for event in run.heard[topics.EVENTS.by("autopilot")])


def test_joints_that_nobody_has_moved_are_not_commanded(run):
    assert not run.heard[topics.JOINT_COMMAND]
    run.move(**{PAN: 0.5})
    assert [joint.name for joint in run.heard[topics.JOINT_COMMAND][-1].joints] == [PAN]


def test_a_camera_turns_with_the_head_and_its_frame_hangs_there(run):
    before = run.picture()
    assert run.move(**{PAN: pi / 2}).accepted
    run.go(2.5)
    assert run.at(PAN) == pytest.approx(pi / 2, abs=5e-3)
    assert np.abs(run.picture() - before).mean() > 10
    (camera,) = (f for m in run.heard[topics.TF_STATIC] for f in m.transforms if f.child_frame_id == "mast/camera")
    assert camera.parent_frame_id == "mast/head" and camera.translation.x == pytest.approx(0.02)


def test_a_head_that_looks_back_sees_what_a_vehicle_turned_round_sees(tmp_path):
    turned = Run(tmp_path / "there").go(0.5)
    turned.move(**{PAN: pi})
    turned.go(4.5)
    back = Run(tmp_path / "back", start=(5.94, 4.4, pi)).go(1.0)
    assert np.abs(turned.picture() - back.picture()).mean() < 3
    turned.lockstep.close(), back.lockstep.close()


@pytest.mark.parametrize(
    ("targets", "why"),
    [
        ({"lift_jont": 0.1}, "there is no joint 'lift_jont' that is moved on command; did you mean 'lift_joint'?"),
        ({"tray_joint": 0.01}, "there is no joint 'tray_joint' that is moved on command"),
        ({LIFT: 0.31}, "lift_joint: 0.31 is beyond its range, 0 to 0.3"),
        ({LIFT: nan}, "joints[0].position: nan is not finite"),
        ({}, "no joint is named; there are: lift_joint, head_joint"),
    ],
)
def test_what_cannot_be_is_refused_and_moves_nothing(run, targets, why):
    reply = run.move(**targets)
    assert not reply.accepted and why in reply.reason
    assert not run.heard[topics.JOINT_COMMAND]


def test_disarmed_it_is_refused_and_what_is_under_way_stands(run):
    run.move(**{LIFT: 0.3})
    run.go(0.9)
    assert run.ask(topics.ARM, ArmRequest(arm=False)).accepted
    there = run.go(0.5).at(LIFT)
    assert 0.08 < there < 0.15
    assert not run.move(**{LIFT: 0.0}).accepted
    assert run.ask(topics.ARM, ArmRequest(arm=True)).accepted
    assert run.go(1.0).at(LIFT) == pytest.approx(there, abs=3e-3)  # it does not go on by itself


def test_stop_all_holds_them(run):
    run.move(**{LIFT: 0.3})
    run.go(0.9)
    stop = StopCommand(timestamp=stamp(run.t), engaged=True, source="gcs", id=1)
    topic = topics.STOP.by("gcs")
    run.lockstep.bus.publisher(topic.at("sys"), topic.message.DESCRIPTOR.full_name, topic.qos).put(
        stop.SerializeToString(), round(run.t * 1e9)
    )
    there = run.go(0.5).at(LIFT)
    assert run.go(1.0).at(LIFT) == pytest.approx(there, abs=3e-3) and there < 0.2
    assert "STOP ALL" in run.move(**{LIFT: 0.0}).reason


def test_a_tray_on_a_spring_sinks_by_its_weight(run):
    assert run.go(2.0).at("tray_joint") == pytest.approx(-0.2 * 9.81 / 100.0, abs=5e-4)
