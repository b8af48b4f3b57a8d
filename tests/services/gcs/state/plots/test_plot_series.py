"""Numbers are found in messages, taken out, and kept for ten minutes."""

import numpy as np
import pytest

from schemas import topics
from schemas.messages import Imu, JointState, JointStates, NavState, Quaternion, Vector3, VehicleStatus
from services.gcs.state.plots.plot_fields import plot_fields, repeated_fields, value_at
from services.gcs.state.plots.plot_series import GAP, LONGEST, PlotBook, PlotSeries, SeriesName, unit_of
from services.gcs.watch import WatchedMessage
from uvf.maths.rotations import from_euler

KEY = topics.NAV_STATE.at("milvus")


def heard(message, stamp, key=KEY):
    return WatchedMessage(key, message.DESCRIPTOR.full_name, message.SerializeToString(), 0.0, 1, stamp)


def test_every_number_has_a_path_and_a_unit():
    found = {one.path: one.unit for one in plot_fields(NavState.DESCRIPTOR)}
    assert found["airspeed"] == "m/s" and found["position.x"] == "m" and found["wind.norm"] == "m/s"
    assert found["orientation.roll"] == "deg" and "timestamp.seconds" not in found
    assert {"mode", "armed", "throttle"} <= {one.path for one in plot_fields(VehicleStatus.DESCRIPTOR)}


def test_repeated_ones_are_called_by_their_names():
    joints = JointStates(joints=[JointState(name="left_wheel", position=1.5), JointState(name="right_wheel", position=2.5)])
    assert "joints[left_wheel].position" in {one.path for one in repeated_fields(joints)}
    assert value_at(joints, "joints[right_wheel].position") == 2.5


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("airspeed", 24.0),
        ("position.z", 3.0),
        ("position.norm", 5.0),
        ("orientation.yaw", 30.0),
        ("nothing", None),
        ("position", None),
        ("position.x.y", None),
        ("position[0]", None),
        ("orientation.roll.x", None),
        ("", None),
        ("__class__", None),
        ("timestamp.seconds.x[9].y", None),
    ],
)
def test_a_value_is_found_by_its_path_or_is_none(path, value):
    w, x, y, z = from_euler(0.0, 0.0, np.radians(30.0))
    state = NavState(airspeed=24.0, position=Vector3(x=0.0, y=4.0, z=3.0), orientation=Quaternion(w=w, x=x, y=y, z=z))
    assert value_at(state, path) == (pytest.approx(value) if value is not None else None)


def test_a_series_keeps_the_last_ten_minutes_in_bounded_memory():
    series = PlotSeries()
    for i in range(150_000):
        series.add(i * 0.01, float(i))
    t, values = series.since(1500.0 - LONGEST)
    assert values[-1] == series.newest == 149_999.0 and t[0] <= 1500.0 - LONGEST + 250.0
    assert (np.diff(t) >= 0).all() and len(series._t) < 140_000


def test_a_pause_breaks_the_line_and_a_new_beginning_forgets():
    series = PlotSeries()
    for t in (1.0, 1.1, 1.1 + 2 * GAP, 3.2):
        series.add(t, 7.0)
    assert np.isnan(series.since(0.0)[1]).sum() == 1
    series.add(0.1, 8.0)
    assert series.since(0.0)[0].tolist() == [0.1]


def test_only_what_somebody_plots_is_kept():
    book, name = PlotBook(), SeriesName(KEY, "airspeed")
    book.keep({name}, frozenset())
    book.hear([heard(NavState(airspeed=24.0), 1.0), heard(Imu(), 1.0, topics.IMU.at("milvus"))])
    assert book.series[name].newest == 24.0 and book.samples == {}
    book.keep(set(), {KEY})
    book.hear([heard(NavState(airspeed=25.0), 2.0)])
    assert book.series == {} and set(book.samples) == {KEY}


def test_broken_and_unknown_messages_are_counted_and_end_nothing():
    book = PlotBook()
    book.keep({SeriesName(KEY, "airspeed"), SeriesName("uvf/x/y/z", "a")}, frozenset())
    broken = [WatchedMessage(KEY, "x", b"\xff\xff\xff", 0.0, 1, 1.0), WatchedMessage("uvf/x/y/z", "x", b"", 0.0, 1, 1.0)]
    book.hear([*broken, heard(NavState(airspeed=24.0), 2.0)])
    assert book.refused == 1 and book.series[SeriesName(KEY, "airspeed")].newest == 24.0


def test_a_series_has_the_unit_of_its_field():
    assert unit_of(SeriesName(KEY, "orientation.roll")) == "deg" and unit_of(SeriesName(KEY, "airspeed")) == "m/s"
    assert unit_of(SeriesName("uvf/nobody/knows", "x")) == ""
