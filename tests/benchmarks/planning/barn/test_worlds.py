"""Worlds from files, which of them are wanted, and files that are none."""

import numpy as np
import pytest

from benchmarks.planning.barn.dynamic_worlds import dynamic_names, dynamic_world
from benchmarks.planning.barn.worlds import chosen, static_names, static_world
from tests.benchmarks.planning.barn.made_up import folder
from uvf.models.yaml_data import BadInput

NAMES = {n: f"{'easy' if n < 10 else 'hard'}_{n}" for n in (1, 3, 5, 12, 18, 40)}


def test_a_static_world_has_its_cylinders_path_and_optimal_time(tmp_path):
    data = folder(tmp_path)
    assert static_names(data) == {4: "world_4", 7: "world_7"}
    four, seven = static_world(data, 4), static_world(data, 7)
    assert four.discs.shape == (20, 3) and (four.discs[:, 2] == 0.075).all() and four.path is None
    assert four.optimal_time == 5.5 and seven.optimal_time == 6.25
    assert seven.path == pytest.approx(np.array([(0.15 * 15 - 4.575, 5.075), (0.15 * 15 - 4.575, 0.15 * 40 + 5.075)]))
    assert seven.start == pytest.approx((-2.25, 3.0, np.pi / 2)) and seven.goal == (-2.25, 13.0)


def test_a_dynamic_world_has_three_walls_and_its_moving_discs(tmp_path):
    data = folder(tmp_path)
    assert dynamic_names(data) == {2: "easy_2"}
    world = dynamic_world(data, 2)
    assert world.movers.at(0.0)[0] == pytest.approx((11.0, 5.0, 0.5)) and len(world.boxes) == 3
    assert world.optimal_time is None and world.start == pytest.approx((11.0, 0.0, np.pi)) and world.goal == (-9.0, 0.0)
    assert dynamic_world(data, 2, "linear").movers.at(2.0)[0, 1] == pytest.approx(3.0)


@pytest.mark.parametrize(
    ("wanted", "numbers"),
    [
        (None, [1, 3, 5, 12, 18, 40]),
        ("5", [5]),
        ("18, 1", [1, 18]),
        ("0:6", [1, 3, 5]),
        (":", [1, 3, 5, 12, 18, 40]),
        ("3:", [3, 5, 12, 18, 40]),
        ("0:41:6", [12, 18]),
        ("easy_3", [3]),
        ("hard_*,1", [1, 12, 18, 40]),
        ("1:4,2:6", [1, 3, 5]),
    ],
)
def test_worlds_are_chosen_by_number_range_name_and_pattern(wanted, numbers):
    assert chosen(wanted, NAMES) == numbers


@pytest.mark.parametrize(
    ("wanted", "mend"),
    [
        ("2", "numbers are 1, 3, 5, 12, 18, 40"),
        ("6:12", "numbers are 1"),
        ("1,99", "--worlds 99"),
        ("0:9:0", "no such world"),
        ("eesy_3", "did you mean 'easy_3'"),
        ("", "there are"),
        ("1,,3", "no such world"),
        ("-1", "there are"),
    ],
)
def test_what_names_no_world_is_refused(wanted, mend):
    with pytest.raises(BadInput, match="--worlds") as refused:
        chosen(wanted, NAMES)
    assert mend in str(refused.value)


def test_without_data_it_is_said_what_is_missing(tmp_path):
    for data, mend in ((None, "--data"), (tmp_path, "there is no file")):
        for names in (static_names, dynamic_names):
            with pytest.raises(BadInput, match=mend):
                names(data)


@pytest.mark.parametrize("content", [b"", b"no archive", b"PK\x03\x04broken", b"\x93NUMPY"])
def test_an_archive_that_is_none_is_one_line(tmp_path, content):
    data = folder(tmp_path)
    (data / "barn" / "barn_worlds.npz").write_bytes(content)
    for read in (static_names, lambda data: static_world(data, 4)):
        with pytest.raises(BadInput, match=r"barn_worlds\.npz"):
            read(data)


@pytest.mark.parametrize(
    "array", [np.zeros(4), np.zeros((4, 3)), np.full((4, 2), np.nan), np.array([["a", "b"]]), np.array([[None, 1]], dtype=object)]
)
def test_an_array_that_is_no_list_of_points_is_one_line(tmp_path, array):
    data = folder(tmp_path, {"world_4": array})
    with pytest.raises(BadInput, match="world_4"):
        static_world(data, 4)


def test_an_archive_without_worlds_or_without_the_one_asked_for_is_one_line(tmp_path):
    data = folder(tmp_path, {"other": np.zeros((1, 2))})
    with pytest.raises(BadInput, match="no array world_NUMBER"):
        static_names(data)
    with pytest.raises(BadInput, match="no array world_9"):
        static_world(data, 9)


@pytest.mark.parametrize(
    ("lengths", "mend"),
    [
        ("world,path_length_m\n7,12\n", "no row for world 4"),
        ("", "no row for world 4"),
        ("world,length\n4,12\n", r"csv:2: needs"),
        ("world,path_length_m\n4,far\n", r"csv:2: needs"),
        ("world,path_length_m\n7,1\n4\n", r"csv:3: needs"),
        ("world,path_length_m\n4,-1\n", "above 0 m"),
        ("world,path_length_m\n4,nan\n", "above 0 m"),
    ],
)
def test_a_table_of_lengths_that_is_broken_is_one_line(tmp_path, lengths, mend):
    with pytest.raises(BadInput, match=mend):
        static_world(folder(tmp_path, lengths=lengths), 4)


@pytest.mark.parametrize(
    ("dynamic", "mend"),
    [
        ({"2": {"difficulty": "easy"}}, "obstacles"),
        ({"two": {"difficulty": "easy", "obstacles": []}}, "int"),
        ([], "object"),
        ({"2": {"difficulty": "easy", "obstacles": [{"radius": 0.5, "period": 1.0, "keyframes": [[0, 1]]}]}}, "length 3"),
        ({"2": {"difficulty": "easy", "obstacles": [{"radius": 0.5, "period": 1.0, "keyframes": []}]}}, "world 2, obstacle 0"),
        ({"3": {"difficulty": "easy", "obstacles": []}}, "no world 2"),
    ],
)
def test_a_file_of_moving_discs_that_is_broken_is_one_line(tmp_path, dynamic, mend):
    with pytest.raises(BadInput, match=mend):
        dynamic_world(folder(tmp_path, dynamic=dynamic), 2)


def test_a_file_of_no_dynamic_worlds_is_one_line(tmp_path):
    with pytest.raises(BadInput, match="holds no world"):
        dynamic_names(folder(tmp_path, dynamic={}))
