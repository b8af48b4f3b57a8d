"""Makes the air simulator from a mission: all its fixed-wing vehicles in one service."""

import numpy as np

from services.sim_air.actuators import Actuators
from services.sim_air.airframe import Airframe, Controls, Start
from services.sim_air.sensors import Gnss, Imu, Pressures
from services.sim_air.service import Aircraft, SimAir
from uvf.maths.geodesy import LocalTangent
from uvf.runtime.site import Host, Member, Site


def build(site: Site) -> list[Host]:
    if not any(site.of_kind("fixed_wing")):
        return []
    return [Host(SimAir, lambda: _make(site), writes_for=tuple(m.name for m in site.of_kind("fixed_wing")))]


def _make(site: Site) -> SimAir:
    return SimAir([_aircraft(site, member) for member in site.of_kind("fixed_wing")], np.array(site.world.wind.steady))


def _aircraft(site: Site, member: Member) -> Aircraft:
    """One aircraft in trimmed level flight at its start. Raises BadInput."""
    body, origin, begin = member.file.air, site.world.origin, member.entry.start
    assert body is not None
    tangent = LocalTangent.from_degrees(origin.latitude, origin.longitude, origin.altitude)
    airframe = Airframe(member.folder, body, tangent)
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
