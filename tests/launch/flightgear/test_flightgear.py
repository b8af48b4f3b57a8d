"""The packet, read by the offsets of FlightGear's structure and worked out a second way."""

import math
import socket
import struct

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from launch.flightgear.fdm_packet import SIZE, packet
from launch.flightgear.flightgear import feed_of, flightgear, show
from schemas import topics
from schemas.messages import Imu, JointState, JointStates, NavState
from uvf.maths.rotations import from_euler
from uvf.models.scenario import ROOT, load_scenario
from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.convert import quaternion, vector

SITE = load_scenario(ROOT / "missions" / "demo.yaml")
LIMITS = SITE.members["milvus"].file.air.controls
FT, KNOT = 0.3048, 0.514444

OFFSETS = {
    "longitude": (8, ">d"),
    "latitude": (16, ">d"),
    "altitude": (24, ">d"),
    "agl": (32, ">f"),
    "phi": (36, ">f"),
    "theta": (40, ">f"),
    "psi": (44, ">f"),
    "alpha": (48, ">f"),
    "beta": (52, ">f"),
    "phidot": (56, ">f"),
    "thetadot": (60, ">f"),
    "psidot": (64, ">f"),
    "vcas": (68, ">f"),
    "climb_rate": (72, ">f"),
    "v_north": (76, ">f"),
    "v_east": (80, ">f"),
    "v_down": (84, ">f"),
    "v_body_u": (88, ">f"),
    "v_body_w": (96, ">f"),
    "A_X_pilot": (100, ">f"),
    "A_Y_pilot": (104, ">f"),
    "A_Z_pilot": (108, ">f"),
    "num_engines": (120, ">I"),
    "eng_state": (124, ">I"),
    "rpm": (140, ">f"),
    "num_tanks": (284, ">I"),
    "num_wheels": (304, ">I"),
    "cur_time": (356, ">I"),
    "visibility": (364, ">f"),
    "elevator": (368, ">f"),
    "left_flap": (376, ">f"),
    "right_flap": (380, ">f"),
    "left_aileron": (384, ">f"),
    "right_aileron": (388, ">f"),
    "rudder": (392, ">f"),
}
"""Counted by hand through net_fdm.hxx: words of 4 bytes, three doubles from byte 8 on."""


class Packet:
    def __init__(self, data):
        self.data = data

    def __getattr__(self, name):
        offset, kind = OFFSETS[name]
        return struct.unpack_from(kind, self.data, offset)[0]


def flight(roll=0.0, pitch=0.0, heading=0.0, **fields):
    """Attitude as a pilot says it [rad]; the message's in ENU and FLU."""
    return NavState(orientation=quaternion(from_euler(roll, -pitch, math.pi / 2 - heading)), **fields)


def told(truth, joints=None, imu=None):
    return Packet(packet(feed_of(SITE, "milvus").seen(truth, joints, imu)))


def test_it_is_version_24_of_408_bytes():
    data = told(flight()).data
    assert (len(data), SIZE) == (408, 408)
    assert data[:8] == bytes((0, 0, 0, 24, 0, 0, 0, 0))


def test_the_place_is_that_of_the_worlds_origin_and_a_degree_north_is_111_km():
    origin = SITE.world.origin
    here, north = told(flight()), told(flight(position=vector(np.array((0.0, 1000.0, 60.0)))))
    assert math.degrees(here.latitude) == pytest.approx(origin.latitude, abs=1e-9)
    assert math.degrees(here.longitude) == pytest.approx(origin.longitude, abs=1e-9)
    assert here.altitude == pytest.approx(origin.altitude, abs=1e-3)
    assert math.degrees(north.latitude - here.latitude) * 111_050 == pytest.approx(1000.0, abs=2.0)
    assert north.altitude - here.altitude == pytest.approx(60.0, abs=0.1)
    assert north.agl == pytest.approx(60.0)


@pytest.mark.parametrize("angles", [(0.3, 0.1, 1.0), (-0.7, -0.2, 3.0), (0.0, 0.4, -1.5)])
def test_attitude_and_its_rates_are_the_pilots(angles):
    rates = np.array((0.2, -0.1, 0.3))  # FRD
    p = told(flight(*angles, angular_velocity=vector(rates * (1, -1, -1))))
    assert (p.phi, p.theta) == pytest.approx(angles[:2], abs=1e-6)
    assert math.remainder(p.psi - angles[2], math.tau) == pytest.approx(0.0, abs=1e-6)
    dt = 1e-5
    before = Rotation.from_euler("ZYX", angles[::-1])
    yaw, pitch, roll = (before * Rotation.from_rotvec(rates * dt)).as_euler("ZYX")
    change = [math.remainder(b - a, math.tau) / dt for a, b in zip(angles, (roll, pitch, yaw), strict=True)]
    assert (p.phidot, p.thetadot, p.psidot) == pytest.approx(change, abs=1e-4)


def test_speeds_are_in_feet_and_knots():
    p = told(flight(heading=math.pi / 2, velocity=vector(np.array((30.0, 2.0, 1.0))), wind=vector(np.array((5.0, 0.0, 0.0)))))
    assert (p.v_east * FT, p.v_north * FT, p.v_down * FT, p.climb_rate * FT) == pytest.approx((30.0, 2.0, -1.0, 1.0), abs=1e-4)
    assert (p.v_body_u * FT, p.v_body_w * FT) == pytest.approx((30.0, -1.0), abs=1e-4)
    through_air = math.sqrt(25.0**2 + 2.0**2 + 1.0)
    rho = (1 - 2.25577e-5 * SITE.world.origin.altitude) ** 4.2559  # relative density of the standard atmosphere
    assert p.vcas * KNOT == pytest.approx(through_air * math.sqrt(rho), rel=1e-4)
    assert p.alpha == pytest.approx(math.atan2(-1.0, 25.0), abs=1e-6)
    assert p.beta == pytest.approx(math.asin(-2.0 / through_air), abs=1e-6), "the air comes from the left of the nose"


def test_a_pilot_at_rest_feels_one_g_with_and_without_an_imu():
    imu = Imu(specific_force=vector(np.array((0.0, 0.0, 9.80665))))
    for p in (told(flight()), told(flight(), imu=imu)):
        assert (p.A_X_pilot, p.A_Y_pilot) == (0.0, 0.0)
        assert p.A_Z_pilot == pytest.approx(-32.174, abs=1e-3)


def test_surfaces_are_parts_of_their_way_and_a_right_rudder_is_positive():
    angles = {"elevator": LIMITS.elevator.limit, "left_aileron": 0.11, "right_aileron": -0.11, "left_flap": LIMITS.flap.limit / 2}
    states = [JointState(name=name, position=angle) for name, angle in angles.items()]
    states += [JointState(name="left_rudder", position=LIMITS.rudder.limit), JointState(name="propeller", velocity=2 * math.pi * 50)]
    p = told(flight(), JointStates(joints=states))
    assert p.elevator == pytest.approx(1.0)
    assert (p.left_aileron, p.right_aileron) == pytest.approx((0.11 / LIMITS.aileron.limit, -0.11 / LIMITS.aileron.limit))
    assert (p.left_flap, p.right_flap) == (pytest.approx(0.5), 0.0)
    assert p.rudder == pytest.approx(-1.0)
    assert (p.num_engines, p.eng_state, p.rpm) == (1, 2, pytest.approx(3000.0))


def test_of_several_propellers_the_fastest_is_told():
    states = [JointState(name=f"{side}_propeller", velocity=2 * math.pi * turns) for side, turns in (("left", 40.0), ("right", -50.0))]
    p = told(flight(), JointStates(joints=states))
    assert (p.eng_state, p.rpm) == (2, pytest.approx(3000.0))


def test_an_aircraft_that_stands_has_no_angle_of_attack():
    p = told(flight(velocity=vector(np.array((1e-9, 1e-8, 1e-8)))))
    assert (p.alpha, p.beta) == (0.0, 0.0)


def test_nothing_else_is_claimed():
    p = told(flight())
    assert (p.num_tanks, p.num_wheels, p.cur_time, p.eng_state, p.visibility) == (0, 0, 0, 0, 25_000.0)


class Bus:
    """A client that has heard some topics."""

    def __init__(self, **messages):
        self.messages = {topics.TOPICS[name].key: message for name, message in messages.items()}

    def heard(self, owner, topic):
        return int(topic.key in self.messages)

    def read(self, owner, topic):
        return self.messages[topic.key]


def test_a_packet_goes_out_over_udp_once_the_aircraft_is_heard():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as ear, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as mouth:
        ear.bind(("127.0.0.1", 0))
        ear.settimeout(5.0)
        mouth.connect(ear.getsockname())
        feed = feed_of(SITE, "milvus")
        show(Bus(IMU=Imu()), "milvus", feed, lambda data: pytest.fail("nothing is known yet"))
        show(Bus(TRUTH=flight(roll=0.5)), "milvus", feed, mouth.send)
        p = Packet(ear.recv(1000))
    assert p.phi == pytest.approx(0.5)


def test_what_is_no_aircraft_or_no_address_is_said_in_one_line():
    with pytest.raises(BadInput, match="no aircraft 'burger' there; there are: milvus"):
        feed_of(SITE, "burger")
    with pytest.raises(BadInput, match=r"--to: .here. is not host:port, as in 127\.0\.0\.1:5550"):
        flightgear("milvus", "here", 30.0, "demo")
