"""A mission's list of faults spoils exactly what it names, for as long as it says."""

import math

import msgspec
import pytest

from schemas.messages import AirData, Battery, Gnss, Imu, LaserScan, SurfaceCommand, Vector3
from uvf.models.mission.faults import Fault, check_faults, check_parts
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle
from uvf.models.yaml_data import BadInput, FileLocation
from uvf.runtime.messages.convert import seconds, stamp
from uvf.runtime.messages.readings.faults import PARTS, Faults

HERE = FileLocation("mission.yaml")
SAID = {
    "imu": lambda t: Imu(angular_velocity=Vector3(x=0.1 + t), specific_force=Vector3(z=9.8), magnetic_field=Vector3(x=2e-5 + t)),
    "gnss": lambda t: Gnss(fix=Gnss.FIX_3D, latitude=0.7 + t),
    "air_data": lambda t: AirData(static_pressure=98000.0 + t, differential_pressure=380.0 + t),
    "battery": lambda t: Battery(remaining=0.9 - t / 100),
    "scan": lambda t: LaserScan(ranges=[1.0 + t]),
    "surfaces": lambda t: SurfaceCommand(aileron=0.1 + t, elevator=-0.1 - t, rudder=0.2 + t, throttle=0.5 + t),
}


def said(t):
    messages = {name: make(t) for name, make in SAID.items()}
    for message in messages.values():
        message.timestamp.CopyFrom(stamp(t))
    return messages


def changed(read, t):
    return {name for name, message in said(t).items() if read.get(name) != message}


@pytest.mark.parametrize("part", [p for p in PARTS if PARTS[p].output in SAID])
@pytest.mark.parametrize("kind", ["lost", "frozen"])
def test_only_the_part_that_is_named_fails_and_only_then(part, kind):
    faults = Faults([Fault("one", part, kind, at=2.0, until=4.0)])
    for t in (0.0, 1.0):
        assert changed(faults.spoil(t, "one", said(t)), t) == set()
    for t in (2.0, 3.0):
        assert changed(faults.spoil(t, "other", said(t)), t) == set()
        spoilt = changed(faults.spoil(t, "one", said(t)), t)
        assert spoilt == {PARTS[part].output}
    assert changed(faults.spoil(4.0, "one", said(4.0)), 4.0) == set()


def test_what_is_lost_as_a_whole_does_not_come_and_a_part_of_a_message_reads_zero():
    assert "gnss" not in Faults([Fault("one", "gnss", "lost", at=0.0)]).spoil(0.0, "one", said(0.0))
    air = Faults([Fault("one", "pitot", "lost", at=0.0)]).spoil(0.0, "one", said(0.0))["air_data"]
    assert (air.differential_pressure, air.static_pressure) == (0.0, 98000.0)


def test_a_frozen_receiver_says_the_same_with_new_stamps():
    faults = Faults([Fault("one", "gnss", "frozen", at=2.0)])
    faults.spoil(1.0, "one", said(1.0))
    late = faults.spoil(5.0, "one", said(5.0))["gnss"]
    assert late.latitude == pytest.approx(1.7)
    assert seconds(late.timestamp) == 5.0


@pytest.mark.parametrize(("part", "output"), [("imu", "imu"), ("other_scans", "other_scans")])
def test_several_messages_of_a_step_fail_together_each_sensor_for_itself(part, output):
    """As of an IMU that is quicker than the steps, or of two lidars."""

    def step(t):
        if output == "imu":
            return {output: [Imu(timestamp=stamp(s), angular_velocity=Vector3(x=s)) for s in (t, t + 0.005)]}
        return {output: [LaserScan(timestamp=stamp(t), frame_id=name, ranges=[near + t]) for name, near in (("v/a", 1.0), ("v/b", 5.0))]}

    lost, frozen = (Faults([Fault("one", part, kind, at=2.0, until=4.0)]) for kind in ("lost", "frozen"))
    assert lost.spoil(1.0, "one", step(1.0)) == step(1.0) == frozen.spoil(1.0, "one", step(1.0))
    assert lost.spoil(3.0, "one", step(3.0)) == {}
    held = frozen.spoil(3.0, "one", step(3.0))[output]
    if output == "imu":
        assert [m.angular_velocity.x for m in held] == [1.005, 1.005]
    else:
        assert [list(m.ranges) for m in held] == [[2.0], [6.0]]
    assert [seconds(m.timestamp) for m in held] == [seconds(m.timestamp) for m in step(3.0)[output]]
    assert frozen.spoil(4.0, "one", step(4.0)) == step(4.0)


def test_a_bias_is_added_in_its_unit():
    air = Faults([Fault("one", "pitot", "bias", at=0.0, size=-50.0)]).spoil(1.0, "one", said(1.0))["air_data"]
    assert air.differential_pressure == pytest.approx(331.0)
    north = Faults([Fault("one", "gnss", "bias", at=0.0, size=100.0)]).spoil(1.0, "one", said(1.0))["gnss"].latitude - 1.7
    assert north * 6.371e6 == pytest.approx(100.0)


@pytest.mark.parametrize(
    ("fault", "why"),
    [
        (Fault("two", "gnss", "lost", at=1.0), "no vehicle 'two'"),
        (Fault("one", "gnss", "lost", at=1.0, until=1.0), "is not after at"),
        (Fault("one", "gnss", "lost", at=100.0), "100 s is after the end, 100 s"),
        (Fault("one", "scan", "bias", at=1.0, size=1.0), "takes no bias"),
        (Fault("one", "link", "frozen", at=1.0), "a link may be lost"),
        (Fault("one", "pitot", "bias", at=1.0), "needs a size"),
        (Fault("one", "left_grip", "frozen", at=1.0), "may be lost, or have a bias from -1 to 0"),
        (Fault("one", "left_grip", "bias", at=1.0, size=-1.5), "may be lost, or have a bias from -1 to 0"),
        (Fault("one", "right_grip", "bias", at=1.0), "needs a size"),
    ],
)
def test_a_list_that_makes_no_sense_is_refused(fault, why):
    with pytest.raises(BadInput, match=why):
        check_faults([fault], {"one": None}, 100.0, HERE)


def test_for_good_means_for_good():
    assert Fault("one", "gnss", "lost", at=1.0).holds(math.inf)


def test_a_wheel_has_the_grip_that_its_faults_leave_it():
    faults = Faults([Fault("one", "left_grip", "bias", at=2.0, until=4.0, size=-0.75), Fault("one", "right_grip", "lost", at=3.0)])
    assert [faults.grip(t, "one") for t in (1.0, 2.0, 3.0, 4.0)] == [(1.0, 1.0), (0.25, 1.0), (0.25, 0.0), (1.0, 0.0)]
    assert faults.grip(3.0, "other") == (1.0, 1.0)
    assert changed(faults.spoil(3.0, "one", said(3.0)), 3.0) == set()


@pytest.mark.parametrize(
    ("model", "part", "why"),
    [
        ("mybot05", "aileron", "it is a ground vehicle"),
        ("mybot05", "pitot", "it is a ground vehicle"),
        ("milvus", "wheels", "it is a fixed_wing vehicle"),
        ("milvus", "left_grip", "it is a fixed_wing vehicle"),
        ("milvus", "scan", "there is no lidar among the sensors"),
        ("burger", "other_scans", "there is no other_lidars among the sensors"),
    ],
)
def test_a_part_that_a_vehicle_does_not_have_is_refused(model, part, why):
    with pytest.raises(BadInput, match=f"part: one has no {part}.*{why}"):
        check_parts([Fault("one", part, "lost", at=1.0)], {"one": load_vehicle(ROOT / "vehicles", model)}, HERE)


def test_without_a_battery_none_can_fail():
    whole = load_vehicle(ROOT / "vehicles", "mybot05")
    without = msgspec.structs.replace(whole, ground=msgspec.structs.replace(whole.ground, battery=None))
    fault = Fault("one", "battery", "lost", at=1.0)
    check_parts([fault], {"one": whole}, HERE)
    with pytest.raises(BadInput, match="one has no battery; give its"):
        check_parts([fault], {"one": without}, HERE)
