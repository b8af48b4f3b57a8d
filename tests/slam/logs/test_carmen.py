"""CARMEN logs with each trap that real ones have, and with what breaks on the way."""

from math import pi

import numpy as np
import pytest

from tests.slam.logs.carmen_text import flaser, odom, robotlaser, write
from uvf.maths.se2_arrays import composed
from uvf.models.yaml_data import BadInput
from uvf.slam.logs.carmen import read_carmen

RANGES = tuple(round(1.0 + 0.01 * i, 2) for i in range(180))


def driving(n, speed=0.5):
    """n FLASER lines, 0.1 s apart, straight on."""
    return [flaser(100.0 + 0.1 * i, (speed * i * 0.1, 0.0, 0.0), RANGES) for i in range(n)]


def test_stamps_that_fall_do_not_change_the_order_in_which_the_vehicle_drove(tmp_path):
    stamps = [100.0, 100.3, 100.2, 100.4, 100.5]
    log = read_carmen(write(tmp_path, *(flaser(t, (0.1 * i, 0.0, 0.0), RANGES) for i, t in enumerate(stamps))))
    assert [r.odom_from_base.x for r in log] == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.4])
    assert log.stamps.tolist() == stamps
    assert [r.t for r in log] == pytest.approx([100.0, 100.25, 100.25, 100.4, 100.5])
    assert "1 stamps fall" in log.notes[0]


def test_a_shuffled_file_is_put_back_into_order(tmp_path):
    lines = driving(30)
    np.random.default_rng(1).shuffle(lines)
    log = read_carmen(write(tmp_path, *lines))
    assert np.all(np.diff(log.stamps) > 0.0)
    assert np.diff(log.odom_from_base[:, 0]) == pytest.approx(0.05)
    assert "out of order" in log.notes[0]


def test_the_pose_is_the_robots_not_the_lasers(tmp_path):
    log = read_carmen(write(tmp_path, *(flaser(i, (1.0 * i, 0.0, 0.0), RANGES, laser_pose=(9.0, 9.0, 1.0)) for i in range(3))))
    assert log.odom_from_base[:, 0].tolist() == [0.0, 1.0, 2.0]


def test_the_laser_sits_where_the_parameters_say(tmp_path):
    params = (
        "PARAM robot_frontlaser_offset -0.04 nohost 0",
        "PARAM robot_frontlaser_side_offset 0.1 nohost 0",
        "PARAM robot_frontlaser_angular_offset 0.5 nohost 0",
    )
    beams = read_carmen(write(tmp_path, *params, *driving(2))).readings[0].beams
    assert beams.origin == (-0.04, 0.1)
    assert beams.bearings[0] == pytest.approx(-pi / 2 + 0.5)


def test_a_robotlaser_line_says_itself_where_its_laser_is(tmp_path):
    lines = [robotlaser(i, (1.0 + i, 0.0, pi / 2), (2.0,) * 31, (1.0 + i, 0.2, -pi / 2)) for i in range(3)]
    beams = read_carmen(write(tmp_path, "PARAM robot_frontlaser_offset 5 nohost 0", *lines)).readings[0].beams
    assert beams.origin == pytest.approx((0.2, 0.0))
    assert np.cos(beams.bearings[15]) == pytest.approx(-1.0)


def test_corrected_laser_poses_beside_raw_robot_poses_are_no_place_on_the_robot(tmp_path):
    lines = [robotlaser(i, (1.0 * i, 0.0, 0.0), (2.0,) * 31, (1.2 * i, 0.1 * i, 0.0)) for i in range(5)]
    beams = read_carmen(write(tmp_path, "PARAM robot_frontlaser_offset 0.3 nohost 0", *lines)).readings[0].beams
    assert beams.origin == (0.3, 0.0)


@pytest.mark.parametrize(
    ("count", "last", "step"),
    [(180, 89.0, 1.0), (181, 90.0, 1.0), (360, 89.5, 0.5), (361, 90.0, 0.5), (541, 135.0, 0.5), (1081, 135.0, 0.25)],
)
def test_the_beams_of_a_flaser_line_follow_from_their_number(tmp_path, count, last, step):
    log = read_carmen(write(tmp_path, flaser(1.0, (0, 0, 0), np.linspace(1.0, 8.0, count))))
    beams = log.readings[0].beams
    assert log.notes == ()
    assert np.degrees(beams.bearings[-1]) == pytest.approx(last)
    assert np.degrees(np.diff(beams.bearings)) == pytest.approx(step)


def test_a_number_of_beams_that_no_usual_lidar_has_is_told(tmp_path):
    log = read_carmen(write(tmp_path, flaser(1.0, (0, 0, 0), np.linspace(1.0, 8.0, 401))))
    assert [n for n in log.notes if "401 beams: taken for half a circle" in n]


def test_the_beams_follow_from_the_parameters_where_these_fit(tmp_path):
    params = ("PARAM laser_laser1_fov 100 nohost 0", "PARAM laser_laser1_resolution 0.25 nohost 0")
    beams = read_carmen(write(tmp_path, *params, flaser(1.0, (0, 0, 0), (1.0,) * 401), flaser(2.0, (0, 0, 0), RANGES))).readings
    assert np.degrees(beams[0].beams.bearings[[0, -1]]) == pytest.approx((-50.0, 50.0))
    assert np.degrees(beams[1].beams.bearings[[0, -1]]) == pytest.approx((-90.0, 89.0))


def test_beam_count_and_start_may_change_from_line_to_line(tmp_path):
    fans = [(-1.57, 3.14, 0.0174, 81.9), (-1.56, 3.14, 0.0174, 81.9)]
    lines = [robotlaser(i, (0, 0, 0), (2.0,) * (180 + i % 2), (0, 0, 0), fan=fans[i % 2]) for i in range(6)]
    log = read_carmen(write(tmp_path, *lines))
    assert [len(r.ranges) for r in log] == [180, 181] * 3
    assert [r.beams.bearings[0] for r in log] == pytest.approx([-1.57, -1.56] * 3)
    assert len({id(r.beams) for r in log}) == 2


@pytest.mark.parametrize(("remissions", "turn_axis"), [((), True), ((7.0,) * 31, True), ((), False)])
def test_robotlaser_lines_of_every_age_are_read(tmp_path, remissions, turn_axis):
    line = robotlaser(5.0, (1.0, 2.0, 0.5), (2.0,) * 31, (1.0, 2.0, 0.5), remissions=remissions, turn_axis=turn_axis)
    log = read_carmen(write(tmp_path, line, robotlaser(6.0, (2.0, 2.0, 0.5), (2.0,) * 31, (2.0, 2.0, 0.5), turn_axis=turn_axis)))
    assert log.odom_from_base[1] == pytest.approx((np.cos(0.5), -np.sin(0.5), 0.0))
    assert log.readings[0].beams.origin == pytest.approx((0.0, 0.0))


def test_a_heap_of_readings_at_the_far_end_is_no_return(tmp_path):
    rng = np.random.default_rng(2)
    ranges = [np.where(rng.random(180) < 0.1, 81.83, rng.uniform(0.5, 30.0, 180)).round(2) for _ in range(20)]
    log = read_carmen(write(tmp_path, *(flaser(i, (0, 0, 0), r) for i, r in enumerate(ranges))))
    for reading, r in zip(log, ranges, strict=True):
        assert np.array_equal(reading.returned, r < 80.0)


def test_several_codes_for_no_return_are_all_found_and_returns_shortly_before_them_stay(tmp_path):
    ranges = [50.7, *(51.1, 51.14, 51.15, 51.16) * 20, *(3.0,) * 99]
    log = read_carmen(write(tmp_path, flaser(1.0, (0, 0, 0), ranges)))
    assert log.readings[0].returned.sum() == 100


@pytest.mark.parametrize("decimals", [2, 9])
def test_no_return_is_found_where_returns_reach_up_to_it(tmp_path, decimals):
    """A lidar of 3.5 m in a building with larger rooms."""
    rng = np.random.default_rng(5)
    ranges = [np.where(rng.random(180) < 0.1, 3.5, rng.uniform(0.3, 3.49, 180)).round(decimals) for _ in range(60)]
    log = read_carmen(write(tmp_path, *(flaser(i, (0, 0, 0), r) for i, r in enumerate(ranges))))
    assert all(np.array_equal(reading.returned, r < 3.5) for reading, r in zip(log, ranges, strict=True))


def test_readings_that_thin_out_toward_the_far_end_are_all_returns(tmp_path):
    ranges = np.random.default_rng(3).uniform(0.5, 30.0, (20, 180)).round(2)
    log = read_carmen(write(tmp_path, *(flaser(i, (0, 0, 0), r) for i, r in enumerate(ranges))))
    assert all(r.returned.all() for r in log)


def test_the_largest_range_of_the_robot_or_the_line_holds(tmp_path):
    ranges = (2.0, 6.0, 12.0) * 10
    by_param = read_carmen(write(tmp_path, "PARAM robot_front_laser_max 5 nohost 0", flaser(1.0, (0, 0, 0), ranges)))
    by_line = read_carmen(write(tmp_path, robotlaser(1.0, (0, 0, 0), ranges, (0, 0, 0), fan=(0.0, 3.0, 0.1, 10.0))))
    assert (by_param.readings[0].returned.sum(), by_line.readings[0].returned.sum()) == (10, 20)


def test_a_largest_range_of_zero_is_none(tmp_path):
    log = read_carmen(write(tmp_path, "PARAM robot_front_laser_max 0 nohost 0", *driving(2)))
    assert log.readings[0].returned.all()


def test_a_few_garbled_ranges_do_not_hide_what_is_no_return(tmp_path):
    rng = np.random.default_rng(6)
    ranges = [np.where(rng.random(180) < 0.1, 81.83, rng.uniform(0.5, 30.0, 180)).round(2) for _ in range(20)]
    ranges[3][5], ranges[7][9] = 8183.0, 1e30
    log = read_carmen(write(tmp_path, *(flaser(i, (0, 0, 0), r) for i, r in enumerate(ranges))))
    assert all(np.array_equal(reading.returned, r < 80.0) for reading, r in zip(log, ranges, strict=True))


@pytest.mark.parametrize(("ranges", "told"), [(np.zeros(180), "nothing to map"), (1000.0 * np.array(RANGES), "CARMEN's are in metres")])
def test_ranges_that_no_map_can_be_made_of_are_told(tmp_path, ranges, told):
    log = read_carmen(write(tmp_path, flaser(1.0, (0, 0, 0), ranges)))
    assert told in log.notes[0]


def test_odometry_that_never_moves_is_told(tmp_path):
    still, moving = (read_carmen(write(tmp_path, *driving(3, speed))).notes for speed in (0.0, 0.5))
    assert "never moves" in still[0]
    assert moving == ()


def test_odometry_that_begins_far_away_begins_at_zero(tmp_path):
    lines = [flaser(i, (576.5, 0.1 + i, pi / 2), RANGES) for i in range(3)]
    log = read_carmen(write(tmp_path, odom(0.5, (576.5, 0.6, pi / 2)), *lines))
    assert log.odom_from_base == pytest.approx(np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0)]), abs=1e-9)
    assert log.odometry.odom_from_base[0] == pytest.approx((0.5, 0.0, 0.0))
    assert log.odometry.t.tolist() == [0.5]


def test_ranges_that_are_no_numbers_are_no_returns(tmp_path):
    log = read_carmen(write(tmp_path, flaser(1.0, (0, 0, 0), ("nan", "inf", 0.0, -1.0, 2.0))))
    assert log.readings[0].returned.tolist() == [False, False, False, False, True]


def test_broken_lines_are_left_out_counted_and_told_once(tmp_path):
    whole = driving(4)
    broken = [
        whole[0].replace("FLASER 180", "FLASER 179"),
        whole[1][:300],
        whole[2].replace(" 1.0 ", " one ", 1),
        "FLASER",
        "FLASER 0 0 0 0",
    ]
    lost = [flaser(9.0, ("nan", 0, 0), RANGES), flaser(float("nan"), (0, 0, 0), RANGES)]
    log = read_carmen(write(tmp_path, *whole[:2], *broken, *lost, *whole[2:], "ODOM 1 2", "SYNC x", "PARAM"))
    assert len(log) == 4
    assert len(log.notes) == 1
    for part in ("not as many ranges", "(first: line 3)", "words where numbers", "1 lines with stamp is no number", "cut short", "pose"):
        assert part in log.notes[0]


@pytest.mark.parametrize("change", [lambda line: line.replace(" ", "\t"), lambda line: f"  {line}\r"])
def test_white_space_of_any_kind_parts_the_words(tmp_path, change):
    assert len(read_carmen(write(tmp_path, *map(change, driving(3))))) == 3


def test_beams_that_all_point_the_same_way_and_poses_beyond_the_earth_are_left_out(tmp_path):
    good = robotlaser(1.0, (0, 0, 0), (2.0,) * 31, (0, 0, 0))
    flat = robotlaser(2.0, (0, 0, 0), (2.0,) * 31, (0, 0, 0), fan=(0.0, 0.0, 0.0, 20.0))
    lost = robotlaser(3.0, (1e300, 0, 0), (2.0,) * 31, (0, 0, 0))
    log = read_carmen(write(tmp_path, good, flat, lost))
    assert len(log) == 1
    assert "1 lines with beams that all point the same way (first: line 2)" in log.notes[0]
    assert "1 lines with a pose or a direction that cannot be (first: line 3)" in log.notes[0]


@pytest.mark.parametrize("which", ["", "side_", "angular_"])
def test_a_laser_that_cannot_be_on_the_robot_is_refused(tmp_path, which):
    with pytest.raises(BadInput, match=r"made\.clf: the laser is said to sit at .* mend PARAM robot_frontlaser"):
        read_carmen(write(tmp_path, f"PARAM robot_frontlaser_{which}offset 1e300 nohost 0", *driving(2)))


def test_a_clock_that_is_set_back_goes_on(tmp_path):
    stamps = [100.0, 100.1, 100.2, 40.0, 40.1]
    log = read_carmen(write(tmp_path, *(flaser(t, (0.1 * i, 0, 0), RANGES) for i, t in enumerate(stamps))))
    assert [r.t for r in log] == pytest.approx([100.0, 100.1, 100.2, 100.3, 100.4])
    assert any("set back 1 times" in n for n in log.notes)


@pytest.mark.parametrize("garbled", [0.0, 1e12])
def test_a_single_garbled_stamp_moves_no_other_one(tmp_path, garbled):
    stamps = [100.0, 100.1, garbled, 100.3, 100.4]
    log = read_carmen(write(tmp_path, *(flaser(t, (0.1 * i, 0, 0), RANGES) for i, t in enumerate(stamps))))
    assert [r.t for r in log] == pytest.approx([100.0, 100.1, 100.2, 100.3, 100.4])
    assert log.stamps.tolist() == stamps
    assert len(log.notes) == 1 and "1 stamps are far from those before and after" in log.notes[0]


def test_a_track_whose_clock_was_set_back_is_not_laid_beside_the_sweeps(tmp_path):
    stamps = [100.0, 100.1, 100.2, 40.0, 40.1]
    lines = [line for i, t in enumerate(stamps) for line in (odom(t, (0.1 * i, 0, 0)), flaser(t, (0.1 * i, 0, 0), RANGES))]
    assert read_carmen(write(tmp_path, *lines[:6])).odometry is not None
    assert read_carmen(write(tmp_path, *lines)).odometry is None


def test_odometry_and_clock_that_begin_anew_together_are_a_leap(tmp_path):
    lines = [flaser(5000.0 + 0.1 * i, (30.0 + 0.1 * i, 0, 0), RANGES) for i in range(5)]
    lines += [flaser(0.1 * i, (0.1 * i, 0, 0), RANGES) for i in range(5)]
    log = read_carmen(write(tmp_path, *lines))
    assert log.odom_from_base[:, 0] == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.4, 0.4, 0.5, 0.6, 0.7, 0.8])


def test_a_long_time_without_sweeps_is_told(tmp_path):
    stamps = [0.0, 1.0, 200.0, 201.0, 290.0]
    log = read_carmen(write(tmp_path, *(flaser(t, (0.1 * i, 0, 0), RANGES) for i, t in enumerate(stamps))))
    assert [n for n in log.notes if "2 times (longest after stamp 1.0" in n]
    assert log.duration == 290.0


@pytest.mark.parametrize("leap", [(50.0, 0.0, 0.0), (0.0, 0.0, 2.5)])
def test_odometry_that_leaps_is_told_and_taken_for_standing_still(tmp_path, leap):
    away = [composed(np.array(leap), np.array((0.1 * i, 0.0, 0.0))).tolist() for i in range(10)]
    poses = [(0.1 * i, 0.0, 0.0) if i <= 5 else away[i] for i in range(10)]
    lines = [line for i, p in enumerate(poses) for line in (odom(0.2 * i, p), flaser(0.2 * i, p, RANGES))]
    log = read_carmen(write(tmp_path, *lines))
    assert [n for n in log.notes if "leaps 1 times (first at stamp 1.2" in n]
    driven = [0.1] * 5 + [0.0] + [0.1] * 3
    assert np.diff(log.odom_from_base[:, 0]) == pytest.approx(driven, abs=1e-9)
    assert np.diff(log.odometry.odom_from_base[:, 0]) == pytest.approx(driven, abs=1e-9)
    assert log.odom_from_base[:, 1:] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "is empty"),
        ("hello\nworld\n", "not a CARMEN log"),
        ("ODOM 0 0 0 0 0 0 1 h 1\n", "no FLASER"),
        ("FLASER 180 1 2 3 1.0 h 1.0\n", "no scan can be read: 1 lines with not as many ranges as the line says (first: line 1)"),
    ],
)
def test_a_file_without_a_usable_sweep_is_refused_in_one_line(tmp_path, text, told):
    path = tmp_path / "bad.clf"
    path.write_text(text)
    with pytest.raises(BadInput, match=r"bad\.clf") as refused:
        read_carmen(path)
    assert told in str(refused.value)
    assert "\n" not in str(refused.value)


def test_bytes_that_are_no_text_are_refused(tmp_path):
    path = tmp_path / "noise.clf"
    path.write_bytes(np.random.default_rng(4).bytes(5000))
    with pytest.raises(BadInput, match=r"noise\.clf"):
        read_carmen(path)
    with pytest.raises(BadInput, match="No such file"):
        read_carmen(tmp_path / "missing.clf")
