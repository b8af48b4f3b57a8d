"""What can be asked of the air simulation: spawn, remove, save and restore, each refused in one clear line."""

from collections import Counter

import numpy as np
import pytest

from schemas import topics
from schemas.messages import (
    NavState,
    RemoveRequest,
    SetPoseRequest,
    SimObject,
    SpawnRequest,
    StateRequest,
    SurfaceCommand,
    Vector3,
    WindRequest,
)
from services.sim_air.build import build
from tests.services.asking import Asked
from uvf.models.scenario import load_scenario
from uvf.runtime.contract.declaration import Reads, Writes, every, topic
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service import Service
from uvf.runtime.messages import spawned
from uvf.runtime.messages.convert import array, planar_pose, seconds

MISSION = """
about: One.
world: house
seed: 4
wind: {{steady: [1.0, 2.0, 0.0], turbulence: {{severity: light}}}}
vehicles:
  bird: {{model: {model}, system_id: 1, start: {{x: -200.0, y: 0.0, z: 80.0}}}}
"""
HEARD = (
    topics.IMU,
    topics.GNSS,
    topics.AIR_DATA,
    topics.RANGE,
    topics.TRUTH,
    topics.JOINTS,
    topics.BATTERY,
    topics.TF_STATIC,
    topics.AIR_OBJECTS,
)


class Pilot(Service):
    """Moves the ailerons by a script."""

    name = "pilot"
    hz = 50.0

    class Inputs(Reads):
        truth: list[NavState] = every(topics.TRUTH)

    class Outputs(Writes):
        surfaces: SurfaceCommand | None = topic(topics.SURFACE_COMMAND)

    def __init__(self, script):
        self._script = script

    def step(self, t: float, now: Inputs) -> Outputs:
        return self.Outputs(surfaces=SurfaceCommand(aileron=self._script(t), elevator=-0.14, throttle=0.75))


class Run(Asked):
    """An aircraft that can be asked things between two moments."""

    def __init__(self, folder, script=None, model="milvus_survey", mission=MISSION):
        path = folder / "one.yaml"
        path.write_text(mission.format(model=model))
        pilot = [ServiceInstance(Pilot, lambda: Pilot(script), "bird")] if script else []
        super().__init__(build(load_scenario(path)) + pilot, "bird", HEARD)

    def place(self, owner=""):
        return array(self.of(topics.TRUTH, owner)[-1].position)


@pytest.fixture
def run(tmp_path):
    made = Run(tmp_path)
    yield made
    made.lockstep.close()


def guest(name="guest", model="milvus", z=90.0, x=-300.0, speed=0.0):
    return SpawnRequest(object=SimObject(name=name, model=model, pose=planar_pose(x, 60.0, 0.0, z)), speed=speed)


def test_more_things_than_there_may_be_are_refused_with_the_mend(run, monkeypatch):
    monkeypatch.setattr(spawned, "SPAWNED_MOST", 1)
    assert run.ask(topics.AIR_SPAWN, guest("a"), 0.1).accepted
    reply = run.ask(topics.AIR_SPAWN, guest("b", x=-400.0), 0.3)
    assert reply.reason == "1 things are there already, 1 at most: remove some first"


def test_an_aircraft_is_put_in_flying_with_its_sensors_told_of_and_gone_again(run):
    assert run.ask(topics.AIR_SPAWN, guest(speed=23.0), 1.0).accepted
    run.lockstep.run(2.95)
    assert run.place("guest") == pytest.approx((-300.0 + 2.0 * 24.0, 60.0 + 4.0, 90.0), abs=3.0)
    assert {len(run.of(topic, "guest")) > 1 for topic in (topics.IMU, topics.GNSS, topics.AIR_DATA, topics.JOINTS)} == {True}
    assert len(run.of(topics.TF_STATIC, "guest")) == 1
    (told,) = run.of(topics.AIR_OBJECTS, "sys")[-1].objects
    assert (told.name, told.model) == ("guest", "milvus")
    assert array(told.pose.position) == pytest.approx(run.place("guest"), abs=1.0)
    assert run.ask(topics.AIR_REMOVE, RemoveRequest(name="guest"), 3.0).accepted
    heard = len(run.of(topics.TRUTH, "guest"))
    run.lockstep.run(3.5)
    assert len(run.of(topics.TRUTH, "guest")) == heard
    assert not run.of(topics.AIR_OBJECTS, "sys")[-1].objects


def test_put_in_at_no_height_it_stands(run):
    assert run.ask(topics.AIR_SPAWN, guest(z=0.0), 0.5).accepted
    run.lockstep.run(2.0)
    assert run.place("guest")[:2] == pytest.approx((-300.0, 60.0), abs=0.05)
    assert run.place("guest")[2] < 1.0


def test_what_has_been_put_in_may_be_put_elsewhere_too(run):
    assert run.ask(topics.AIR_SPAWN, guest(), 0.5).accepted
    assert run.ask(topics.AIR_POSE, SetPoseRequest(name="guest", pose=planar_pose(100.0, 300.0, 0.0, 50.0)), 1.0).accepted
    assert run.place("guest") == pytest.approx((101.0, 300.0, 50.0), abs=1.5)


def test_put_elsewhere_it_did_not_fly_through_what_lies_between(tmp_path):
    """From one side of the house to the other, low."""
    run = Run(tmp_path)
    for until, x in ((0.5, -40.0), (1.0, 60.0)):
        assert run.ask(topics.AIR_POSE, SetPoseRequest(name="bird", pose=planar_pose(x, 5.0, np.pi / 2, 2.0)), until).accepted
    assert np.linalg.norm(array(run.of(topics.TRUTH)[-1].velocity)) > 10.0
    run.lockstep.close()


def test_after_a_restore_the_run_repeats_bit_for_bit(tmp_path):
    """In turbulence, at another phase of every sensor's rate; the commands are the same again."""
    saved, again, lasting = 0.53, 2.87, 1.2
    command = lambda t: 0.1 * np.sin(7.0 * t)  # noqa: E731
    run = Run(tmp_path, lambda t: command(round(t - again if t > again - 0.065 else t - saved, 9)))
    assert run.ask(topics.AIR_SPAWN, guest(), 0.2).accepted
    assert run.ask(topics.AIR_SAVE, StateRequest(name="here"), saved).accepted
    marks = Counter({key: len(messages) for key, messages in run.heard.items()})
    run.lockstep.run(saved + lasting)
    first = {key: messages[marks[key] :] for key, messages in run.heard.items() if "truth/aircraft" not in key}
    assert run.ask(topics.AIR_RESTORE, StateRequest(name="here"), again).accepted
    marks = Counter({key: len(messages) for key, messages in run.heard.items()})
    run.lockstep.run(again + lasting)
    assert sum(len(messages) > 3 for messages in first.values()) == 2 * 6  # imu, gnss, air data, truth, joints and range finder of both
    for key, messages in first.items():
        second = run.heard[key][marks[key] :]
        assert [seconds(m.timestamp) for m in second] == pytest.approx([seconds(m.timestamp) + again - saved for m in messages])
        for message in (*messages, *second):
            message.ClearField("timestamp")
        assert second == messages, key
    run.lockstep.close()


def test_a_restore_brings_back_what_was_removed_and_takes_out_what_was_put_in(run):
    assert run.ask(topics.AIR_SPAWN, guest("early"), 0.5).accepted
    assert run.ask(topics.AIR_SAVE, StateRequest(name="here"), 0.6).accepted
    place = run.place("early")
    assert run.ask(topics.AIR_REMOVE, RemoveRequest(name="early"), 0.7).accepted
    assert run.ask(topics.AIR_SPAWN, guest("later", z=120.0), 0.8).accepted
    assert run.ask(topics.AIR_RESTORE, StateRequest(name="here"), 1.6).accepted
    assert run.place("early") == pytest.approx(place, abs=1.0)
    run.lockstep.run(1.8)
    assert [o.name for o in run.of(topics.AIR_OBJECTS, "sys")[-1].objects] == ["early"]


def test_asking_whether_it_could_be_done_changes_nothing(run):
    assert run.ask(topics.AIR_SAVE, StateRequest(name="here", only_ask=True), 0.3).accepted
    assert "no state 'here'" in run.ask(topics.AIR_RESTORE, StateRequest(name="here", only_ask=True), 0.5).reason
    assert run.ask(topics.AIR_SAVE, StateRequest(name="here"), 0.7).accepted
    assert run.ask(topics.AIR_RESTORE, StateRequest(name="here", only_ask=True), 1.5).accepted
    assert run.place()[0] == pytest.approx(-200.0 + 26.0 * 1.5, abs=3.0)


REFUSED = [
    (topics.AIR_SPAWN, guest("bird"), "there is a 'bird' already; take another name"),
    (topics.AIR_SPAWN, guest("Guest"), "'Guest' is no name"),
    (topics.AIR_SPAWN, guest("sys"), "'sys' is no name"),
    (topics.AIR_SPAWN, guest(model="milvs"), "no vehicle 'milvs'"),
    (topics.AIR_SPAWN, guest(model="burger"), "'burger' is no aircraft; this is the air simulator"),
    (topics.AIR_SPAWN, guest(z=-3.0), "it would be under the ground"),
    (topics.AIR_SPAWN, guest(x=2e5), "positions within"),
    (topics.AIR_SPAWN, guest(speed=90.0), "no level flight at 90"),
    (topics.AIR_REMOVE, RemoveRequest(name="bird"), "'bird' belongs to the mission; only what has been spawned can be removed"),
    (topics.AIR_REMOVE, RemoveRequest(name="gust"), "there is no 'gust' in the air simulation"),
    (topics.AIR_RESTORE, StateRequest(name="never"), "no state 'never' of the air simulation has been saved"),
]


@pytest.mark.parametrize(("request_", "message", "why"), REFUSED)
def test_what_cannot_be_done_is_refused_and_the_flight_goes_on(run, request_, message, why):
    reply = run.ask(request_, message, 0.5)
    assert not reply.accepted
    assert why in reply.reason
    assert "\n" not in reply.reason
    run.lockstep.run(1.0)
    assert run.place()[0] == pytest.approx(-200.0 + 26.0, abs=2.5)


def test_only_so_many_states_are_kept(run):
    for k in range(16):
        assert run.ask(topics.AIR_SAVE, StateRequest(name=f"s{k}"), 0.1 * (k + 1)).accepted
    assert run.ask(topics.AIR_SAVE, StateRequest(name="s3"), 1.7).accepted
    assert run.ask(topics.AIR_SAVE, StateRequest(name="more"), 1.8).reason.startswith("16 states are kept already")


CALM_MISSION = MISSION.replace("wind: {{steady: [1.0, 2.0, 0.0], turbulence: {{severity: light}}}}\n", "")


@pytest.mark.parametrize("mission", (MISSION, CALM_MISSION), ids=("turbulent", "calm"))
def test_another_wind_blows_about_everybody_who_is_there_and_who_comes(tmp_path, mission):
    run = Run(tmp_path, mission=mission)
    assert run.ask(topics.WIND, WindRequest(velocity=Vector3(x=6.0, y=-3.0)), 0.5).accepted
    assert run.ask(topics.AIR_SPAWN, guest(speed=23.0), 1.0).accepted
    run.lockstep.run(3.0)
    for name in ("", "guest"):
        winds = np.array([array(state.wind) for state in run.of(topics.TRUTH, name)[-50:]])
        assert winds.mean(axis=0) == pytest.approx((6.0, -3.0, 0.0), abs=2.0 if mission is MISSION else 0.01)
    motion = run.of(topics.TRUTH)[-1]
    through_air = array(motion.velocity) - array(motion.wind)
    assert motion.airspeed == pytest.approx(np.linalg.norm(through_air), rel=0.05)
    run.lockstep.close()


def test_a_wind_that_nobody_flies_in_is_refused(run):
    reply = run.ask(topics.WIND, WindRequest(velocity=Vector3(y=61.0)), 0.5)
    assert not reply.accepted and "60 m/s at most" in reply.reason
