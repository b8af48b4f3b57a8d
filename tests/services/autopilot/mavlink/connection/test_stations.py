"""Vehicles are told how many ground stations are in touch, by their heartbeats."""

import pytest

from schemas.messages import Clock
from tests.services.autopilot.mavlink.rig import OTHER, PLANE, Rig, of, texts
from uvf.mavlink import dialect as mav
from uvf.runtime.messages.convert import seconds


def heartbeat(kind):
    return mav.MAVLink_heartbeat_message(kind, mav.MAV_AUTOPILOT_INVALID, 0, 0, 0, 3)


def told(rig, duration):
    """The counts that were published meanwhile for the aircraft."""
    links = []
    for _ in range(round(duration / 0.02)):
        rig.run(0.02)
        links += [rig.outputs["link"]["plane"]] if "link" in rig.outputs else []
    return links


def test_stations_count_while_their_heartbeats_come():
    rig = Rig()
    assert {link.stations for link in told(rig, 2.0)} == {0}
    rig.say(heartbeat(mav.MAV_TYPE_GCS))
    rig.say(heartbeat(mav.MAV_TYPE_GCS), system=254, peer=OTHER)
    assert {link.stations for link in told(rig, 2.0)} == {2}
    rig.say(heartbeat(mav.MAV_TYPE_GCS))
    assert told(rig, 2.0)[-1].stations == 1
    assert told(rig, 3.0)[-1].stations == 0


def test_silence_is_wall_time_since_any_station_also_while_the_simulation_is_paused():
    rig = Rig()
    assert {link.silence for link in told(rig, 2.0)} == {0.0}
    rig.say(heartbeat(mav.MAV_TYPE_GCS))
    rig.run(0.5)
    rig.say(heartbeat(mav.MAV_TYPE_GCS), system=254, peer=OTHER)
    rig.clock.state, rig.clock.rate = Clock.PAUSED, 0.0
    assert [link.silence for link in told(rig, 4.0)] == pytest.approx([0.5 * n for n in range(8)], abs=0.52)
    rig.say(heartbeat(mav.MAV_TYPE_GCS))
    newest = told(rig, 0.5)[-1]
    assert newest.silence < 0.55 and newest.stations == 1


@pytest.mark.parametrize("rate", [0.2, 10.0])
def test_the_rate_of_the_simulation_goes_with_it(rate):
    rig = Rig()
    rig.clock.rate = rate
    assert told(rig, 1.0)[-1].rate == rate


def test_a_companion_is_no_ground_station():
    rig = Rig()
    rig.say(heartbeat(mav.MAV_TYPE_ONBOARD_CONTROLLER))
    assert {link.stations for link in told(rig, 1.0)} == {0}


def test_every_vehicle_is_told_twice_a_second_with_its_own_time():
    rig = Rig()
    links = told(rig, 4.0)
    assert len(links) == 8
    assert seconds(links[-1].timestamp) > seconds(links[0].timestamp)
    while "link" not in rig.outputs:
        rig.run(0.02)
    assert set(rig.outputs["link"]) == {"plane", "rover"}


def test_reasons_against_arming_are_said_to_the_ground_station():
    rig = Rig()
    rig.run(1.0)
    rig.plane.status.prearm.append("battery low: 5 %, 15 % are needed")
    assert "PreArm: battery low: 5 %, 15 % are needed" in texts(rig.run(1.0))


def test_a_reason_whose_figure_changes_is_said_once_and_none_while_armed():
    rig = Rig()
    rig.run(1.0)
    said = []
    for speed in range(30):
        rig.plane.status.prearm[:] = [f"it moves at {0.1 * speed:.1f} m/s over ground"]
        said += texts(rig.run(0.5))
    assert said == ["PreArm: it moves at 0.0 m/s over ground"]
    rig.plane.status.armed = True
    rig.plane.status.prearm[:] = ["airspeed reads 12 m/s at rest: look at the pitot tube"]
    heard = rig.run(2.0)
    assert texts(heard) == []
    assert of(heard, "SYS_STATUS", PLANE)[-1].onboard_control_sensors_health & mav.MAV_SYS_STATUS_PREARM_CHECK
