"""Keep-out and speed masks, laid over maps whose cells lie otherwise."""

import numpy as np
import pytest

from launch.commands.testing import data_folder
from uvf.maths.se2 import IDENTITY, Pose2, transform
from uvf.models.world.map_file import GridMap, load_map
from uvf.slam.maps.masks import KeepOut, SpeedLimit

DATA = data_folder()


def mask(values, resolution=0.1, origin=IDENTITY):
    return GridMap(np.array(values, dtype=np.int8), resolution, origin)


def test_only_what_is_lethal_keeps_out():
    assert KeepOut(mask([[100, 99, 0, -1]])).layer().cells.tolist() == [[100, 0, 0, 0]]


def test_a_mask_over_the_same_cells_is_itself():
    cells = np.where(np.random.default_rng(0).random((9, 7)) < 0.3, 100, 0)
    grid = mask(np.zeros((9, 7)), origin=Pose2(1.0, -2.0, 0.3))
    assert np.array_equal(KeepOut(mask(cells, origin=grid.origin)).onto(grid), cells == 100)


def test_a_thin_line_is_not_lost_between_coarse_or_turned_cells():
    line = np.zeros((40, 40))
    line[20] = 100
    thin = KeepOut(mask(line, 0.02, Pose2(0.1, 0.1, 0.0)))
    coarse = thin.onto(mask(np.zeros((5, 5)), 0.2))
    assert coarse[2, 1:4].all() and not coarse[[0, 1, 3, 4]].any()
    turned = mask(np.zeros((60, 60)), 0.05, Pose2(-0.5, -1.0, 0.7))
    points = transform(Pose2(0.1, 0.1, 0.0), np.column_stack((np.linspace(0.01, 0.79, 200), np.full(200, 0.41))))
    local = transform(Pose2(0.0, 0.0, -0.7), points - (-0.5, -1.0)) / 0.05
    rows, columns = np.floor(local[:, 1]).astype(int), np.floor(local[:, 0]).astype(int)
    assert thin.onto(turned)[rows, columns].mean() > 0.9


def test_a_finer_map_is_kept_out_of_the_whole_coarse_cell():
    kept = KeepOut(mask([[0, 100]], 0.2)).onto(mask(np.zeros((4, 8)), 0.05))
    assert kept[:, 4:].all() and not kept[:, :4].any()


def test_speed_is_a_share_as_nav2_counts():
    limit = SpeedLimit(mask([[0, 20, 75, 100, -1]]))
    assert limit.shares(1.5).tolist() == [[1.0, 0.8, 0.25, 0.0, 1.0]]
    assert limit.layer(1.5).cells.tolist() == [[100, 80, 25, 0, 100]]


def test_speed_in_metres_per_second_is_a_share_of_the_vehicles_own():
    limit = SpeedLimit(mask([[0, 10, 50, 100]]), "m/s", base=0.0, multiplier=0.01)
    assert limit.shares(0.25) == pytest.approx(np.array([[1.0, 0.4, 1.0, 1.0]]))


def test_limits_are_laid_onto_a_map_and_hold_only_there():
    grid = mask(np.zeros((2, 6)), 0.05)
    speeds = SpeedLimit(mask([[50, 75]], 0.1)).onto(grid, 2.0)
    assert speeds.tolist() == [[1.0, 1.0, 0.5, 0.5, 2.0, 2.0]] * 2


@pytest.mark.skipif(DATA is None, reason="no data folder: Nav2's masks left out (set UVF_DATA)")
def test_the_masks_of_nav2s_depot_lie_on_its_map():
    depot, keepout, speed = (load_map(DATA / "slam" / "maps" / f"nav2_depot{part}.yaml") for part in ("", "_keepout", "_speed"))
    assert KeepOut(keepout).onto(depot).sum() == (keepout.cells == 100).sum() > 1000
    assert set(np.unique(SpeedLimit(speed).layer(0.5).cells)) == {0, 50, 75, 80, 100}
