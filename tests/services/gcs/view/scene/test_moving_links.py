"""On the page a lift rises, a head turns and front wheels are steered, each about its own joint."""

import dataclasses

import numpy as np
import pytest

from schemas.messages import JointState, JointStates
from services.gcs.view.scene import bodies
from services.gcs.view.scene.moving_links import SEEN, MovingLinks
from tests.services.mast import LIFT, PAN, mast_folder
from uvf.maths.rotations import rotate
from uvf.maths.se3 import Transform, apply
from uvf.models.scenario import ROOT
from uvf.models.urdf.model import load_urdf


def told(**positions):
    return JointStates(joints=[JointState(name=name, position=position) for name, position in positions.items()])


@pytest.fixture
def model(tmp_path):
    return load_urdf(mast_folder(tmp_path) / "mast.urdf")


def test_a_head_turns_on_a_lift_that_has_risen(model):
    places = MovingLinks(model, [LIFT, PAN]).places(told(**{LIFT: 0.2, PAN: np.pi / 2}))
    assert places["lift"].position == pytest.approx((-0.03, 0.0, 0.4))
    assert places["head"].position == pytest.approx((-0.03, 0.0, 0.45))
    assert rotate(places["head"].wxyz, np.array((1.0, 0.0, 0.0))) == pytest.approx((0.0, 1.0, 0.0), abs=1e-9)


def test_the_parts_at_rest_are_those_of_the_whole_vehicle(model):
    moving = MovingLinks(model, [LIFT, PAN]).places(None)
    whole = bodies.rover_parts(model, ())[bodies.FAST].plain
    parts = bodies.rover_parts(model, moving)
    shown = [*parts[bodies.FAST].plain]
    for name, place in moving.items():
        assert len(parts[name].plain) == 1
        shown += [
            dataclasses.replace(part, vertices=apply(Transform(place.wxyz, place.position), part.vertices)) for part in parts[name].plain
        ]
    corners = lambda drawn: np.sort(np.round(np.vstack([part.vertices for part in drawn]), 6), axis=0)  # noqa: E731
    assert np.array_equal(corners(whole), corners(shown))


def test_nothing_is_drawn_anew_for_what_cannot_be_seen(model):
    links = MovingLinks(model, [LIFT, PAN])
    first = links.places(told(**{LIFT: 0.1}))
    assert links.places(told(**{LIFT: 0.1 + SEEN / 2})) is first
    assert links.places(told(**{LIFT: 0.1 + 2 * SEEN})) is not first


def test_numbers_that_are_none_and_joints_of_others_change_nothing(model):
    links = MovingLinks(model, [LIFT, PAN])
    first = links.places(told(**{LIFT: 0.1}))
    assert links.places(told(**{LIFT: float("nan"), "left_aileron": 0.4})) is first


def test_the_front_wheels_of_a_car_turn_with_its_steering():
    model = load_urdf(ROOT / "vehicles" / "minicar" / "minicar.urdf.xacro")
    links = MovingLinks(model, ["steering_left_joint", "steering_right_joint"])
    parts = bodies.rover_parts(model, links.places(None))
    places = links.places(told(steering_left_joint=0.3, steering_right_joint=0.3))
    assert all(parts[name].plain for name in places)
    turned = [rotate(place.wxyz, np.array((1.0, 0.0, 0.0))) for place in places.values()]
    assert np.array(turned) == pytest.approx(np.array([(np.cos(0.3), np.sin(0.3), 0.0)] * 2), abs=1e-9)
