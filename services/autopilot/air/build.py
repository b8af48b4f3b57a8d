"""Makes an autopilot for each fixed-wing vehicle of a mission."""

import math

import numpy as np

from schemas.messages import MissionItem
from services.autopilot.air.config import AutopilotConfig
from services.autopilot.air.modes.airspeed import reserved
from services.autopilot.air.modes.follower import FormationLink
from services.autopilot.air.service import AutopilotAir, AutopilotWingman
from uvf.control.servos import ServoLimits, Servos
from uvf.estimation.ekf import datasheet
from uvf.estimation.estimators import Instruments
from uvf.guidance import flyable
from uvf.guidance.fence_plan import fence_fit, mission_fault
from uvf.guidance.formation_slot import FormationSlot
from uvf.guidance.route import Place
from uvf.guidance.runways import LandingStrip
from uvf.maths import rotations
from uvf.maths.geodesy import LocalTangent
from uvf.models.mission.formation import Follow, chain_of, offset_of
from uvf.models.scenario import MissionVehicle, Scenario
from uvf.models.vehicle.flight_params import AirParams
from uvf.models.vehicle.sensors import Mount
from uvf.models.world import file as world_file
from uvf.models.world.terrain import relief
from uvf.models.yaml_data import BadInput, FileLocation
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.messages.plans.fences import fence_message, fencing
from uvf.runtime.messages.plans.mission_files import item_from_file
from uvf.runtime.messages.plans.plan_items import plan_items

NEAREST = 1.0  # s behind a leader: what lies ahead of the follower has to be known


def hosts(site: Scenario) -> list[ServiceInstance]:
    """Raises BadInput when a job's mission is not one for an aircraft."""
    return [_host(site, member) for member in site.of_kind("fixed_wing")]


def _host(site: Scenario, member: MissionVehicle) -> ServiceInstance:
    origin = site.world.origin
    tangent = LocalTangent.from_degrees(origin.latitude, origin.longitude, origin.altitude)
    items = [item_from_file(w) for w in member.entry.job.mission]
    leads = any(m.entry.job.follow is not None and m.entry.job.follow.leader == member.name for m in site.members.values())
    params = member.params(AutopilotAir.name, AirParams)
    params = reserved(params) if leads else params
    if why := _fault(items, params):
        raise BadInput(f"{site.mission_path}: {member.name}: job: mission: {why}")
    start, land = member.entry.start, relief(site.world)
    ground = 0.0 if land is None else float(land.at(np.array(start.x), np.array(start.y))[0])
    config = AutopilotConfig(
        member.name,
        member.entry.system_id,
        tangent,
        _instruments(site, member),
        items,
        starts_in_air=start.z > 0 and not start.on_ground,
        ground=ground,
        strips=tuple(_strip(s) for s in site.world.strips),
        altimeter=_altimeter(member),
        servos=_servos(member),
        starts_armed=bool(member.entry.job.armed),
        leads=leads,
        fence=fence_message(member.entry.fence, f"{site.mission_path}: {member.name}: fence"),
    )
    if config.starts_in_air and member.entry.job.armed is False:
        place = FileLocation(str(site.mission_path)).at("vehicles", member.name, "job", "armed")
        raise BadInput(f"{place}: {member.name} starts in the air and is armed there; leave it out")
    if why := _fence_fault(config, Place(start.y, start.x, start.z), params):
        raise BadInput(f"{site.mission_path}: {member.name}: fence: {why}")
    if member.entry.job.follow is not None:
        return _wingman(site, config, params)
    return ServiceInstance(AutopilotAir, lambda: AutopilotAir(config, params), member.name)


def _instruments(site: Scenario, member: MissionVehicle) -> Instruments:
    east, north, up = site.world.magnetic_field
    sensors = member.file.sensors
    mount = sensors.imu.mount if sensors.imu is not None else Mount()
    return Instruments((north, east, -up), datasheet.read(sensors), mount.xyz, mount.rpy)


def _servos(member: MissionVehicle) -> Servos:
    body = member.file.air
    assert body is not None
    moved = (body.controls.aileron, body.controls.elevator, body.controls.rudder, body.controls.flap)
    return Servos(*(ServoLimits(surface.limit, surface.rate or body.servo_rate or math.inf, surface.negative_limit) for surface in moved))


def _strip(strip: world_file.Strip) -> LandingStrip:
    x, y, z = strip.centre
    return LandingStrip(Place(y, x, z), math.pi / 2 - strip.yaw, strip.length, strip.width)


def _altimeter(member: MissionVehicle) -> str:
    """The first range finder that looks down within 20 degrees."""
    for finder in member.file.sensors.rangefinders:
        if rotations.rotate(rotations.from_euler(*finder.mount.rpy), np.array((1.0, 0.0, 0.0)))[2] < -math.cos(math.radians(20.0)):
            return f"{member.name}/{finder.frame}"
    return ""


def _fence_fault(config: AutopilotConfig, here: Place, params: AirParams) -> str:
    """Why this aircraft cannot keep its fence; empty if it can."""
    fence = fencing(config.fence)
    fault = fence_fit(fence, here, config.starts_in_air, params)
    return fault or mission_fault(plan_items(config.items), fence, params)


def _fault(items: list[MissionItem], params: AirParams) -> str:
    """Why these items cannot be flown; empty if they can."""
    try:
        return flyable.fault(plan_items(items), params)
    except ValueError as error:
        return str(error)


def _wingman(site: Scenario, config: AutopilotConfig, params: AirParams) -> ServiceInstance:
    """Of an aircraft that follows. Raises BadInput for a station that cannot be kept."""
    follow = site.members[config.name].entry.job.follow
    assert follow is not None
    _check_follow(site, config.name, follow, params)
    station = FormationSlot(follow.behind, follow.right, follow.above)
    return ServiceInstance(
        AutopilotWingman, lambda: AutopilotWingman(config, params, FormationLink(config.name, follow.leader, station)), config.name
    )


def _check_follow(site: Scenario, name: str, follow: Follow, params: AirParams) -> None:
    """Raises BadInput for one that cannot be kept or is too near to another one."""
    place = FileLocation(str(site.mission_path)).at("vehicles", name, "job", "follow")
    if site.members[follow.leader].file.kind != "fixed_wing":
        raise BadInput(f"{place.at('leader')}: {follow.leader} is no aircraft; only aircraft are followed")
    if follow.behind < NEAREST * params.trim_airspeed:
        least = NEAREST * params.trim_airspeed
        raise BadInput(f"{place.at('behind')}: {follow.behind:g} m is too near behind {follow.leader}; give {least:g} m or more")
    follows = {n: m.entry.job.follow for n, m in site.members.items() if m.entry.job.follow is not None}
    own = offset_of(name, follows)
    first = chain_of(name, follows)[-1]
    for other in site.members:
        if other != name and first in (other, *chain_of(other, follows)):
            apart = math.dist(own, offset_of(other, follows))
            if apart < params.follow_sep:
                raise BadInput(f"{place}: {apart:.1f} m from {other}; stations of a formation are {params.follow_sep:g} m apart or more")
