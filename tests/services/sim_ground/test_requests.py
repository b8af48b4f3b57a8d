"""What can be asked of the running simulation: spawn, remove, set pose, save and restore, each refused in one clear line."""

import numpy as np
import pytest

from schemas import topics
from schemas.messages import RemoveRequest, SetPoseRequest, SimObject, SimObjects, SpawnRequest, StateRequest
from services.sim_ground.build import build
from tests.services.asking import Asked
from tests.services.sim_ground.ride import Driver, site_with
from uvf.maths.kinematics import Twist
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.messages import spawned
from uvf.runtime.messages.convert import planar_pose, seconds, stamp

START = (6.0, 4.4, 0.0)
HEARD = (topics.IMU, topics.SCAN, topics.WHEELS, topics.TRUTH, topics.JOINTS, topics.CONTACT, topics.TF_STATIC, topics.OBJECTS)


class Run(Asked):
    """A burger in the hall that can be asked things between two moments."""

    def __init__(self, folder, script=lambda t: None, drivers=("burger",), world="house", start=START):
        hosts = [ServiceInstance(Driver, lambda: Driver(script), name) for name in drivers]
        super().__init__(build(site_with(folder, {"burger": start}, world=world)) + hosts, "burger", HEARD)

    def place(self, owner=""):
        position = self.of(topics.TRUTH, owner)[-1].position
        return position.x, position.y, position.z


@pytest.fixture
def run(tmp_path):
    made = Run(tmp_path)
    yield made
    made.lockstep.close()


def crate(name="crate", x=7.0, y=4.4, mass=0.0, **other):
    said = {"shape": "box", "size": [0.3, 0.3, 0.3], "pose": planar_pose(x, y, 0.0, 0.15), "mass": mass}
    return SpawnRequest(object=SimObject(name=name, **{**said, **other}))


def test_a_crate_is_seen_by_the_lidar_told_of_and_gone_again(run):
    run.lockstep.run(0.3)
    free = run.of(topics.SCAN)[-1].ranges[0]
    assert run.ask(topics.SPAWN, crate(), 0.6).accepted
    assert free > 3.0 or free == 0.0
    assert run.of(topics.SCAN)[-1].ranges[0] == pytest.approx(1.0 + 0.032 - 0.15, abs=0.04)
    assert [o.name for o in run.of(topics.OBJECTS, "sys")[-1].objects] == ["crate"]
    assert run.ask(topics.REMOVE, RemoveRequest(name="crate"), 1.1).accepted
    run.lockstep.run(1.3)
    assert run.of(topics.SCAN)[-1].ranges[0] == pytest.approx(free, abs=0.04)
    assert run.of(topics.OBJECTS, "sys")[-1] == SimObjects(timestamp=run.of(topics.OBJECTS, "sys")[-1].timestamp)


def test_a_light_crate_is_pushed_along_and_told_where_it_is(tmp_path):
    run = Run(tmp_path, lambda t: Twist(0.2, 0.0))
    assert run.ask(topics.SPAWN, crate(x=6.3, mass=0.05, size=[0.2, 0.2, 0.2], pose=planar_pose(6.3, 4.4, 0.0, 0.1)), 0.1).accepted
    run.lockstep.run(4.0)
    x = run.of(topics.OBJECTS, "sys")[-1].objects[0].pose.position.x
    assert x > 6.5
    assert run.of(topics.CONTACT)[-1].other == "crate"
    run.lockstep.close()


def test_a_second_vehicle_is_spawned_with_its_sensors_and_its_actuator_topic(tmp_path):
    run = Run(tmp_path, lambda t: Twist(0.2, 0.0) if t > 1.0 else None, drivers=("guest",))
    wanted = SpawnRequest(object=SimObject(name="guest", model="burger", pose=planar_pose(7.0, 4.4, 0.5)))
    assert run.ask(topics.SPAWN, wanted, 1.0).accepted
    run.lockstep.run(3.0)
    x, y, _ = run.place("guest")
    assert np.hypot(x - 7.0, y - 4.4) == pytest.approx(0.4, abs=0.05)
    assert len(run.of(topics.TF_STATIC, "guest")) == 1
    assert {len(run.of(topic, "guest")) > 5 for topic in (topics.IMU, topics.SCAN, topics.WHEELS, topics.JOINTS)} == {True}
    assert run.of(topics.SCAN)[-1].ranges[0] < 1.5
    run.lockstep.close()


def test_a_vehicle_is_put_elsewhere_and_stands(tmp_path):
    run = Run(tmp_path, lambda t: Twist(0.3, 0.0) if t < 1.0 else None)
    run.lockstep.run(1.6)
    assert run.ask(topics.SET_POSE, SetPoseRequest(name="burger", pose=planar_pose(9.0, 4.4, 1.0)), 2.0).accepted
    assert run.place() == pytest.approx((9.0, 4.4, 0.0), abs=2e-3)
    assert np.hypot(run.of(topics.TRUTH)[-1].velocity.x, run.of(topics.TRUTH)[-1].velocity.y) < 1e-3
    run.lockstep.close()


def test_more_things_than_there_may_be_are_refused_with_the_mend(run, monkeypatch):
    monkeypatch.setattr(spawned, "SPAWNED_MOST", 2)
    assert run.ask(topics.SPAWN, crate("a"), 0.1).accepted and run.ask(topics.SPAWN, crate("b", x=8.0), 0.3).accepted
    reply = run.ask(topics.SPAWN, crate("c", x=9.0), 0.5)
    assert reply.reason == "2 things are there already, 2 at most: remove some first"
    assert run.ask(topics.REMOVE, RemoveRequest(name="a"), 0.7).accepted
    assert run.ask(topics.SPAWN, crate("c", x=9.0), 0.9).accepted


def test_a_name_that_the_air_simulator_has_put_in_is_taken(run):
    flying = SimObjects(timestamp=stamp(0.0), objects=[SimObject(name="crate", model="milvus")])
    publisher = run.lockstep.bus.publisher(topics.AIR_OBJECTS.at("sys"), SimObjects.DESCRIPTOR.full_name, topics.AIR_OBJECTS.qos)
    publisher.put(flying.SerializeToString(), 0)
    reply = run.ask(topics.SPAWN, crate(), 0.2)
    assert reply.reason == "there is a 'crate' already; take another name"


TERRACE, RAMP = (32.0, 23.0, 0.0), (26.6, 24.0, 0.0)  # of the plaza: 0.4 m up, and half that on the way to it


@pytest.mark.parametrize(("start", "height"), [(TERRACE, 0.4), (RAMP, 0.2)])
def test_a_start_on_a_platform_or_a_ramp_is_on_top_of_it(tmp_path, start, height):
    run = Run(tmp_path, world="plaza", start=start)
    run.lockstep.run(1.0)
    assert run.place() == pytest.approx((*start[:2], height), abs=0.04)
    run.lockstep.close()


def test_a_vehicle_is_put_in_at_the_height_asked_for(tmp_path):
    run = Run(tmp_path, world="plaza", start=(20.0, 8.0, 0.0))
    low, high = (SpawnRequest(object=SimObject(name="guest", model="burger", pose=planar_pose(*TERRACE, z))) for z in (0.0, 0.4))
    assert run.ask(topics.SPAWN, low, 0.3).reason == "'guest' would stand in 'terrace' there; choose another place"
    assert run.ask(topics.SPAWN, high, 0.6).accepted
    run.lockstep.run(1.6)
    assert run.place("guest") == pytest.approx((*TERRACE[:2], 0.4), abs=2e-3)
    run.lockstep.close()


def test_after_a_restore_the_run_repeats_bit_for_bit(tmp_path):
    """At another phase of every sensor's rate; the commands are the same again."""
    saved, again, seconds_ = 0.53, 1.87, 1.2
    command = lambda t: Twist(0.3, 2.0 * np.sin(7.0 * t))  # noqa: E731
    run = Run(tmp_path, lambda t: command(round(t - again if t > again - 0.065 else t - saved, 9)))
    assert run.ask(topics.SPAWN, crate(x=6.6, y=4.5, mass=0.2), 0.2).accepted
    assert run.ask(topics.SAVE, StateRequest(name="here"), saved).accepted
    marks = {key: len(messages) for key, messages in run.heard.items()}
    run.lockstep.run(saved + seconds_)
    first = {key: messages[marks[key] :] for key, messages in run.heard.items() if "truth/objects" not in key}
    assert run.ask(topics.RESTORE, StateRequest(name="here"), again).accepted
    marks = {key: len(messages) for key, messages in run.heard.items()}
    run.lockstep.run(again + seconds_)
    assert all(len(messages) > 3 for key, messages in first.items() if "tf/" not in key)
    for key, messages in first.items():
        second = run.heard[key][marks[key] :]
        assert [seconds(m.timestamp) for m in second] == pytest.approx([seconds(m.timestamp) + again - saved for m in messages])
        for message in (*messages, *second):
            message.ClearField("timestamp")
        assert second == messages, key
    run.lockstep.close()


REFUSED = [
    (topics.SPAWN, crate(name="burger"), "there is a 'burger' already; take another name"),
    (topics.SPAWN, crate(name="a/b"), "'a/b' is no name"),
    (topics.SPAWN, crate(x=6.0, y=4.4), "'crate' would stand in 'burger' there; choose another place"),
    (topics.SPAWN, crate(x=6.0, y=5.1), "'crate' would stand in 'wall' there; choose another place"),
    (topics.SPAWN, crate(x=np.nan), "not finite"),
    (topics.SPAWN, crate(shape="bux"), "there is no shape 'bux'; did you mean 'box'?"),
    (topics.SPAWN, crate(size=[1.0]), "a box has 3 measures [m], not 1"),
    (topics.SPAWN, crate(size=[0.0, 1.0, 1.0]), "must be 0.001 to 100 m"),
    (topics.SPAWN, crate(mass=-1.0), "the mass must be 0"),
    (topics.SPAWN, SpawnRequest(object=SimObject(name="guest", model="burgr")), "no vehicle 'burgr'"),
    (topics.SPAWN, SpawnRequest(object=SimObject(name="guest", model="milvus")), "'milvus' is no ground vehicle"),
    (topics.REMOVE, RemoveRequest(name="burger"), "'burger' belongs to the mission"),
    (topics.REMOVE, RemoveRequest(name="crate"), "there is no 'crate'"),
    (topics.SET_POSE, SetPoseRequest(name="burgr"), "there is no 'burgr' that can be put elsewhere; did you mean 'burger'?"),
    (topics.SET_POSE, SetPoseRequest(name="burger", pose=planar_pose(0.6, 2.2, 0.0)), "'burger' would stand in 'sofa' there"),
    (topics.SET_POSE, SetPoseRequest(name="burger", pose=planar_pose(6.0, 4.4, 0.0, -0.1)), "would stand in 'floor' there"),
    (topics.RESTORE, StateRequest(name="here"), "no state 'here' has been saved"),
]


def test_what_cannot_be_done_is_refused_in_one_line_and_changes_nothing(run):
    run.lockstep.run(0.1)
    for n, (request, message, reason) in enumerate(REFUSED, 2):
        reply = run.ask(request, message, n / 10)
        assert not reply.accepted
        assert reason in reply.reason and "\n" not in reply.reason
    assert run.place() == pytest.approx((*START[:2], 0.0), abs=1e-3)
    assert run.of(topics.OBJECTS, "sys") == []


def test_a_state_that_needs_what_has_been_removed_is_refused(run):
    assert run.ask(topics.SPAWN, crate(), 0.1).accepted
    assert run.ask(topics.SAVE, StateRequest(name="with"), 0.2).accepted
    assert run.ask(topics.REMOVE, RemoveRequest(name="crate"), 0.3).accepted
    assert run.ask(topics.SPAWN, crate(), 0.4).accepted
    reply = run.ask(topics.RESTORE, StateRequest(name="with"), 0.5)
    assert "'crate' has been removed since 'with' was saved" in reply.reason


def test_what_was_put_in_after_a_save_is_taken_out_by_the_restore(run):
    assert run.ask(topics.SAVE, StateRequest(name="without"), 0.2).accepted
    assert run.ask(topics.SPAWN, crate(), 0.3).accepted
    assert run.ask(topics.RESTORE, StateRequest(name="without"), 0.5).accepted
    assert list(run.of(topics.OBJECTS, "sys")[-1].objects) == []
