"""Makes the air simulator from a mission: all its fixed-wing vehicles in one service."""

from pathlib import Path

import numpy as np

from services.sim_air.actuators import Actuators
from services.sim_air.airframe import Airframe, Controls, Start
from services.sim_air.sensors import Gnss, Imu, Pressures
from services.sim_air.service import Aircraft, SimAir
from uvf.maths.geodesy import LocalTangent
from uvf.runtime.params import BadInput, Place
from uvf.runtime.site import AIRCRAFT_RADIUS, Host, Member, Site
from uvf.runtime.vehicle_file import AirBody
from uvf.runtime.vehicle_layers import folders_of, holding
from uvf.runtime.world_geometry import clearance


def build(site: Site) -> list[Host]:
    """Nothing when the mission has no aircraft. Raises BadInput."""
    if not any(site.of_kind("fixed_wing")):
        return []
    for member in site.of_kind("fixed_wing"):
        _check(site, member)
    return [Host(SimAir, lambda: _make(site), writes_for=tuple(m.name for m in site.of_kind("fixed_wing")))]


def _check(site: Site, member: Member) -> None:
    """What would otherwise fail only when time runs, or not be noticed at all."""
    place = Place(str(member.folder / "vehicle.yaml"))
    sensors = member.file.sensors
    for kind, sensor in {"imu": sensors.imu, "gnss": sensors.gnss, "air_data": sensors.air_data}.items():
        if sensor is not None and sensor.hz > SimAir.hz:
            raise BadInput(f"{place.at('sensors', kind, 'hz')}: {sensor.hz:g} Hz; the simulator gives {SimAir.hz:g} Hz at most")
    start = member.entry.start
    room = clearance(site.world, start.x, start.y, (start.z - AIRCRAFT_RADIUS, start.z + AIRCRAFT_RADIUS))
    if room < AIRCRAFT_RADIUS:
        where = Place(str(site.mission_path)).at("vehicles", member.name, "start")
        raise BadInput(f"{where}: {room:.2f} m from a wall or another solid at {start.z:g} m; move it or begin higher")
    Airframe(_model_folder(member), _body(member), _tangent(site))


def _body(member: Member) -> AirBody:
    body = member.file.air
    assert body is not None
    return body


def _model_folder(member: Member) -> Path:
    """A variant flies the model of the vehicle it is made of unless it has one itself."""
    return holding(folders_of(member.folder), _body(member).model)


def _tangent(site: Site) -> LocalTangent:
    origin = site.world.origin
    return LocalTangent.from_degrees(origin.latitude, origin.longitude, origin.altitude)


def _make(site: Site) -> SimAir:
    return SimAir([_aircraft(site, member) for member in site.of_kind("fixed_wing")], np.array(site.world.wind.steady))


def _aircraft(site: Site, member: Member) -> Aircraft:
    """One aircraft in trimmed level flight at its start. Raises BadInput."""
    body, tangent, begin = _body(member), _tangent(site), member.entry.start
    airframe = Airframe(_model_folder(member), body, tangent)
    position = np.array((begin.x, begin.y, begin.z))
    trim = airframe.start(Start(position, begin.yaw, begin.speed or body.trim_speed, np.array(site.world.wind.steady)))
    at_start = Controls(trim.aileron, trim.elevator, trim.rudder, trim.throttle)
    aircraft = Aircraft(member.name, member.file, airframe, Actuators(at_start, body))
    fitted = member.file.sensors
    if fitted.imu is not None:
        aircraft.imu = Imu(fitted.imu, np.array(site.world.magnetic_field), site.rng(member.name, "imu"))
    if fitted.gnss is not None:
        aircraft.gnss = Gnss(fitted.gnss, tangent, site.rng(member.name, "gnss"))
    if fitted.air_data is not None:
        aircraft.pressures = Pressures(fitted.air_data, site.rng(member.name, "air_data"))
    return aircraft
