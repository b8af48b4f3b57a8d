"""``uvf report``: the figures of a flight are those of its messages, and every log of an aircraft gives a page."""

import shutil

import numpy as np
import pytest
from typer.testing import CliRunner

from launch.attachments import attachments
from launch.cli import app
from launch.reports.flight_figures import deviation, figures
from launch.reports.recorded_run import recorded_run
from schemas import topics
from schemas.messages import Battery, Kind, Mode, NavState, Quaternion, SurfaceCommand, Vector3, VehicleStatus
from services.autopilot.air import build as autopilot
from services.sim_air import build as sim_air
from uvf.models.scenario import ROOT, load_scenario
from uvf.runtime.bus.interface import Sample
from uvf.runtime.log.reading import read_log
from uvf.runtime.log.recording import Recorder
from uvf.runtime.messages.convert import stamp
from uvf.runtime.time.lockstep import Lockstep


def sample(topic, message, t):
    message.timestamp.CopyFrom(stamp(t))
    key = topic.by("autopilot").at("kite")
    return Sample(key, message.DESCRIPTOR.full_name, message.SerializeToString(), round(t * 1e9), round(t * 1000) + 1, 0)


def state(x, y, truth):
    """Northwards at 20 m/s, banked by 0.1 rad; the truth is 3 m further east."""
    turned = Quaternion(w=np.cos(np.pi / 4), z=np.sin(np.pi / 4))
    return NavState(
        position=Vector3(x=x + 3.0 * truth, y=y, z=50.0), velocity=Vector3(y=20.0), orientation=turned, airspeed=22.0, wind=Vector3(y=-2.0)
    )


def straight_flight(seconds=100):
    for i in range(seconds * 10):
        t = i / 10
        yield sample(topics.TRUTH, state(0.0, 20 * t, True), t)
        yield sample(topics.NAV_STATE, state(0.0, 20 * t, False), t)
        status = VehicleStatus(kind=Kind.KIND_FIXED_WING, mode=Mode.MODE_MISSION, cross_track=1.0, altitude_error=-2.0)
        yield sample(topics.STATUS, status, t)
        yield sample(topics.SURFACE_COMMAND, SurfaceCommand(aileron=0.1 * (i % 2), throttle=0.5), t)
        yield sample(topics.BATTERY, Battery(voltage=40.0, current=9.0, remaining=1.0 - t / 1000), t)


def write(path, samples):
    with Recorder(path) as recorder:
        for each in samples:
            recorder.write(each)
            if recorder.written % 500 == 0:
                recorder.flush()
    return path


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return write(tmp_path_factory.mktemp("made") / "log-000.mcap", straight_flight())


PAGES = {"kite.png", "report.html", "all-ways.png"}


def kite_of(log):
    with recorded_run(log) as run:
        return run.vehicles["kite"]


def value(history, name):
    return next(f.value for f in figures(history) if f.name == name)


def test_the_figures_are_those_of_the_flight(made):
    kite = kite_of(made)
    assert value(kite, "over ground") == "2.00 km"
    assert value(kite, "through the air") == "2.20 km"
    assert value(kite, "airspeed") == "22.00 m/s, sd 0.00, 22.0 to 22.0"
    assert value(kite, "cross-track, as known") == "RMS 1.00, 95 % 1.00, max 1.00 m"
    assert value(kite, "height off the wanted") == "RMS 2.00, 95 % 2.00, max 2.00 m"
    assert value(kite, "energy") == "10.0 Wh, 360 W on average"
    assert value(kite, "energy per km") == "5.00 Wh"
    assert value(kite, "battery") == "100.0 to 90.0 %"
    assert value(kite, "way of aileron, elevator, rudder") == "57.3, 0.0, 0.0 deg/s"
    assert value(kite, "estimate: horizontal, height") == "3.00, 0.00 m RMS"


def test_the_true_cross_track_holds_the_error_of_the_estimate(made):
    off = deviation(kite_of(made))
    assert off.true_cross_track == pytest.approx(np.full(len(off.t), 1.0 + 3.0), abs=1e-6)
    assert off.wanted == pytest.approx(np.full(len(off.t), 52.0))


def test_a_flight_without_truth_is_reported_on_by_its_estimate(made, tmp_path):
    log = write(tmp_path / "log.mcap", (s for s in read_log(made) if "/truth/" not in s.key))
    kite = kite_of(log)
    assert value(kite, "over ground") == "2.00 km"
    assert not any(f.name.startswith(("estimate", "cross-track, truth")) for f in figures(kite))
    assert reported(log) == PAGES


def test_a_log_that_was_cut_off_is_reported_on_as_far_as_it_goes(made, tmp_path):
    whole, log = made.read_bytes(), tmp_path / "log-000.mcap"
    log.write_bytes(whole[: len(whole) * 2 // 3])
    assert 10 < kite_of(log).estimate.t[-1] < 99
    assert reported(tmp_path) == PAGES


def test_what_is_sent_often_is_thinned_out_and_peaks_stay_on_the_page(made):
    kite = kite_of(made)
    assert len(kite.estimate.t) == 1000
    kite.heard("nav/state", sample(topics.NAV_STATE, state(0, 0, False), 99.95))
    assert len(kite.estimate.t) == 1000


@pytest.mark.parametrize("kept", ["state/vehicle", "nav/state", "truth/state", "actuator/surfaces"])
def test_any_part_of_an_aircrafts_messages_gives_a_page(made, tmp_path, kept):
    command = sample(topics.SURFACE_COMMAND, SurfaceCommand(), 0.0)
    log = write(tmp_path / "log.mcap", [command, *(s for s in read_log(made) if s.key.endswith(kept))])
    assert reported(log) == PAGES


def reported(run):
    done = CliRunner().invoke(app, ["report", str(run)])
    assert done.exit_code == 0, done.output
    folder = (run if run.is_dir() else run.parent) / "report"
    assert (folder / "kite.png").stat().st_size > 20_000
    return {p.name for p in folder.iterdir()}


def test_a_recorded_run_of_the_demo_is_reported_on(tmp_path):
    site = load_scenario(ROOT / "missions" / "demo.yaml")
    lockstep = Lockstep([*sim_air.build(site), *autopilot.hosts(site)])
    with Recorder(tmp_path / "log-000.mcap", attachments(site)) as recorder:
        recorder.follow(lockstep.bus)
        lockstep.run(12.0)
    lockstep.close()
    done = CliRunner().invoke(app, ["report", str(tmp_path), "--out", str(tmp_path / "out")])
    assert done.exit_code == 0, done.output
    text = (tmp_path / "out" / "report.html").read_text()
    assert ">milvus</h2>" in text and "<td>in the air</td><td>12 s</td>" in text and "burger</h2>" not in text
    assert (tmp_path / "out" / "milvus.png").stat().st_size > 50_000


def test_the_files_of_a_run_are_one_flight(made, tmp_path):
    halves = {"log-000.mcap": lambda t: t < 50, "log-001.mcap": lambda t: t >= 50}
    for name, within in halves.items():
        write(tmp_path / name, (s for s in read_log(made) if within(s.stamp_ns / 1e9)))
    assert value(kite_of(tmp_path), "over ground") == "2.00 km"


def test_bad_input_is_one_line(made, tmp_path):
    (tmp_path / "empty").mkdir()
    nobody = write(tmp_path / "nobody.mcap", [])
    (tmp_path / "file").write_text("")
    for arguments, said in (
        ([str(tmp_path / "empty")], "no log-*.mcap"),
        ([str(tmp_path / "none.mcap")], "no run"),
        ([str(nobody)], "no vehicle"),
        ([str(shutil.copy(made, tmp_path / "log.mcap")), "--out", str(tmp_path / "file" / "x")], "--out"),
    ):
        done = CliRunner().invoke(app, ["report", *arguments])
        assert done.exit_code == 2 and said in done.output.replace("\n", ""), done.output


def test_what_strangers_have_put_into_the_log_does_not_end_the_report(tmp_path):
    good = list(straight_flight(20))
    broken = [s._replace(payload=b"\xff") for s in good[:5]] + [s._replace(type_name="nonsense") for s in good[:5]]
    stray = [good[0]._replace(key=key) for key in ("uvf/kite", "uvf/kite/", "uvf//nav/state")]
    log = write(tmp_path / "a.mcap", [*good, *broken, *stray])
    clean = write(tmp_path / "b.mcap", good)
    with recorded_run(log) as run:
        assert list(run.vehicles) == ["kite"]
    assert figures(kite_of(log)) == figures(kite_of(clean))
