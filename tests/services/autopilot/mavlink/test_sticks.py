"""RC_CHANNELS_OVERRIDE as sticks, who of several stations holds them, and what is told of the channels."""

import pytest

from schemas.messages import Mode
from tests.services.autopilot.mavlink.rig import CAR_FACTS, OTHER, PLANE, ROVER, Rig, of, texts
from uvf.mavlink import dialect as mav
from uvf.models.vehicle.air import CommandProperties

LIMITS = CommandProperties()  # the file of the rig's aircraft names none
UNCHANGED, RELEASED = 65535, 0


def channels(system, *us, high=()):
    """Channels from 1 on [us] and from 9 on; the others released, or not there."""
    return mav.MAVLink_rc_channels_override_message(system, 1, *us, *[RELEASED] * (8 - len(us)), *high)


def by_hand(**settings):
    rig = Rig(**settings)
    for vehicle in (rig.plane, rig.rover):
        vehicle.status.mode = Mode.MODE_MANUAL
    rig.run()
    return rig


def said(rig, message, output="surfaces", **sender):
    rig.say(message, **sender)
    rig.run(0.02)
    return next(iter(rig.outputs.get(output, {}).values()), None)


def test_channels_are_sticks_of_an_aircraft():
    rig = by_hand()
    full = said(rig, channels(PLANE, 2000, 1000, 1700, 1000))
    assert full.aileron == LIMITS.aileron.limit  # right
    assert full.elevator == LIMITS.elevator.limit  # low = stick forward: nose down
    assert full.rudder == LIMITS.rudder.limit  # left
    assert full.throttle == pytest.approx(0.7)
    centred = said(rig, channels(PLANE, 1500, 1500, 1000, 1500))
    assert (centred.aileron, centred.elevator, centred.rudder, centred.throttle) == (0.0, 0.0, 0.0, 0.0)


def test_channels_drive_a_rover_forwards_and_backwards():
    rig = by_hand()
    command = said(rig, channels(ROVER, RELEASED, RELEASED, 1250, 2000), "drive")
    assert (command.linear, command.angular) == (-0.25, -2.0)


def test_sticks_of_a_car_steer_it_and_turn_nothing_while_it_stands():
    rig = by_hand(rover=CAR_FACTS)
    radius = CAR_FACTS.file.ground.drive.kinematics.turning_radius
    right = said(rig, channels(ROVER, RELEASED, RELEASED, 2000, 2000), "drive")
    assert (right.linear, right.angular) == pytest.approx((0.5, -0.5 / radius))
    back = said(rig, channels(ROVER, RELEASED, RELEASED, 1250, 2000), "drive")
    assert (back.linear, back.angular) == pytest.approx((-0.25, 0.25 / radius))
    assert said(rig, channels(ROVER, RELEASED, RELEASED, 1500, 2000), "drive").angular == 0.0


def test_what_is_not_named_stays_and_what_is_released_is_centred():
    rig = by_hand()
    said(rig, channels(PLANE, 1800, 1500, 1500, 1500))
    assert said(rig, channels(PLANE, UNCHANGED, UNCHANGED, 1600, UNCHANGED)).aileron == pytest.approx(0.6 * LIMITS.aileron.limit)
    assert said(rig, channels(PLANE, RELEASED, UNCHANGED, UNCHANGED, UNCHANGED)).aileron == 0.0
    assert said(rig, channels(PLANE, UNCHANGED, UNCHANGED, RELEASED, UNCHANGED)) is None


def test_after_half_a_second_of_silence_all_are_released():
    rig = by_hand()
    said(rig, channels(PLANE, 1800, 1500, 1500, 1500))
    rig.run(0.6)
    assert said(rig, channels(PLANE, UNCHANGED, UNCHANGED, UNCHANGED, UNCHANGED)) is None


def test_the_channels_are_told_while_they_are_overridden():
    rig = by_hand()
    assert not of(rig.run(1.0), "RC_CHANNELS")
    for _ in range(60):
        rig.say(channels(PLANE, 1800, RELEASED, 1500, 1500, high=(1200, *[0] * 9)))
        rig.run(0.02)
        told = of(rig.heard(), "RC_CHANNELS", PLANE)
        if told:
            break
    assert (told[0].chan1_raw, told[0].chan2_raw, told[0].chan3_raw, told[0].chan9_raw) == (1800, UNCHANGED, 1500, 1200)
    assert (told[0].chancount, told[0].rssi) == (9, 255)
    rig.run(1.0)
    assert not of(rig.run(1.0), "RC_CHANNELS")


@pytest.mark.parametrize("mode", [Mode.MODE_HOLD, Mode.MODE_MISSION, Mode.MODE_RETURN])
def test_in_modes_that_fly_by_themselves_channels_mean_nothing(mode):
    rig = by_hand()
    rig.plane.status.mode = mode
    rig.run()
    assert said(rig, channels(PLANE, 2000, 2000, 2000, 2000)) is None
    assert not of(rig.run(1.0), "RC_CHANNELS")


def test_one_station_steers_until_it_is_silent():
    rig = by_hand()
    assert said(rig, channels(PLANE, 1600, 1500, 1500, 1500))
    stick = mav.MAVLink_manual_control_message(PLANE, 0, 900, 500, 0, 0)
    assert said(rig, stick, system=254, peer=OTHER) is None
    assert "Sticks ignored: station 255 steers" in texts(rig.heard(OTHER))
    assert said(rig, channels(PLANE, 1600, 1500, 1500, 1500))
    rig.run(1.1)
    assert said(rig, stick, system=254, peer=OTHER).aileron == pytest.approx(0.9 * LIMITS.aileron.limit)


def test_who_releases_all_channels_keeps_nobody_from_steering():
    rig = by_hand()
    stick = mav.MAVLink_manual_control_message(PLANE, 0, 900, 500, 0, 0)
    for step in range(60):
        if step % 10 == 0:
            rig.say(channels(PLANE), system=254, peer=OTHER)
        assert said(rig, stick) is not None
        assert not [text for text in texts(rig.heard()) if "Sticks ignored" in text]


@pytest.mark.parametrize("comes_with_sticks", [False, True])
def test_nobody_inherits_the_throttle_of_who_steered_before(comes_with_sticks):
    rig = by_hand()
    rig.rover.set("stick_timeout", 5.0)
    assert said(rig, channels(ROVER, 1500, 1500, 2000, 1500), "drive").linear > 0
    rig.run(1.1)
    if comes_with_sticks:
        assert said(rig, mav.MAVLink_manual_control_message(ROVER, 0, 0, 0, 0, 0), "drive", system=254, peer=OTHER).linear == 0
        rig.run(1.1)
    first = {"system": 254, "peer": OTHER} if not comes_with_sticks else {}
    assert said(rig, channels(ROVER, 1600, *[UNCHANGED] * 7), "drive", **first) is None
