"""What ``uvf vehicle tune --write`` puts into the files flies: two aircraft, one mission, no figure by hand. Side slip goes to nothing."""

import shutil
from contextlib import closing

import numpy as np
import pytest
import yaml

from benchmarks.autopilot import cost_and_slip as bench
from benchmarks.autopilot.accuracy.flight import PLANE, Probe
from launch.vehicles.tuning import tune, write
from uvf.models.scenario import ROOT, load_scenario

pytestmark = pytest.mark.timeout(300)  # tune flies many steady flights

CORNERS = [(350.0, 0.0, 100.0), (350.0, 300.0, 115.0), (0.0, 300.0, 115.0)]
MISSION = [{"x": x, "y": y, "z": z} for x, y, z in CORNERS]
WIND = {"steady": [0.0, 4.0, 0.0]}


def tuned_by_files_alone(model, root):
    """A tree with the aircraft of the repository, of whose autopilot nothing is known but what tune finds out."""
    shutil.copytree(ROOT / "worlds" / "empty", root / "worlds" / "empty")
    folder = shutil.copytree(ROOT / "vehicles" / model, root / "vehicles" / model)
    path = folder / "vehicle.yaml"
    data = yaml.safe_load(path.read_text())
    del data["params"]["autopilot_air"]
    path.write_text(yaml.safe_dump(data))
    write(tune(folder))
    return folder


def mission_of(model, speed, folder):
    start = {"x": 0.0, "y": 0.0, "z": 100.0, "yaw": 0.0, "speed": speed}
    vehicle = {"model": model, "system_id": 1, "start": start, "job": {"mission": MISSION}}
    path = folder / "mission.yaml"
    path.write_text(yaml.safe_dump({"about": "m", "world": "empty", "seed": 3, "wind": WIND, "vehicles": {PLANE: vehicle}}))
    return path


@pytest.fixture(scope="module", params=["milvus", "stick25"])
def flown(request, tmp_path_factory):
    root = tmp_path_factory.mktemp(request.param)
    speed = tune_speed(tuned_by_files_alone(request.param, root))
    lockstep = bench.lockstep_of(load_scenario(mission_of(request.param, speed, root), root))
    with closing(lockstep):
        probe = Probe(lockstep)
        lockstep.run(120.0, probe)
        assert probe.autopilot._mode_manager.navigator.finished
    return probe.flight(), speed


def tune_speed(folder):
    return yaml.safe_load((folder / "vehicle.yaml").read_text())["air"]["trim_speed"]


def test_it_keeps_to_its_path(flown):
    flight, _ = flown
    settled = flight.t > 5.0
    off = np.abs(flight.off_path[settled, 0])
    assert np.sqrt(np.mean(off**2)) < 1.2 and off.max() < 4.0


def test_it_keeps_its_airspeed_and_arrives_at_the_height(flown):
    flight, speed = flown
    assert abs(flight.airspeed[flight.t > 5.0, 0] - speed).max() < 0.12 * speed
    assert flight.truth[-1, 2] == pytest.approx(CORNERS[-1][2], abs=2.5)


def test_the_side_slip_of_crooked_rudders_goes_to_nothing():
    assert abs(bench.slip(bench.STRAIGHT, bench.RIGGED, False)) > 3.0
    assert abs(bench.slip(bench.STRAIGHT, bench.RIGGED, True)) < 0.5
