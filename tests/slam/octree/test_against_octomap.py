"""The same scans into OctoMap and into this: the same log-odds in every cell, the same files to the byte."""

import numpy as np
import pytest

from tests.slam.octree.scenes import picture_scan, room_scan, unit_rays
from uvf.slam.octree.files import read_octree, to_bt, to_ot
from uvf.slam.octree.leaves import bounds, leaves_of
from uvf.slam.octree.octree import Octree

octomap = pytest.importorskip("octomap", reason="octomap-python is not installed")

CASES = {
    "sweeps to all sides": (room_scan, 0.1, -1.0),
    "depth pictures": (picture_scan, 0.05, -1.0),
    "depth pictures with a short reach": (picture_scan, 0.1, 1.5),
    "an odd resolution": (picture_scan, 0.0731, 2.0),
}


@pytest.fixture(scope="module", params=CASES)
def both(request):
    make, resolution, reach = CASES[request.param]
    rng = np.random.default_rng(7)
    ours, theirs = Octree(resolution), octomap.OcTree(resolution)
    for _ in range(8):
        origin, points = make(rng)
        ours.insert(origin, points, np.inf if reach < 0 else reach)
        theirs.insertPointCloud(points, origin, reach)
    return ours, theirs


def test_the_log_odds_of_every_cell_are_equal(both):
    ours, theirs = both
    assert to_ot(leaves_of(ours), ours.resolution) == theirs.write()


def test_the_binary_files_are_equal(both):
    ours, theirs = both
    copy = octomap.OcTree.read(theirs.write())  # writing a .bt changes the tree
    assert copy.size() > 1000
    assert to_bt(leaves_of(ours), ours.resolution) == copy.writeBinary()


def test_octomap_reads_our_files_and_we_read_its(both, tmp_path):
    ours, theirs = both
    path = tmp_path / "map.bt"
    path.write_bytes(to_bt(leaves_of(ours), ours.resolution))
    read = octomap.OcTree(0.5)
    assert read.readBinary(str(path))
    assert read.getResolution() == pytest.approx(ours.resolution)
    assert read.writeBinary() == path.read_bytes()
    assert to_ot(leaves_of(read_octree(theirs.write(), "theirs")), ours.resolution) == theirs.write()


def test_bounds_are_equal(both):
    ours, theirs = both
    low, high = bounds(leaves_of(ours), ours.resolution)
    assert low == pytest.approx(theirs.getMetricMin()) and high == pytest.approx(theirs.getMetricMax())


@pytest.mark.parametrize("through_unknown", [False, True])
def test_rays_meet_the_same_cells(both, through_unknown):
    ours, theirs = both
    rng = np.random.default_rng(8)
    origins, rays = rng.uniform((-2, -1, 0.5), (2, 1, 2), (300, 3)), unit_rays(rng, 300)
    met = ours.cast(origins, rays, reach=6.0, through_unknown=through_unknown)
    for origin, ray, found in zip(origins, rays, met, strict=True):
        end = np.zeros(3)
        hit = theirs.castRay(origin, ray, end, ignoreUnknownCells=through_unknown, maxRange=6.0)
        assert hit == (not np.isnan(found[0]))
        if hit:
            assert found == pytest.approx(end, abs=1e-6)
