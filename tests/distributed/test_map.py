"""Maps of a running system: saved, served and compared with the world they are of."""

import os
import signal
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest

from schemas import topics
from schemas.messages import MapRequest, SaveMapRequest
from tests.distributed.system import System
from uvf.maths.se2 import Pose2
from uvf.models.scenario import ROOT
from uvf.models.world.map_file import GridMap, save_map
from uvf.runtime.messages.convert import occupancy_cells
from uvf.runtime.state.saved_maps import find_map

MISSION = """
about: One burger that drives about with a keep-out mask.
world: house
vehicles:
  burger:
    model: burger
    system_id: 2
    start: {x: 2.2, y: 1.3, yaw: 0.5}
    job: {explore: true}
    maps: {keepout: keepout.yaml}
"""
KEPT_OUT = np.zeros((4, 6), dtype=np.int8)
KEPT_OUT[1, 2:4] = 100


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("map")
    (folder / "m.yaml").write_text(MISSION)
    save_map(GridMap(KEPT_OUT, 0.1, Pose2(1.0, 2.0, 0.0)), folder / "keepout.yaml")
    with System(folder, mission=str(folder / "m.yaml")) as system:
        system.client.read("burger", topics.MAP, 30.0)
        yield SimpleNamespace(system=system, folder=folder, client=system.client)


def uvf(run, *arguments):
    command = [sys.executable, "-m", "launch.cli", "map", *arguments]
    environment = {**run.system.environment, "PYTHONPATH": f"{ROOT}:{ROOT / 'src'}"}
    return subprocess.run(command, cwd=run.folder, env=environment, capture_output=True, text=True, check=False)


def free_cells(run):
    cells = occupancy_cells(run.client.read("burger", topics.MAP))
    return int(((cells >= 0) & (cells < 20)).sum())


def test_the_mask_is_served_latched(run):
    keepout = run.client.read("burger", topics.KEEP_OUT)
    assert np.array_equal(occupancy_cells(keepout).reshape(4, 6), KEPT_OUT)
    assert (keepout.frame_id, keepout.pose.position.y) == ("world", 2.0)


def test_a_map_is_saved_where_it_lies_in_the_world_and_fits_its_floor_plan(run):
    run.client.wait(lambda: free_cells(run) > 2000, 60.0, "no floor in the map that has been looked at often enough to be free")
    saved = uvf(run, "save", "first.yaml")
    assert saved.returncode == 0, saved.stderr
    assert find_map("first.yaml", run.folder).origin.yaw == pytest.approx(0.5)
    found = uvf(run, "compare", "first.yaml", "--world", "house", "--out", "differences.png")
    assert found.returncode == 0, found.stderr
    assert float(found.stdout.partition("precision ")[2].partition(",")[0]) > 0.8
    assert (run.folder / "differences.png").stat().st_size > 1000


def test_a_program_asks_for_the_map_and_has_it_saved(run):
    reply = run.client.ask("burger", topics.GET_MAP, MapRequest())
    assert reply.accepted and reply.grid.frame_id == "burger/map"
    assert run.client.ask("burger", topics.SAVE_MAP, SaveMapRequest(name="by_request", mode="raw")).accepted
    assert (run.folder / "state" / "maps" / "by_request.yaml").is_file()


def test_a_saved_map_is_served_for_as_long_as_wished(run):
    save_map(GridMap(KEPT_OUT, 0.1, Pose2(1.0, 2.0, 0.3)), run.folder / "known.png", "scale")
    command = [sys.executable, "-m", "launch.cli", "map", "load", str(run.folder / "known.png"), "--vehicle", "burger"]
    server = subprocess.Popen(command, env={**os.environ, **run.system.environment}, stdout=subprocess.PIPE, text=True)
    try:
        known = run.client.read("burger", topics.KNOWN_MAP, 30.0)
    finally:
        server.send_signal(signal.SIGINT)
        said, _ = server.communicate(timeout=20)
    assert np.array_equal(occupancy_cells(known), KEPT_OUT)
    assert "6 x 4 cells of 0.1 m" in said and server.returncode == 0


def test_a_vehicle_without_a_map_is_told(run):
    refused = uvf(run, "save", "x.yaml", "--vehicle", "burgr")
    assert (refused.returncode, refused.stderr) == (2, "uvf: no map of 'burgr'; did you mean 'burger'?\n")
