"""Scan matching on a pyramid of maps."""

from dataclasses import replace

import numpy as np
import pytest

from tests.services.slam.drives import broken, drive, odometry_of, off_by, truth
from uvf.models.yaml_data import BadInput
from uvf.slam.hector.gradient import climb, interpolated
from uvf.slam.hector.method import HectorSlam
from uvf.slam.hector.params import HectorParams
from uvf.slam.methods import make_method, method_params


def run(readings, **params):
    method = HectorSlam(HectorParams(**params))
    return method, [method.add(reading) for reading in readings]


def test_a_room_is_tracked_within_centimetres_by_the_laser_alone():
    method, told = run(drive(odometry=False))
    metres, radians = off_by(method.trajectory())
    assert metres < 0.05
    assert radians < 0.02
    assert np.median([e.quality for e in told]) > 0.7


def test_a_vehicle_that_goes_on_as_it_went_is_found_by_a_slow_lidar():
    """Half a metre and a third of a radian between readings: from the last pose on, without the motion so far, it would be lost."""
    away = run(drive(odometry=False)[::8])[0].trajectory() - truth()[::8]
    assert np.hypot(*away[:, :2].T).max() < 0.05


def test_offered_odometry_is_not_looked_at_unless_asked_for():
    right, wrong = (run(drive(turns=turns))[0].trajectory() for turns in (1.0, 3.0))
    assert (right == wrong).all()


def test_odometry_is_where_the_search_begins_when_asked_for():
    """Ten times as slow a lidar: by itself it is lost, and so is the odometry, which turns too far by a third."""
    readings = drive(turns=1.3)[::10]
    alone, held = (run(readings, use_odometry=used)[0].trajectory() for used in (False, True))
    by_laser, by_both, by_odometry = (np.hypot(*(p - truth()[::10])[:, :2].T).max() for p in (alone, held, odometry_of(readings)))
    assert min(by_laser, by_odometry) > 0.5
    assert by_both < 0.05


def test_what_the_vehicle_has_before_its_own_lidar_is_left_out_by_its_range():
    def masked(reading):
        return replace(reading, ranges=np.where((np.arange(360) >= 100) & (np.arange(360) < 300), 0.25, reading.ranges))

    readings = [masked(reading) for reading in drive()]
    assert off_by(run(readings, laser_min_dist=0.5)[0].trajectory())[0] < 0.06
    assert off_by(run(readings)[0].trajectory())[0] > 0.5


def test_a_lidar_that_turns_clockwise_and_sits_aside_is_tracked_too():
    assert off_by(run(drive(offset=True))[0].trajectory())[0] < 0.06


def test_each_level_is_a_map_of_its_own():
    method, _ = run(drive(10), map_multi_res_levels=2)
    fine, coarse = method.levels
    assert (fine.cell, coarse.cell) == (0.05, 0.1)
    assert fine.tiles > coarse.tiles > 0


def test_readings_go_into_the_maps_after_a_motion_only():
    assert len(list(run(drive(10), map_update_distance_thresh=4.0, map_update_angle_thresh=3.0)[0].keyframes())) == 1
    many = list(run(drive(), map_update_distance_thresh=0.1)[0].keyframes())
    few = list(run(drive(), map_update_distance_thresh=0.8, map_update_angle_thresh=1.0)[0].keyframes())
    assert 1 < len(few) < len(many)


def test_the_covariance_is_small_where_walls_are_and_large_where_nothing_is():
    readings = drive(20)
    method, told = run(readings)
    sigmas = np.sqrt(np.diag(told[-1].covariance))
    assert (sigmas > (1e-3, 1e-3, 5e-4)).all() and (sigmas < (0.01, 0.01, 0.005)).all()
    blind = method.add(type(readings[0])(1e3, np.zeros(360), readings[0].beams, readings[0].odom_from_base))
    assert blind.covariance[0, 0] > 0.5
    assert blind.quality == 0.0
    assert blind.map_from_base == told[-1].map_from_base


def test_occupancy_between_cells_is_what_its_gradient_says():
    method, _ = run(drive(5))
    grid = method.levels[0].grid(0)
    for x, y in ((20.3, 11.7), (-13.2, 30.9), (5.5, 7.5)):
        value, slope_x, slope_y = interpolated(x, y, grid)
        assert 0.0 <= value <= 1.0
        assert slope_x == pytest.approx((interpolated(x + 1e-4, y, grid)[0] - value) / 1e-4, abs=1e-3)
        assert slope_y == pytest.approx((interpolated(x, y + 1e-4, grid)[0] - value) / 1e-4, abs=1e-3)
    assert interpolated(1e6, 1e6, grid) == (0.5, 0.0, 0.0)


def test_nothing_moves_on_an_empty_map():
    method = HectorSlam()
    pose = climb(np.array((1.0, 2.0, 0.3)), np.ones((50, 2)), method.levels[0].grid(0), 5, (np.array((1.0, 2.0, 0.3)), np.ones(3)))
    assert pose.tolist() == [1.0, 2.0, 0.3]


def test_nothing_in_a_reading_ends_it():
    method, told = run(broken(), use_odometry=True)
    assert np.isfinite(method.trajectory()).all()
    assert all(np.isfinite(e.covariance).all() and 0.0 <= e.quality <= 1.0 for e in told)
    assert off_by(run([*drive(), *broken()])[0].trajectory()[:80])[0] < 0.05


def test_parameters_have_hector_mappings_names():
    params = method_params("hector", {"map_multi_res_levels": 2, "update_factor_free": 0.45}, "here")
    assert make_method("hector", params).trajectory().shape == (0, 3)
    with pytest.raises(BadInput, match="did you mean 'map_update_angle_thresh'"):
        method_params("hector", {"map_update_angle_treshold": 0.1}, "here")
    with pytest.raises(BadInput, match="update_factor_free"):
        method_params("hector", {"update_factor_free": 0.9}, "here")
