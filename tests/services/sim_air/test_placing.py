"""An aircraft is put elsewhere by request: into steady flight or onto its wheels, also after a crash; what cannot be is refused."""

import math

import numpy as np
import pytest

from schemas import topics
from schemas.messages import Event, NavState, SetPoseRequest, SurfaceCommand
from services.sim_air.build import build
from uvf.maths import rotations
from uvf.models.scenario import load_scenario
from uvf.runtime.messages.convert import array, planar_pose, wxyz
from uvf.runtime.time.lockstep import Lockstep

MISSION = """
about: One.
world: house
wind: {steady: [0.0, 0.0, 0.0]}
vehicles:
  bird: {model: milvus, system_id: 1, start: {x: -200.0, y: 0.0, z: 60.0, speed: 25.0}}
"""


class Run:
    """Milvus, asked between two moments."""

    def __init__(self, folder):
        path = folder / "one.yaml"
        path.write_text(MISSION)
        self.lockstep, self.truth, self.events = Lockstep(build(load_scenario(path))), [], []
        bus, said = self.lockstep.bus, topics.EVENTS.by("sim_air")
        bus.subscribe(topics.TRUTH.at("bird"), topics.TRUTH.qos, lambda s: self.truth.append(NavState.FromString(s.payload)))
        bus.subscribe(said.at("bird"), said.qos, lambda s: self.events.append(Event.FromString(s.payload)))

    def ask(self, until, name="bird", **wanted):
        got, request = [], topics.AIR_POSE
        message = SetPoseRequest(name=name, **wanted).SerializeToString()
        self.lockstep.bus.call(request.at("sys"), message, round((until - 0.05) * 1e9), lambda reply, reason, _: got.append(reply))
        self.lockstep.run(until)
        return request.reply.FromString(got[0])

    @property
    def now(self):
        return self.truth[-1]


@pytest.fixture
def run(tmp_path):
    made = Run(tmp_path)
    yield made
    made.lockstep.close()


def test_it_flies_on_from_the_place_and_at_the_speed_that_were_asked_for(run):
    assert run.ask(1.0, pose=planar_pose(300.0, 200.0, math.pi / 2, 90.0), speed=22.0).accepted
    run.lockstep.run(6.0)
    assert array(run.now.position) == pytest.approx((300.0, 200.0 + 22.0 * 5.05, 90.0), abs=1.0)
    assert array(run.now.velocity) == pytest.approx((0.0, 22.0, 0.0), abs=0.1)


def test_it_turns_when_it_is_asked_to(run):
    assert run.ask(1.0, pose=planar_pose(300.0, 200.0, 0.0, 90.0), turn_rate=0.2).accepted
    assert rotations.to_euler(wxyz(run.now.orientation))[0] == pytest.approx(-math.atan(25 * 0.2 / 9.81), abs=0.03)


def test_on_the_ground_it_stands(run):
    assert run.ask(1.0, pose=planar_pose(-150.0, 40.0, 1.0, 0.0)).accepted
    run.lockstep.run(4.0)
    assert array(run.now.position)[:2] == pytest.approx((-150.0, 40.0), abs=0.02)
    assert np.linalg.norm(array(run.now.velocity)) < 0.01
    assert run.events == []


def test_after_a_crash_it_flies_again(run):
    key = topics.SURFACE_COMMAND
    surfaces = run.lockstep.bus.publisher(key.at("bird"), SurfaceCommand.DESCRIPTOR.full_name, key.qos)
    for k in range(60):
        surfaces.put(SurfaceCommand(elevator=0.3, throttle=0.5).SerializeToString(), k * 100_000_000)
        run.lockstep.run((k + 1) / 10)
    assert len(run.events) == 1
    assert np.linalg.norm(array(run.now.velocity)) == 0.0
    assert run.ask(7.0, pose=planar_pose(0.0, 100.0, 0.0, 60.0)).accepted
    run.lockstep.run(9.0)
    assert np.linalg.norm(array(run.now.velocity)) == pytest.approx(25.0, abs=0.2)


@pytest.mark.parametrize(
    ("wanted", "why"),
    [
        ({"name": "bard"}, "there is no aircraft 'bard'; did you mean 'bird'?"),
        ({"pose": planar_pose(1e6, 0.0, 0.0, 60.0)}, "within 100000 m of the world's origin"),
        ({"pose": planar_pose(0.0, 0.0, 0.0, -5.0)}, "under the ground"),
        ({"pose": planar_pose(0.0, 0.0, 0.0, 60.0), "speed": 60.0}, "no level flight at 60"),
        ({"pose": planar_pose(0.0, 0.0, 0.0, 60.0), "climb": 2.0}, "climb within 1.5 rad"),
        ({"pose": planar_pose(0.0, 0.0, 0.0, 1.6)}, "from a wall or another solid at 1.6 m"),
    ],
)
def test_what_cannot_be_is_refused_and_the_flight_goes_on(run, wanted, why):
    reply = run.ask(1.0, **{"pose": planar_pose(0.0, 0.0, 0.0, 60.0), **wanted})
    assert not reply.accepted
    assert why in reply.reason
    assert array(run.now.position) == pytest.approx((-200.0 + 25.0, 0.0, 60.0), abs=0.6)
