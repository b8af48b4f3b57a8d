"""Surfaces turn about their hinges the way their joint says, and the propeller turns as fast as can be seen."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from schemas import topics
from schemas.messages import JointState, JointStates
from services.gcs.view.scene.moving_parts import MOST_TURN, SEEN, MovingParts
from tests.services.gcs.fakes import Station
from tests.services.gcs.scripted import UAV
from uvf.models.aircraft.shape import aircraft_shape
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle
from uvf.models.vehicle.surface_joints import deflection
from uvf.runtime.messages.convert import stamp

SHAPE = aircraft_shape(ROOT / "vehicles" / "milvus", load_vehicle(ROOT / "vehicles", "milvus"))
PARTS = {m.name: m for m in SHAPE.movables}
SURFACES = [name for name in PARTS if name != "propeller"]


def told(t=0.0, propeller=0.0, **angles):
    states = [JointState(name=name, position=angle) for name, angle in angles.items()]
    return JointStates(timestamp=stamp(t), joints=[*states, JointState(name="propeller", velocity=propeller)])


def shown(joints, name):
    """(n, 3) m, body: the part's corners once it has turned; by scipy's rotations."""
    place = MovingParts(list(PARTS.values())).places(joints)[name]
    w, x, y, z = place.wxyz
    points = np.vstack([p.vertices for p in PARTS[name].parts])
    return Rotation.from_quat((x, y, z, w)).apply(points) + place.position


def test_every_joint_of_an_aircraft_has_a_part():
    sides = {f"{side}_{what}" for side in ("left", "right") for what in ("flap", "aileron", "rudder", "elevator")}
    assert set(PARTS) == sides | {"propeller"}


@pytest.mark.parametrize("name", SURFACES)
def test_a_positive_angle_moves_the_trailing_edge_down_or_a_rudders_to_the_left(name):
    rest, turned = shown(told(), name), shown(told(**{name: 0.3}), name)
    rear = rest[:, 0] < rest[:, 0].min() + 0.02
    moved = (turned - rest)[rear].mean(axis=0)
    assert (moved[1] if "rudder" in name else -moved[2]) > 0.01


@pytest.mark.parametrize("name", SURFACES)
def test_a_surface_hangs_on_a_hinge_at_its_front_edge(name):
    rest, turned = shown(told(), name), shown(told(**{name: 0.5}), name)
    moved = np.linalg.norm(turned - rest, axis=1)
    front = rest[:, 0] > PARTS[name].origin[0] - 0.03
    assert moved[front].min() < 0.01 < moved[~front].min()
    assert np.allclose(np.linalg.norm(turned - PARTS[name].origin, axis=1), np.linalg.norm(rest - PARTS[name].origin, axis=1))


@pytest.mark.parametrize("name", SURFACES)
def test_at_rest_it_closes_the_wing_or_tail(name):
    body = np.vstack([p.vertices for p in SHAPE.fixed])
    points = shown(told(), name)
    assert points.min(axis=0)[1] >= body.min(axis=0)[1] and points.max(axis=0)[1] <= body.max(axis=0)[1]
    assert points[:, 2].max() <= body[:, 2].max() + 0.02


def test_the_propeller_turns_on_its_shaft_behind_the_body_and_clears_the_booms():
    a, b = (shown(told(), "propeller"), shown(told(), "propeller"))
    assert np.array_equal(a, b)
    assert a[:, 0].max() < -0.44
    assert np.hypot(a[:, 1], a[:, 2] - 0.02).max() < 0.38


def test_the_whole_at_rest_is_the_fixed_and_the_movable_parts():
    moving = sum(len(m.parts) for m in PARTS.values())
    assert len(SHAPE.at_rest) == len(SHAPE.airborne) + len(SHAPE.undercarriage) == len(SHAPE.fixed) + moving + len(SHAPE.undercarriage)


def test_a_model_with_one_joint_for_both_sides_moves_both():
    joints = {j.name: j.position for j in told(rudder=0.1, flap=0.2, aileron=0.3, elevator=-0.1).joints}
    seen = {name: deflection(name, joints) for name in SURFACES}
    assert seen["left_rudder"] == seen["right_rudder"] == 0.1
    assert seen["left_flap"] == seen["right_flap"] == 0.2
    assert (seen["left_aileron"], seen["right_aileron"]) == (0.3, -0.3)
    assert seen["left_elevator"] == seen["right_elevator"] == -0.1


def angle(moving, joints):
    w, x, *_ = moving.places(joints)["propeller"].wxyz
    return 2 * np.arctan2(x, w)


def test_the_propeller_turns_by_simulation_time():
    moving = MovingParts([PARTS["propeller"]])
    assert [angle(moving, told(t, propeller=10.0)) for t in (0.0, 0.05, 0.1)] == pytest.approx([0.0, 0.5, 1.0])
    assert angle(moving, told(0.15)) == pytest.approx(1.0), "it stands"


def test_a_fast_propeller_is_shown_as_fast_as_it_can_be_seen_to_turn_forwards():
    moving = MovingParts([PARTS["propeller"]])
    seen = [angle(moving, told(0.05 * i, propeller=600.0)) for i in range(4)]
    assert seen == pytest.approx([0.0, MOST_TURN, 2 * MOST_TURN, 3 * MOST_TURN])
    assert np.pi / 2 > MOST_TURN, "a blade looks like the other one half a turn on"


def test_nothing_that_cannot_be_seen_to_move_is_placed_anew():
    moving = MovingParts(list(PARTS.values()))
    before = dict(moving.places(told(0.0, left_flap=0.2)))
    after = moving.places(told(0.05, left_flap=0.2 + 0.9 * SEEN))
    assert all(after[name] is before[name] for name in PARTS)
    after = moving.places(told(0.1, left_flap=0.2 + 1.1 * SEEN))
    assert [name for name in PARTS if after[name] is not before[name]] == ["left_flap"]


def test_the_page_is_given_what_the_joints_tell():
    station = Station()
    station.run(0.2)
    station.script.put(UAV, topics.JOINTS, told(station.t, left_aileron=0.3), station.t)
    station.run(0.2)
    places, nodes = station.page.now.places, station.page.now.nodes
    assert places[f"/vehicles/{UAV}/left_aileron"].wxyz[0] == pytest.approx(np.cos(0.15))
    assert places[f"/vehicles/{UAV}/right_aileron"].wxyz[0] == 1.0
    assert {f"/vehicles/{UAV}/{name}/0" for name in PARTS} <= set(nodes)
    before = places
    station.run(0.3)
    assert all(station.page.now.places[f"/vehicles/{UAV}/{name}"] is before[f"/vehicles/{UAV}/{name}"] for name in PARTS)
