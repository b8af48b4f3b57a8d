"""``uvf flightgear``: shows an aircraft in FlightGear, which draws it and does not fly it."""

import socket
import time
from collections.abc import Callable
from contextlib import suppress
from typing import TypeVar

import numpy as np
from google.protobuf.message import Message

import uvf
from launch import settings
from launch.flightgear.fdm_packet import Seen, packet
from launch.running_mission import wanted_mission
from schemas import topics
from schemas.messages import Imu, JointStates, NavState
from schemas.topics import Topic
from uvf.client import Client
from uvf.maths.geodesy import GRAVITY, LocalTangent
from uvf.maths.rotations import enu_flu_from_ned_frd, inverse, rotate, to_euler
from uvf.models.scenario import Scenario, load_scenario
from uvf.models.vehicle.air import AirBody
from uvf.models.vehicle.surface_joints import deflection
from uvf.models.yaml_data import BadInput, nearest
from uvf.runtime.bus.address import peer
from uvf.runtime.messages.convert import array, wxyz

DEFAULT_TO = "127.0.0.1:5550"
FRD = np.array((1.0, -1.0, -1.0))  # of FLU
AT_REST = np.array((0.0, 0.0, -GRAVITY))  # m/s^2, FRD
RPM = 30 / np.pi
M = TypeVar("M", bound=Message)


class Feed:
    """Converts one aircraft's messages (ENU, FLU) into what FlightGear displays."""

    def __init__(self, body: AirBody, tangent: LocalTangent) -> None:
        self._tangent = tangent
        flap, aileron, rudder = body.controls.flap, body.controls.aileron, body.controls.rudder
        sides = {"left_flap": flap, "right_flap": flap, "left_aileron": aileron, "right_aileron": aileron}
        self._surfaces = {"elevator": body.controls.elevator, **sides, "left_rudder": rudder}

    def seen(self, truth: NavState, joints: JointStates | None, imu: Imu | None) -> Seen:
        """The state for FlightGear; without joints the surfaces are centred, without an IMU the specific force is 1 g upwards."""
        attitude, velocity = wxyz(truth.orientation), array(truth.velocity)
        latitude, longitude, altitude = self._tangent.geodetic(array(truth.position))
        body_from_world = inverse(attitude)
        told = list(joints.joints) if joints is not None else []
        angles = {joint.name: joint.position for joint in told}
        return Seen(
            latitude=latitude,
            longitude=longitude,
            altitude=altitude,
            height=truth.position.z,
            attitude=to_euler(enu_flu_from_ned_frd(attitude)),
            rates=array(truth.angular_velocity) * FRD,
            velocity=np.array((velocity[1], velocity[0], -velocity[2])),
            velocity_body=rotate(body_from_world, velocity) * FRD,
            through_air=rotate(body_from_world, velocity - array(truth.wind)) * FRD,
            specific_force=array(imu.specific_force) * FRD if imu is not None else AT_REST,
            rpm=max((abs(joint.velocity) for joint in told if joint.name.endswith("propeller")), default=0.0) * RPM,
            surfaces=tuple(surface.norm(deflection(name, angles)) for name, surface in self._surfaces.items()),
        )


def feed_of(site: Scenario, vehicle: str) -> Feed:
    """The feed of a mission's aircraft. Raises BadInput when there is no such aircraft."""
    bodies = {m.name: m.file.air for m in site.members.values() if m.file.air is not None}
    body = bodies.get(vehicle)
    if body is None:
        raise BadInput(f"{site.mission_path}: no aircraft '{vehicle}' there; {nearest(vehicle, bodies)}")
    origin = site.world.origin
    return Feed(body, LocalTangent.from_degrees(origin.latitude, origin.longitude, origin.altitude))


def newest(client: Client, vehicle: str, topic: Topic[M]) -> M | None:
    """The newest message of a vehicle on this topic; None before the first."""
    return client.read(vehicle, topic) if client.heard(vehicle, topic) else None


def show(client: Client, vehicle: str, feed: Feed, send: Callable[[bytes], object]) -> None:
    """Sends one packet, once the aircraft's true state has been heard."""
    truth = newest(client, vehicle, topics.TRUTH)
    joints, imu = newest(client, vehicle, topics.JOINTS), newest(client, vehicle, topics.IMU)
    if truth is not None:
        send(packet(feed.seen(truth, joints, imu)))


def flightgear(vehicle: str, to: str, hz: float, mission: str | None) -> None:
    """Sends ``hz`` packets a second [1/s] until Ctrl-C, from a port that accepts no input.

    mission: None for that of the running system. Raises BadInput.
    """
    place = peer(to, "--to", DEFAULT_TO)
    feed = feed_of(load_scenario(settings.mission_path(wanted_mission(mission))), vehicle)
    with uvf.connect() as client, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link, suppress(KeyboardInterrupt):
        try:
            link.connect(place)
        except OSError as error:
            raise BadInput(f"--to: nobody knows '{to}' ({error})") from error
        while True:
            with suppress(ConnectionRefusedError):  # FlightGear does not run yet, or any more
                show(client, vehicle, feed, link.send)
            time.sleep(1 / hz)
