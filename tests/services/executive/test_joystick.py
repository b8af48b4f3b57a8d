"""Recorded drives: a file of velocities, each of which holds until the next one."""

import pytest

from services.executive.actions.joystick import load_drive_track
from uvf.models.yaml_data import BadInput


def written(folder, text):
    path = folder / "a.csv"
    path.write_text(text)
    return path


def test_a_velocity_holds_until_the_next_one_and_the_track_ends(tmp_path):
    track = load_drive_track(written(tmp_path, "t,linear,angular\n5.0,0.1,0\n5.5,0.2,-0.3\n6,0,0\n"))
    assert [track.at(t) for t in (0.0, 0.4, 0.5, 1.0, 1.1)] == [(0.1, 0.0), (0.1, 0.0), (0.2, -0.3), (0.0, 0.0), None]


def test_a_table_exported_from_a_log_is_a_track(tmp_path):
    track = load_drive_track(written(tmp_path, '"t","timestamp","linear","angular"\n5.0,5.0,0.1,0\n5.5,5.5,0.2,-0.3\n6,6,0,0\n'))
    assert [track.at(t) for t in (0.0, 0.5)] == [(0.1, 0.0), (0.2, -0.3)]


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("", "a.csv:1: the first line names the columns: t,linear,angular"),
        ("t,x\n0,1\n", "a.csv:1: the first line names the columns"),
        ("t,linear,angular\n", "0 rows"),
        ("t,linear,angular\n0,a,0\n", "a.csv:2: could not convert"),
        ("t,linear,angular\n0,1\n", "a.csv:2: give three finite numbers"),
        ("angular,x,linear,t\n0,1,2\n", "a.csv:2: give three finite numbers"),
        ("t,linear,angular\n0,nan,0\n", "a.csv:2: give three finite numbers"),
        ("t,linear,angular\n0,0,0\n2,0,0\n1,0,0\n", "a.csv:4: t does not rise"),
    ],
)
def test_what_is_wrong_is_said_with_its_line(tmp_path, text, why):
    with pytest.raises(BadInput) as error:
        load_drive_track(written(tmp_path, text))
    assert why in str(error.value)
