"""``uvf report`` and ``uvf compare`` on runs of rovers and of teams: what was recorded is told, and a stranger's text stays text."""

import contextlib
import re
from html.parser import HTMLParser

import numpy as np
import pytest
from PIL import Image
from typer.testing import CliRunner

from launch.cli import app
from launch.reports.drive_figures import drive_figures, pose_errors, touches
from launch.reports.maps import reported_maps
from launch.reports.recorded_run import recorded_run
from launch.reports.team_page import distances
from launch.run import run_lockstep
from schemas import topics
from schemas.messages import Contact, Event, Kind, NavState, NavStatus, PoseInFrame, Quaternion, Tasks, TaskStatus, Vector3, VehicleStatus
from uvf.maths.se2 import Pose2
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.bus.interface import Sample
from uvf.runtime.bus.wire import Malformed
from uvf.runtime.log.recording import Recorder
from uvf.runtime.messages.convert import occupancy_grid, planar_frame, planar_pose, stamp

SECONDS = 12.0


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A rover and an aircraft for some seconds, in a mission of their own text."""
    folder = tmp_path_factory.mktemp("run")
    site = load_scenario(ROOT / "missions" / "demo.yaml")
    run_lockstep(site, SECONDS, folder / "log-000.mcap")
    return folder


def uvf(*arguments):
    done = CliRunner().invoke(app, [str(a) for a in arguments])
    return done.exit_code, done.output


class Page(HTMLParser):
    """What a browser would load, and the text that it would show."""

    def __init__(self, path):
        super().__init__()
        self.loads, self.text, self.tags = [], "", set()
        self.feed(path.read_text())

    def handle_starttag(self, tag, attrs):
        self.tags.add(tag)
        self.loads += [value for name, value in attrs if name in ("src", "href") and not value.startswith("#")]

    def handle_data(self, data):
        self.text += data

    def handle_endtag(self, tag):
        self.text += " " if tag in ("td", "th") else ""


def test_one_page_tells_of_all_vehicles_and_loads_nothing(run, tmp_path):
    code, said = uvf("report", run, "--out", tmp_path / "out")
    assert code == 0, said
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"report.html", "all-ways.png", "burger.png", "milvus.png"}
    page = Page(tmp_path / "out" / "report.html")
    assert len(page.loads) == 3 and all(each.startswith("data:image/png;base64,") for each in page.loads)
    for part in ("demo", "Criteria", "burger", "milvus", "Maps", "Events", "Messages", "Parameters", "jsbsim", "pybullet", "world: house"):
        assert part in page.text, part
    assert re.search(r"burger/truth/state 60\d 50 50 ", page.text)
    for name in ("burger", "milvus"):
        colours = np.unique(np.asarray(Image.open(tmp_path / "out" / f"{name}.png").convert("RGB")).reshape(-1, 3), axis=0)
        assert len(colours) > 100


def test_the_distances_between_vehicles_are_those_of_their_true_ways(run):
    with recorded_run(run) as recorded:
        ((name, (t, distance)),) = distances(recorded).items()
        rover, aircraft = (recorded.vehicles[v].rows("truth/state") for v in name.split(" to "))
    assert t[0] < 0.5 and t[-1] > SECONDS - 0.5
    for k in (0, len(t) // 2, -1):
        places = [np.array([np.interp(t[k], path[:, 0], path[:, i]) for i in (1, 2, 3)]) for path in (rover, aircraft)]
        assert distance[k] == pytest.approx(np.linalg.norm(places[0] - places[1]))


def test_the_map_lies_in_the_world_and_is_scored(run):
    with recorded_run(run) as recorded:
        (burger,) = reported_maps(recorded)
        assert burger.name == "burger" and burger.score.walls.detections[1].f1 > 0.8
        assert [v.criterion.measure for v in recorded.verdicts] == [c.measure for c in recorded.site.mission.criteria]
        assert recorded.verdict == "FAILED"


def test_two_runs_are_compared_with_what_differed(run, tmp_path):
    other = tmp_path / "other"
    code, said = uvf("run", "demo", "--until", "6", "--set", "seed=7", "--log", _folder(other) / "log-000.mcap")
    assert code in (0, 1), said
    code, said = uvf("compare", run, other, "--out", tmp_path / "out")
    assert code == 0 and "distance_driven" in said, said
    page = Page(tmp_path / "out" / "compare.html")
    assert "+seed: 7" in page.text and "other" in page.text and len(page.loads) == 2
    assert uvf("compare", run)[0] == 2 and "from 2 to 10" in uvf("compare", run)[1]


def _folder(path):
    path.mkdir()
    return path


def written(path, samples):
    with Recorder(path) as recorder:
        for topic, message, t in samples:
            key = topic if isinstance(topic, str) else topic.at("rover")
            if "timestamp" in message.DESCRIPTOR.fields_by_name:
                message.timestamp.CopyFrom(stamp(t))
            recorder.write(Sample(key, message.DESCRIPTOR.full_name, message.SerializeToString(), round(t * 1e9), round(t * 1000) + 1, 0))
    return path


def drive(text="went well"):
    """Northwards at 0.5 m/s for 20 s, first backwards for 4 s; believed 0.3 m too far east, turned by 0.1 rad; two contacts."""
    north = Quaternion(w=np.cos(np.pi / 4), z=np.sin(np.pi / 4))
    for i in range(200):
        t = i / 10
        speed = -0.5 if t < 4.0 else 0.5
        y = 0.5 * (t - 8.0) if t >= 4.0 else -0.5 * t
        yield topics.TRUTH, NavState(position=Vector3(x=2.0, y=y), velocity=Vector3(y=speed), orientation=north), t
        yield topics.POSE, PoseInFrame(frame_id="world", pose=planar_pose(2.3, y, np.pi / 2 + 0.1)), t
        yield topics.CONTACT, Contact(touching=7.0 <= t < 8.0 or t >= 19.0, other="box"), t
        yield topics.STATUS, VehicleStatus(kind=Kind.KIND_GROUND), t
        state = NavStatus.REACHED if t >= 18.0 else NavStatus.DRIVING
        yield topics.NAV_STATUS, NavStatus(job="goal", state=state, goal=Vector3(x=2.0, y=5.0), recoveries=int(t >= 9.0), reason=text), t
    yield topics.EVENTS.by("planner"), Event(severity=Event.WARNING, text=text, cause=text), 19.9
    tasks = [TaskStatus(name=text, state=TaskStatus.FAILED, reason=text, since=12.0), TaskStatus(depth=1, kind="goal")]
    yield topics.TASKS.at("sys"), Tasks(tasks=tasks), 19.9


def test_the_figures_are_those_of_the_drive(tmp_path):
    with recorded_run(written(tmp_path / "log.mcap", drive())) as recorded:
        rover = recorded.vehicles["rover"]
        told = {figure.name: figure.value for figure in drive_figures(rover)}
    assert recorded.site is None and "no mission is attached" in recorded.note
    assert told["driven"] == "9.95 m" and told["driven backwards"] == "1.97 m"
    assert told["speed in motion"] == "0.50 m/s, largest 0.50"
    assert told["pose error"] == "RMS 0.300, largest 0.300, at the end 0.300 m"
    assert told["yaw error"] == "RMS 5.73, largest 5.73 deg"
    assert (told["goals reached, given up"], told["recoveries"], told["contacts"]) == ("1, 0", "1", "2")
    assert touches(rover) == pytest.approx([7.0, 19.0]) and pose_errors(rover)[2] == pytest.approx(0.1)


def test_poses_after_the_last_truth_have_no_error(tmp_path):
    later = [(topics.POSE, PoseInFrame(frame_id="world", pose=planar_pose(50.0, 0.0, 3.0)), t) for t in (20.1, 20.3)]
    with recorded_run(written(tmp_path / "log.mcap", [*drive(), *later])) as recorded:
        assert pose_errors(recorded.vehicles["rover"])[1] == pytest.approx(0.3)


def test_what_strangers_have_written_is_shown_as_text(tmp_path):
    refused = Event(text="\x1b[2J what no service takes, no report tells")
    written(tmp_path / "log-000.mcap", [*drive("<script>alert(1)</script>&amp;"), (topics.EVENTS.by("planner"), refused, 19.95)])
    code, said = uvf("report", tmp_path)
    assert code == 0 and "\x1b" not in said, said
    page = Page(tmp_path / "report" / "report.html")
    assert "script" not in page.tags and "<script>alert(1)</script>" in page.text and "&amp;" in page.text
    assert "\x1b" not in page.text and "what no service takes" not in page.text


def test_a_run_without_a_mission_says_so_and_is_reported_on(tmp_path):
    written(tmp_path / "log-000.mcap", drive())
    code, said = uvf("report", tmp_path, "--out", tmp_path / "out")
    assert code == 0 and "no mission is attached" in said.replace("\n", " ")
    assert (tmp_path / "out" / "rover.png").stat().st_size > 20_000
    assert uvf("compare", tmp_path, tmp_path, "--out", tmp_path / "both")[0] == 0


@pytest.mark.parametrize("kept", ["truth/state", "nav/pose", "sensor/contact", "state/vehicle", "nav/status", "state/events"])
@pytest.mark.parametrize("least", [1, 2, 1000])
def test_any_part_of_a_rovers_messages_gives_a_page(tmp_path, kept, least):
    samples = [each for each in drive() if (each[0] if isinstance(each[0], str) else each[0].at("rover")).startswith(f"uvf/rover/{kept}")]
    status = topics.STATUS, VehicleStatus(kind=Kind.KIND_GROUND), 0.05
    written(tmp_path / "log-000.mcap", [status, *samples[:least]])
    code, said = uvf("report", tmp_path)
    assert code == 0, said


def test_vehicles_that_have_only_drawn_a_map_are_reported_on(tmp_path):
    """Of a robot elsewhere, say: it has told neither where it was nor what it is."""
    grid = occupancy_grid(np.zeros((20, 30), dtype=np.int8), 0.05, 0.0, 0.0, "rover/map", 1.0)
    place = planar_frame(0.0, "world", "rover/map", Pose2(1.0, 2.0, 0.5))
    written(tmp_path / "log-000.mcap", [(topics.TF_WORLD, place, 0.0), (topics.MAP, grid, 1.0), (topics.TEAM_MAP, grid, 1.0)])
    code, said = uvf("report", tmp_path)
    assert code == 0, said
    assert "team of rover" in Page(tmp_path / "report" / "report.html").text


def test_names_and_events_are_no_formulas_and_no_markup(tmp_path):
    written(tmp_path / "log-000.mcap", drive("cost $x^$ high [/red]"))
    code, said = uvf("report", tmp_path)
    assert code == 0, said


def test_a_stranger_that_nobody_understood_is_no_vehicle(tmp_path):
    broken = Sample("uvf/ghost/nav/pose", "wrong", b"", 10**9, 1, 0)
    foreign = Sample("clock", "other.Clock", b"", 10**9, 1, 0)
    written(tmp_path / "log-000.mcap", drive())
    with recorded_run(tmp_path) as run:
        for sample in (broken, foreign):
            with contextlib.suppress(Malformed):
                run.take(sample, None)
        assert list(run.vehicles) == ["rover"]
