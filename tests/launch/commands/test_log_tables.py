"""``uvf plot`` and ``uvf log export``: every number of a message by its name, in pictures and tables that others read."""

import csv
import json

import numpy as np
import pyarrow.parquet
import pytest
from typer.testing import CliRunner

from launch.cli import app
from launch.reports.curves import curves_of
from schemas import topics
from schemas.messages import Kind, LaserScan, Mode, NavStatus, PoseInFrame, Vector3, VehicleStatus
from schemas.topics import TOPICS
from uvf.runtime.bus.interface import Sample
from uvf.runtime.log.recording import Recorder
from uvf.runtime.messages.convert import planar_pose, stamp
from uvf.runtime.messages.fields import columns_of, number_names, number_of
from uvf.runtime.messages.topic_lookup import topic_of

N = 5000


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    path = tmp_path_factory.mktemp("log") / "log-000.mcap"
    with Recorder(path) as recorder:
        for i in range(N):
            t = i / 50
            for owner in ("anne", "bert"):
                pose = PoseInFrame(timestamp=stamp(t), frame_id="world", pose=planar_pose(0.1 * t, 2.0, 0.5 if owner == "anne" else -3.0))
                recorder.write(sample(topics.POSE.at(owner), pose, t, i))
            if i % 10 == 0:
                scan = LaserScan(timestamp=stamp(t - 0.01), ranges=[1.0, 2.0 + t] if i else [1.0])
                recorder.write(sample(topics.SCAN.at("anne"), scan, t, i // 10))
        status = VehicleStatus(kind=Kind.KIND_GROUND, mode=Mode.MODE_HOLD, prearm=["no fix, yet", 'a "quoted" one'])
        recorder.write(sample(topics.STATUS.at("anne"), status, 3.0, 0))
        broken = sample(topics.STATUS.at("anne"), status, 4.0, 1)
        recorder.write(broken._replace(payload=b"\xff\xff"))
        recorder.write(sample(topics.NAV_STATUS.at("anne"), NavStatus(goal=Vector3(x=1.5)), 3.0, 0))
    return path


def sample(key, message, t, seq):
    return Sample(key, message.DESCRIPTOR.full_name, message.SerializeToString(), round(t * 1e9), seq + 1, 0)


def uvf(*arguments):
    done = CliRunner().invoke(app, [str(a) for a in arguments])
    return done.exit_code, done.output


def test_curves_are_the_values_of_the_fields(log):
    yaw, x, second = curves_of(log, ["*/nav/pose.pose.orientation.yaw", "anne/nav/pose.pose.position.x", "anne/sensor/scan.ranges[1]"])
    assert sorted(yaw) == ["uvf/anne/nav/pose", "uvf/bert/nav/pose"] and yaw["uvf/bert/nav/pose"][1] == pytest.approx(np.full(N, -3.0))
    t, values = x["uvf/anne/nav/pose"]
    assert values == pytest.approx(0.1 * t) and len(t) == N
    t, values = second["uvf/anne/sensor/scan"]
    assert len(t) == N // 10 - 1 and values == pytest.approx(2.0 + t)  # the first scan is too short
    ((_, stamped),) = curves_of(log, ["anne/sensor/scan.timestamp"])[0].values()
    assert stamped[1] == pytest.approx(0.19)


def test_a_picture_is_drawn_of_any_kind_that_is_asked_for(log, tmp_path):
    for name in ("a.png", "b.svg"):
        code, said = uvf("plot", log, "*/nav/pose.pose.position.x", "anne/state/vehicle.mode", "--out", tmp_path / name)
        assert code == 0 and "anne/nav/pose.pose.position.x: 5000 values from 0 to 9.998" in said, said
        assert (tmp_path / name).stat().st_size > 10_000


@pytest.mark.parametrize(
    ("field", "why"),
    [
        ("anne/nav/pose", "no field is named"),
        ("anne/nav/pse.pose.position.x", "did you mean 'anne/nav/pose'?"),
        ("anne/nav/pose.pose.positon.x", "no field 'positon'; did you mean 'position'?"),
        ("anne/nav/pose.pose.position", "is no number; there are: x, y, z"),
        ("anne/nav/pose.frame_id", "frame_id is no number"),
        ("anne/nav/pose.frame_id.x", "frame_id has no fields"),
        ("anne/sensor/scan.ranges", "ranges is a list: choose one of it, as ranges[0]"),
        ("anne/nav/pose.pose[0].position.x", "pose is no list"),
        ("anne/nav/pose.pose..x", "'' is no field"),
    ],
)
def test_a_field_that_is_none_is_one_line(log, field, why):
    code, said = uvf("plot", log, field)
    assert code == 2 and why in " ".join(said.split()), said


def test_a_picture_that_cannot_be_written_is_one_line(log, tmp_path):
    for out in (tmp_path / "no" / "a.png", tmp_path / "a.xyz"):
        code, said = uvf("plot", log, "anne/nav/pose.pose.position.x", "--out", out)
        assert code == 2 and "--out" in said, said


def test_tables_hold_every_message_and_field(log, tmp_path):
    code, said = uvf("log", "export", log, "--out", tmp_path / "out")
    assert code == 0 and f"{2 * N + N // 10 + 2} messages of 5 topics" in said, said
    with (tmp_path / "out" / "bert.nav.pose.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == N and float(rows[77]["t"]) == 77 / 50 and float(rows[77]["pose.position.x"]) == pytest.approx(0.154)
    with (tmp_path / "out" / "anne.state.vehicle.csv").open() as file:
        (row,) = csv.DictReader(file)
    assert (row["mode"], row["kind"], row["armed"]) == ("MODE_HOLD", "KIND_GROUND", "false")
    assert json.loads(row["prearm"]) == ["no fix, yet", 'a "quoted" one']
    with (tmp_path / "out" / "anne.sensor.scan.csv").open() as file:
        assert json.loads(list(csv.DictReader(file))[10]["ranges"]) == [1.0, 4.0]


def test_parquet_holds_lists_as_lists(log, tmp_path):
    code, said = uvf("log", "export", log, "anne/sensor/scan", "*/nav/status", "--parquet", "--out", tmp_path)
    assert code == 0 and {path.name for path in tmp_path.iterdir()} == {"anne.sensor.scan.parquet", "anne.nav.status.parquet"}, said
    scans = pyarrow.parquet.read_table(tmp_path / "anne.sensor.scan.parquet").to_pydict()
    assert scans["ranges"][:2] == [[1.0], [1.0, 2.2]] and scans["t"][1] == 0.2
    assert pyarrow.parquet.read_table(tmp_path / "anne.nav.status.parquet").to_pydict()["goal.x"] == [1.5]


def test_what_cannot_be_exported_is_one_line(log, tmp_path):
    (tmp_path / "file").write_text("")
    for arguments, why in (((log, "anne/nav/pse"), "did you mean 'anne/nav/pose'?"), ((log, "--out", tmp_path / "file"), "--out")):
        code, said = uvf("log", "export", *arguments)
        assert code == 2 and why in " ".join(said.split()), said


def test_the_layout_shows_what_the_log_holds_and_nothing_else(log, tmp_path):
    code, said = uvf("log", "layout", log, "--out", tmp_path / "layout.json")
    assert code == 0, said
    layout = json.loads((tmp_path / "layout.json").read_text())
    panels = layout["configById"]
    assert list(panels["3D!scene"]["topics"]) == ["/uvf/anne/sensor/scan", "/uvf/anne/nav/pose"]
    for panel in panels.values():
        for path in panel.get("paths", ()):
            key, _, field = path["value"].removeprefix("/").partition(".")
            number_of(topic_of(key).message.DESCRIPTOR, field)

    def leaves(tree):
        return [tree] if isinstance(tree, str) else leaves(tree["first"]) + leaves(tree["second"])

    assert sorted(leaves(layout["layout"])) == sorted(panels) and "Image!camera" not in panels
    assert uvf("log", "layout", log, "--out", tmp_path / "no" / "x")[0] == 2


@pytest.mark.parametrize("topic", TOPICS.values(), ids=lambda topic: topic.key)
def test_every_type_of_the_table_has_columns_and_numbers_that_can_be_read(topic):
    message = topic.message()
    for kind, get in columns_of(topic.message.DESCRIPTOR).values():
        assert isinstance(get(message), (int, float) if kind is float else kind)
    for name in number_names(topic.message.DESCRIPTOR):
        assert number_of(topic.message.DESCRIPTOR, name)(message) in (None, pytest.approx(0.0, abs=4.0))


def test_of_a_log_that_was_cut_off_what_is_whole_is_exported_and_plotted(log, tmp_path):
    cut = tmp_path / "log-000.mcap"
    cut.write_bytes(log.read_bytes()[:-200])
    note = f"{cut}: still being written, or cut off: this is what is whole of it\n"
    saved = f"{N} messages of 1 topics saved into {tmp_path / 'csv'}\n"
    assert uvf("log", "export", tmp_path, "anne/nav/pose") == (0, saved + note)
    code, output = uvf("plot", tmp_path, "anne/nav/pose.pose.position.x")
    assert code == 0 and output.endswith(note) and (tmp_path / "plot.png").is_file()
