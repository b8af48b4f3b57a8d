"""Every aircraft has a shape: from its looks, its JSBSim model or what is usual; sound as a mesh and as large as the model says."""

import re
import shutil
from dataclasses import replace
from pathlib import Path

import jsbsim
import msgspec
import numpy as np
import pytest
import trimesh

from uvf.models.aircraft.dimensions import planned
from uvf.models.aircraft.shape import aircraft_shape
from uvf.models.jsbsim.sizes import sizes_of
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import VehicleFile, load_vehicle
from uvf.models.vehicle.looks import Looks, Tail, Wing
from uvf.models.vehicle.sensors import Sensors
from uvf.models.yaml_data import BadInput

NAMES = sorted(path.parent.name for path in (ROOT / "vehicles").glob("*/vehicle.yaml"))
OWN = [name for name in NAMES if load_vehicle(ROOT / "vehicles", name).kind == "fixed_wing"]
SHIPPED = Path(jsbsim.get_default_root_dir()) / "aircraft"


def own(name):
    return aircraft_shape(ROOT / "vehicles" / name, load_vehicle(ROOT / "vehicles", name))


def shipped(name, folder, mend=lambda text: text):
    """One of JSBSim's own aircraft in a folder without looks."""
    (folder / name).mkdir()
    (folder / name / f"{name}.xml").write_text(mend((SHIPPED / name / f"{name}.xml").read_text(errors="replace")))
    shutil.copytree(SHIPPED.parent / "engine", folder / "engine")
    (folder / "vehicle.yaml").write_text(f"kind: fixed_wing\nabout: it\nair: {{model: {name}, {AIR}}}\nsensors: {{}}\n")
    return load_vehicle(folder.parent, folder.name)


AIR = "physics_hz: 120, trim_speed: 50, servo_rate: 2, servo_lag: 0.05"


@pytest.mark.parametrize("name", OWN)
def test_every_part_of_our_aircraft_is_closed_and_wound_outwards(name):
    for part in own(name).at_rest:
        body = trimesh.Trimesh(part.vertices, part.faces, process=True)
        assert body.is_watertight and body.volume > 0


@pytest.mark.parametrize("name", OWN)
def test_an_aircraft_is_alike_on_both_sides(name):
    low, high = own(name).bounds
    assert low[1] == pytest.approx(-high[1], abs=0.01)


def test_milvus_is_as_wide_as_its_model_and_stick25_does_not_look_like_it():
    spans = {name: np.ptp(own(name).bounds, axis=0)[1] for name in ("milvus", "stick25")}
    assert spans == {"milvus": pytest.approx(2.8956, abs=0.02), "stick25": pytest.approx(1.27, abs=0.02)}
    assert {m.name for m in own("stick25").movables} >= {"rudder", "left_aileron", "right_elevator", "propeller"}


def test_an_airship_is_its_gas_cell_with_a_cross_of_fins():
    shape = own("nas10")
    low, high = shape.bounds
    assert high[0] - low[0] == pytest.approx(10.0, rel=0.02)
    assert {m.name for m in shape.movables if not m.spins} == {"left_elevator", "right_elevator", "upper_rudder", "lower_rudder"}
    assert {m.name for m in shape.movables if m.spins} == {"left_propeller", "right_propeller"}
    hull = shape.fixed[0].vertices
    assert hull.mean(axis=0)[2] == pytest.approx(0.93, abs=0.01)  # above the centre of gravity


def test_the_survey_aircraft_carries_its_gimbal_and_lidar():
    assert len(own("milvus_survey").fixed) == len(own("milvus").fixed) + 2


@pytest.mark.parametrize(("name", "span"), [("c172p", 35.8), ("f16", 30.0), ("B747", 211.5), ("minisgs", 8.0), ("C130", 132.5)])
def test_an_aircraft_that_nobody_has_seen_has_its_span_its_engines_and_its_surfaces(tmp_path, name, span):
    file = shipped(name, tmp_path)
    shape = aircraft_shape(tmp_path, file)
    low, high = shape.bounds
    assert high[1] - low[1] == pytest.approx(span * 0.3048, rel=0.02)
    assert 0.3 < (high[0] - low[0]) / (high[1] - low[1]) < 2.0
    assert low[0] < 0 < high[0]
    assert {"left_aileron", "right_aileron", "left_elevator", "right_elevator", "rudder"} <= {m.name for m in shape.movables}
    engines = sizes_of(tmp_path / name / f"{name}.xml").thrusters
    assert sum(m.spins for m in shape.movables) == sum(e.radius > 0 for e in engines)
    assert all(np.isfinite(part.vertices).all() for part in shape.at_rest)


@pytest.mark.parametrize("name", ["ZLT-NT", "Submarine_Scout", "Camel", "fokker100", "Concorde", "paraglider", "ah1s"])
def test_odd_models_have_some_shape_too(tmp_path, name):
    shape = aircraft_shape(tmp_path, shipped(name, tmp_path))
    assert all(np.isfinite(part.vertices).all() for part in shape.at_rest)
    assert 1.0 < np.ptp(shape.bounds, axis=0).max() < 200.0


def test_a_model_that_tells_no_sizes_has_a_shape(tmp_path):
    file = shipped(
        "c172p", tmp_path, lambda text: re.sub(r"<(metrics|ground_reactions|propulsion|mass_balance).*?</\1>", "", text, flags=re.S)
    )
    assert np.ptp(aircraft_shape(tmp_path, file).bounds, axis=0)[1] == pytest.approx(2.0, abs=0.01)


def test_a_model_that_is_no_xml_is_refused_in_one_line(tmp_path):
    with pytest.raises(BadInput, match=r"c172p.xml: cannot be read: .*'uvf vehicle check'"):
        aircraft_shape(tmp_path, shipped("c172p", tmp_path, lambda text: text[:400]))


def test_what_is_given_holds_and_the_rest_follows_from_it():
    sizes = sizes_of(ROOT / "vehicles/stick25/stick25/stick25.xml")
    plain, wide = planned(Looks(), sizes), planned(Looks(wing=Wing(span=2.54), tail=Tail(kind="t")), sizes)
    assert (plain.wing.span, wide.wing.span) == (1.27, 2.54)
    assert (plain.tail.kind, wide.tail.kind) == ("conventional", "t")
    mean = [(p.wing.root + p.wing.tip) / 2 for p in (plain, wide)]
    assert mean == pytest.approx([0.3097 / 1.27, 0.3097 / 2.54])


def test_a_propeller_behind_the_middle_means_booms():
    sizes = sizes_of(ROOT / "vehicles/milvus/milvus/milvus.xml")
    assert planned(Looks(), sizes).tail.kind == "twin_boom"
    jets = tuple(replace(t, radius=0.0) for t in sizes.thrusters)
    assert planned(Looks(), replace(sizes, thrusters=jets)).tail.kind == "conventional"


@pytest.mark.parametrize("kind", ["conventional", "t", "v", "twin_boom", "inverted_v", "none"])
def test_every_kind_of_tail_has_its_surfaces(kind):
    file = load_vehicle(ROOT / "vehicles", "stick25")
    looks = Looks(tail=Tail(kind=kind))
    shape = aircraft_shape(ROOT / "vehicles" / "stick25", msgspec.structs.replace(file, air=msgspec.structs.replace(file.air, looks=looks)))
    names = {m.name for m in shape.movables}
    assert ("left_elevator" in names) == (kind != "none")
    assert ("rudder" in names) == (kind in ("conventional", "t"))
    assert ("left_rudder" in names) == (kind in ("v", "twin_boom", "inverted_v"))


def test_a_mesh_is_the_whole_look(tmp_path):
    trimesh.creation.box((1.0, 2.0, 0.5)).export(tmp_path / "it.stl")
    air = msgspec.structs.replace(load_vehicle(ROOT / "vehicles", "milvus").air, mesh="it.stl")
    shape = aircraft_shape(tmp_path, VehicleFile("fixed_wing", "it", Sensors(), air=air))
    assert np.ptp(shape.bounds, axis=0) == pytest.approx((1.0, 2.0, 0.5))
    assert shape.movables == []


def test_twice_as_large_everything_is():
    shape = own("milvus")
    assert shape.scaled(2.0).bounds == pytest.approx(2.0 * shape.bounds)
