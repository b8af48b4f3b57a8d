"""What is put into the running simulation is drawn where it truly is, once, and goes when it is taken out."""

import pytest

from schemas.messages import NavState, Pose, Quaternion, SimObject, SimObjects, Vector3
from services.gcs.state.state import Model
from services.gcs.view.scene import spawned
from services.gcs.view.scene.scene_view import SceneView
from tests.services.gcs.scripted import UGV, demo_site
from uvf.models.shapes.mesh import triangles
from uvf.models.vehicle.file import load_vehicle
from uvf.runtime.messages.spawned import GREY, solid_of


def crate(x, name="crate"):
    return SimObject(name=name, shape="box", size=[0.4, 0.4, 0.6], pose=Pose(position=Vector3(x=x, z=0.3), orientation=Quaternion(w=1)))


def scout():
    return SimObject(name="scout", model="my2bot", pose=Pose(position=Vector3(x=2), orientation=Quaternion(w=1)))


@pytest.fixture
def model():
    return Model(demo_site())


def hear(model, *things, **truth):
    model.hear_objects(
        (SimObjects(objects=things), None),
        {name: NavState(position=Vector3(x=x), orientation=Quaternion(w=1)) for name, x in truth.items()},
    )


def test_a_crate_is_drawn_once_and_moves_with_what_is_told(model):
    view = SceneView(model)
    hear(model, crate(1.0))
    first = view.nodes(0.0)["/spawned/crate/0"]
    assert first.vertices.max(axis=0) == pytest.approx((0.2, 0.2, 0.3))
    hear(model, crate(2.5))
    assert view.nodes(0.1)["/spawned/crate/0"] is first
    assert view.places()["/spawned/crate"].position == pytest.approx((2.5, 0.0, 0.3))


def test_another_thing_of_that_name_is_drawn_anew(model):
    view = SceneView(model)
    hear(model, crate(1.0))
    first = view.nodes(0.0)["/spawned/crate/0"]
    hear(model, SimObject(name="crate", shape="sphere", size=[0.2], pose=crate(1.0).pose))
    assert view.nodes(0.1)["/spawned/crate/0"] is not first


def test_many_things_of_one_look_are_made_once(model, monkeypatch):
    """A model is loaded in tens of milliseconds: 256 of it would hold up the page for seconds."""
    loaded = []
    monkeypatch.setattr(spawned, "load_vehicle", lambda folder, name: loaded.append(name) or load_vehicle(folder, name))
    view = SceneView(model)
    hear(model, *(SimObject(name=f"scout{i}", model="my2bot", pose=scout().pose) for i in range(20)), crate(1.0), crate(2.0, "other"))
    first = view.nodes(0.0)
    names = {name.split("/")[2] for name in first if name.startswith("/spawned/scout")}
    assert loaded == ["my2bot"] and names == {f"scout{i}" for i in range(20)}
    assert first["/spawned/crate/0"] is first["/spawned/other/0"]
    hear(model, SimObject(name="scout7", model="my2bot", pose=scout().pose))
    assert view.nodes(0.1)["/spawned/scout7/0"] is first["/spawned/scout7/0"] and loaded == ["my2bot"]


def test_what_is_taken_out_is_gone(model):
    view = SceneView(model)
    hear(model, crate(1.0))
    view.nodes(0.0)
    hear(model)
    assert not [name for name in {**view.nodes(0.1), **view.places()} if name.startswith("/spawned")]


def test_a_vehicle_is_where_its_truth_says(model):
    view = SceneView(model)
    hear(model, scout())
    assert view.places()["/spawned/scout"].position[0] == 2.0
    hear(model, scout(), scout=3.5, **{UGV: 1.0})
    assert view.places()["/spawned/scout"].position[0] == 3.5
    assert any(name.startswith("/spawned/scout/") for name in view.nodes(0.0))
    assert f"/spawned/{UGV}" not in view.places()


def test_a_model_this_host_does_not_have_is_told_of_and_nothing_breaks(model):
    view = SceneView(model)
    hear(model, SimObject(name="alien", model="saucer", pose=crate(0.0).pose), crate(1.0))
    nodes = view.nodes(0.0)
    assert "/spawned/crate/0" in nodes
    view.nodes(0.1)
    assert len([line for line in model.log if "alien" in line.text]) == 1


def test_a_solid_without_a_colour_is_grey_and_its_attitude_of_length_one():
    solid = solid_of(SimObject(name="c", shape="box", size=[1, 1, 1], pose=Pose(orientation=Quaternion(w=2.0))))
    assert solid.colour == GREY
    assert solid.orientation == pytest.approx((1, 0, 0, 0))
    assert abs(triangles(solid)[0]).max() == pytest.approx(0.5)


def test_an_aircraft_put_into_the_air_is_drawn_where_it_flies(model):
    view = SceneView(model)
    kite = SimObject(name="kite", model="stick25", pose=Pose(position=Vector3(x=2, z=50), orientation=Quaternion(w=1)))
    truth = {"kite": NavState(position=Vector3(x=30, z=55), orientation=Quaternion(w=1))}
    model.hear_objects((SimObjects(objects=[crate(1.0)]), SimObjects(objects=[kite])), truth)
    drawn = view.nodes(0.0)
    assert "/spawned/crate/0" in drawn
    assert any(name.startswith("/spawned/kite/") for name in drawn)
    assert view.places()["/spawned/kite"].position == pytest.approx((30.0, 0.0, 55.0))
