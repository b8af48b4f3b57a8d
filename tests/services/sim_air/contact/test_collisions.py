"""What an aircraft hits is noticed once, by name, however fast it goes through; what it passes by is not."""

import numpy as np
import pytest

from schemas import topics
from schemas.messages import Event, NavState, Pose, SimObject, SimObjects
from services.sim_air.build import build
from services.sim_air.contact.collisions import Collisions, Hit
from services.sim_air.contact.surroundings import Around
from services.sim_air.engine.states import AircraftMotion
from services.sim_air.environment.ground import GroundSurface
from tests.services.sim_air.shapes import MILVUS_TREE
from uvf.maths.bvh import build as tree_over
from uvf.maths.rotations import IDENTITY, from_euler
from uvf.maths.solids import box
from uvf.models.scenario import load_scenario
from uvf.models.shapes.scene import scene
from uvf.models.shapes.solid import Solid
from uvf.runtime.messages.convert import quaternion, vector
from uvf.runtime.time.lockstep import Lockstep

WALL = Solid("wall", "box", (0.1, 40.0, 10.0), np.array((50.0, 0.0, 5.0)))
MAST = Solid("mast", "cylinder", (0.15, 30.0), np.array((0.0, 100.0, 15.0)))
SHAPES = {"a": MILVUS_TREE, "b": MILVUS_TREE, "van": tree_over(box((4.0, 2.0, 2.0), (0.0, 0.0, 1.0)))}


def motion(x=0.0, y=0.0, z=8.0, yaw=0.0):
    return AircraftMotion(np.array((x, y, z)), np.zeros(3), from_euler(0.0, 0.0, yaw), np.zeros(3), np.zeros(3), 25.0)


def told(steps, truth=None, objects=None):
    """steps: dicts of the aircraft's motions."""
    around = Around([WALL, MAST], GroundSurface(scene([WALL, MAST])), SHAPES, {}.get)
    collisions, hits = Collisions(around), []
    for i, motions in enumerate(steps):
        around.look(i / 100, truth or {}, objects, motions)
        hits += collisions.step(motions)
    return hits


def straight(step, y=0.0, z=8.0):
    return [{"a": motion(x, y, z)} for x in np.arange(40.0, 60.0, step)]


@pytest.mark.parametrize("step", [0.25, 2.5, 7.0])
def test_a_wall_is_hit_once_even_if_it_lies_between_two_steps(step):
    assert told(straight(step)) == [Hit("a", "wall")]


def test_beside_and_above_the_wall_nothing_is_hit():
    assert told(straight(0.25, y=22.5)) == []
    assert told(straight(0.25, z=11.0)) == []


def test_a_wing_that_takes_a_mast_is_a_hit():
    assert told([{"a": motion(x, 98.8)} for x in np.arange(-5.0, 5.0, 0.25)]) == [Hit("a", "mast")]
    assert told([{"a": motion(x, 98.2)} for x in np.arange(-5.0, 5.0, 0.25)]) == []


def test_two_aircraft_that_meet_are_told_of_as_one_pair():
    steps = [{"a": motion(x, -60.0), "b": motion(-x, -60.5, yaw=np.pi)} for x in np.arange(-5.0, 5.0, 0.25)]
    assert told(steps) == [Hit("a", "b")]
    assert told([{"a": m["a"], "b": motion(-m["a"].position[0], -56.0)} for m in steps]) == []


def test_a_ground_vehicle_is_hit_where_its_truth_says_it_is():
    van = NavState(position=vector(np.array((0.0, -80.0, 0.0))), orientation=quaternion(IDENTITY))
    low, high = ([{"a": motion(x, -80.0, z)} for x in np.arange(-8.0, 8.0, 0.25)] for z in (1.5, 3.0))
    assert told(low, {"van": van}) == [Hit("a", "van")]
    assert told(high, {"van": van}) == []
    assert told(low) == []


def test_what_has_been_put_in_is_hit_too():
    pose = Pose(position=vector(np.array((0.0, -80.0, 8.0))), orientation=quaternion(IDENTITY))
    balloon = SimObjects(objects=[SimObject(name="balloon", shape="sphere", size=[1.0], pose=pose)])
    assert told([{"a": motion(x, -80.0)} for x in np.arange(-8.0, 8.0, 0.25)], objects=balloon) == [Hit("a", "balloon")]


NOTHING = {
    "a mesh without a file": SimObject(name="x", shape="mesh", size=[1.0, 1.0, 1.0]),
    "no shape": SimObject(name="x"),
    "too few measures": SimObject(name="x", shape="box", size=[1.0]),
    "a size without end": SimObject(name="x", shape="sphere", size=[1e9]),
    "a size below nothing": SimObject(name="x", shape="sphere", size=[-1.0]),
    "a place without end": SimObject(name="x", shape="sphere", size=[1.0], pose=Pose(position=vector(np.array((1e9, 0.0, 0.0))))),
    "a model that nobody has": SimObject(name="x", model="nothing"),
    "a path for a name": SimObject(name="../x", shape="sphere", size=[1.0]),
}


@pytest.mark.parametrize("thing", NOTHING.values(), ids=NOTHING)
def test_what_nothing_can_be_is_left_out_and_hides_no_other(thing):
    pose = Pose(position=vector(np.array((0.0, -80.0, 8.0))), orientation=quaternion(IDENTITY))
    sound = SimObject(name="balloon", shape="sphere", size=[1.0], pose=pose)
    steps = [{"a": motion(x, -80.0)} for x in np.arange(-8.0, 8.0, 0.25)]
    assert told(steps, objects=SimObjects(objects=[thing, sound])) == [Hit("a", "balloon")]


def test_a_flight_into_a_wall_ends_there_and_says_what_was_hit(tmp_path):
    path = tmp_path / "low.yaml"
    path.write_text(
        "about: Too low.\nworld: house\nvehicles:\n"
        "  milvus: {model: milvus, system_id: 1, start: {x: -40.0, y: 4.0, z: 2.0, speed: 25.0}}\n"
    )
    lockstep, events, truth = Lockstep(build(load_scenario(path))), [], []
    lockstep.bus.subscribe(
        topics.EVENTS.by("sim_air").at("milvus"), topics.EVENTS.qos, lambda s: events.append(Event.FromString(s.payload))
    )
    lockstep.bus.subscribe(topics.TRUTH.at("milvus"), topics.TRUTH.qos, lambda s: truth.append(NavState.FromString(s.payload)))
    lockstep.run(4.0)
    lockstep.close()
    (event,) = events
    assert "milvus hit wall" in event.cause
    assert truth[-1].position.x == pytest.approx(0.0, abs=1.5)
    assert truth[-1].velocity.x == 0.0
