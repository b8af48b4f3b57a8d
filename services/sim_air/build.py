"""Makes the air simulator from a mission: all its fixed-wing vehicles in one service."""

from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from services.sim_air.actuators import Actuators
from services.sim_air.aircraft import Aircraft
from services.sim_air.contact.crash import Resting
from services.sim_air.contact.surroundings import Around
from services.sim_air.engine.airframe import Airframe, fly_one_step
from services.sim_air.engine.beginning import as_told, begun
from services.sim_air.engine.wiring import Controls
from services.sim_air.environment.ground import GroundSurface
from services.sim_air.environment.wind import AirMass
from services.sim_air.environment.windsocks import Windsocks
from services.sim_air.launcher import AircraftLauncher, standard_air
from services.sim_air.rangers import Rangers
from services.sim_air.sensors import Gnss, Imu, PressureSensors
from services.sim_air.service import SimAir
from services.sim_air.stage import AirStage, JoiningAircraft
from uvf.maths.bvh import Bvh
from uvf.maths.geodesy import LocalTangent
from uvf.maths.raycast import warm_up
from uvf.models.aircraft.shape import aircraft_shape
from uvf.models.mission.file import StartPose, Vehicle
from uvf.models.scenario import AIRCRAFT_RADIUS, MissionVehicle, Scenario
from uvf.models.shapes.scene import scene
from uvf.models.urdf.model import load_urdf
from uvf.models.vehicle.air import AirBody
from uvf.models.vehicle.battery import Charge
from uvf.models.vehicle.file import load_vehicle
from uvf.models.vehicle.layers import folders_of, holding
from uvf.models.world.footing import Footing
from uvf.models.world.geometry import GRAZE, solids
from uvf.models.yaml_data import BadInput, FileLocation
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.messages.readings.faults import Faults
from uvf.runtime.process.subprocess_jobs import Died, run_in_subprocess
from uvf.sensors.surroundings import aircraft_tree, vehicle_tree


def build(site: Scenario) -> list[ServiceInstance]:
    """The service of the mission's aircraft; empty when there are none. Raises BadInput."""
    if not any(site.of_kind("fixed_wing")):
        return []
    warm_up()
    land = Land(Footing(site.world), GroundSurface(scene(solids(site.world))))
    for member in site.of_kind("fixed_wing"):
        _check(site, member, land)
    return [ServiceInstance(SimAir, lambda: _make(site, land), writes_for=tuple(m.name for m in site.of_kind("fixed_wing")))]


class Land(NamedTuple):
    """The ground and the obstacles that aircraft begin on and beside."""

    footing: Footing
    ground: GroundSurface

    def check_room(self, who: str, start: StartPose) -> None:
        """Raises BadInput with too little room beside an aircraft at its start; what it stands on does not count."""
        if (room := self._room(start)) < AIRCRAFT_RADIUS:
            raise BadInput(f"{who}: {room:.2f} m from a wall or another solid at {start.z:g} m; move it or begin higher")

    def _room(self, start: StartPose) -> float:
        """m."""
        height = self.ground.top(start.x, start.y)
        low, high = max(start.z - AIRCRAFT_RADIUS, GRAZE), start.z + AIRCRAFT_RADIUS
        return self.footing.room(start.x, start.y, (height + low, height + high))


def _check(site: Scenario, member: MissionVehicle, land: Land) -> None:
    """What would otherwise fail only when time runs, or not be noticed at all."""
    _check_rates(member)
    land.check_room(str(FileLocation(str(site.mission_path)).at("vehicles", member.name, "start")), member.entry.start)
    origin = site.world.origin
    try:
        run_in_subprocess(fly_one_step, str(_model_folder(member)), _body(member), (origin.latitude, origin.longitude, origin.altitude))
    except Died as error:
        where = FileLocation(str(member.folder / "vehicle.yaml"))
        raise BadInput(f"{where.at('air', 'model')}: JSBSim ends the process with this model ({error}); 'uvf vehicle check' it") from error


def _check_rates(member: MissionVehicle) -> None:
    place = FileLocation(str(member.folder / "vehicle.yaml"))
    sensors = member.file.sensors
    single = {(kind,): getattr(sensors, kind) for kind in ("imu", "gnss", "air_data", "lidar")}
    several = {(kind, i): sensor for kind in ("sonars", "rangefinders") for i, sensor in enumerate(getattr(sensors, kind))}
    for keys, sensor in (single | several).items():
        if sensor is not None and sensor.hz > SimAir.hz:
            raise BadInput(f"{place.at('sensors', *keys, 'hz')}: {sensor.hz:g} Hz; the simulator gives {SimAir.hz:g} Hz at most")


def _body(member: MissionVehicle) -> AirBody:
    body = member.file.air
    assert body is not None
    return body


def _model_folder(member: MissionVehicle) -> Path:
    """A variant flies the model of the vehicle it is made of unless it has one itself."""
    return holding(folders_of(member.folder), _body(member).model)


def _tangent(site: Scenario) -> LocalTangent:
    origin = site.world.origin
    return LocalTangent.from_degrees(origin.latitude, origin.longitude, origin.altitude)


def _make(site: Scenario, land: Land) -> SimAir:
    things, members = solids(site.world), list(site.of_kind("fixed_wing"))
    flying = [Airframe(_model_folder(m), _body(m), _tangent(site)) for m in members]
    on_wheels = {m.name: vehicle_tree(load_urdf(m.folder / m.file.ground.urdf)) for m in site.of_kind("ground") if m.file.ground}
    joining = {m.name: _joining(site, land, m, airframe) for m, airframe in zip(members, flying, strict=True)}
    around = Around(things, land.ground, on_wheels | {name: one.shape for name, one in joining.items()}, partial(_shape_of, site))
    aircraft = {name: one.aircraft for name, one in joining.items()}
    taken = (*site.members, *(thing.name for thing in things), "floor")
    socks = Windsocks(site.world.windsocks, site.wind, lambda name: site.rng(name, "turbulence"), land.ground.top)
    return SimAir(AirStage(aircraft, around, taken, partial(_join, site, land), socks), Faults(site.mission.faults))


def _join(site: Scenario, land: Land, name: str, model: str, start: StartPose) -> JoiningAircraft:
    """An aircraft that nobody steers but by its actuator topic, made ready while the simulation runs. Raises BadInput."""
    file, folder = load_vehicle(site.vehicles_folder, model), site.vehicles_folder / model
    if file.air is None:
        raise BadInput(f"'{model}' is no aircraft; this is the air simulator")
    member = MissionVehicle(name, Vehicle(model=model, start=start, system_id=1), file, folder)
    _check_rates(member)
    land.check_room(f"'{name}'", start)
    airframe = Airframe(_model_folder(member), file.air, _tangent(site))
    return _joining(site, land, member, airframe)


def _joining(site: Scenario, land: Land, member: MissionVehicle, airframe: Airframe) -> JoiningAircraft:
    """An aircraft and its shape, which is also how it lies as a wreck. Raises BadInput."""
    aircraft, shape = _aircraft(site, land, member, airframe), aircraft_tree(aircraft_shape(member.folder, member.file))
    aircraft.rests = Resting(land.ground, shape)
    return JoiningAircraft(aircraft, shape)


def _begin(site: Scenario, land: Land, member: MissionVehicle, start: StartPose) -> tuple[Airframe, Controls, Controls]:
    """An airframe of its own for a new beginning. Raises BadInput."""
    land.check_room(f"'{member.name}'", start)
    airframe = Airframe(_model_folder(member), _body(member), _tangent(site))
    return airframe, *_begun(land, member, airframe, start, _air(site, member, airframe))


def _begun(land: Land, member: MissionVehicle, airframe: Airframe, start: StartPose, air: AirMass) -> tuple[Controls, Controls]:
    """Its controls at its beginning over the land, and those of level flight. Raises BadInput."""
    airframe.over(land.ground)
    return begun(airframe, as_told(start, _body(member), air, land.ground.top(start.x, start.y)))


def _air(site: Scenario, member: MissionVehicle, airframe: Airframe) -> AirMass:
    return AirMass(site.wind, airframe.span, site.rng(member.name, "turbulence"))


def _shape_of(site: Scenario, model: str) -> Bvh | None:
    """Of a ground vehicle that has been put in: the ground simulator has taken it, if it was that simulator who told of it."""
    with suppress(BadInput):
        ground = load_vehicle(site.vehicles_folder, model).ground
        return vehicle_tree(load_urdf(site.vehicles_folder / model / ground.urdf)) if ground is not None else None
    return None


def _aircraft(site: Scenario, land: Land, member: MissionVehicle, airframe: Airframe) -> Aircraft:
    """One aircraft as it starts. Raises BadInput."""
    body, tangent, begin = _body(member), _tangent(site), member.entry.start
    air = _air(site, member, airframe)
    now, level = _begun(land, member, airframe, begin, air)
    aircraft = Aircraft(member.name, member.file, airframe, Actuators(now, body), level)
    aircraft.charge = Charge(body.battery, begin.charge) if body.battery is not None else None
    aircraft.begin = partial(_begin, site, land, member)
    aircraft.wind, aircraft.air_mass = air.mean(begin.z), air
    if begin.launch is not None:
        held = np.array((begin.x, begin.y, land.ground.top(begin.x, begin.y) + begin.launch.height))
        aircraft.launcher = AircraftLauncher(begin.launch, held, begin.yaw, standard_air(tangent, held), site.rng(member.name, "launch"))
        aircraft.wind = air.mean(begin.launch.height)
        aircraft.fly_to(0.0)
    fitted = member.file.sensors
    if fitted.imu is not None:
        aircraft.imu = Imu(fitted.imu, np.array(site.world.magnetic_field), site.rng(member.name, "imu"))
    if fitted.gnss is not None:
        aircraft.gnss = Gnss(fitted.gnss, tangent, site.rng(member.name, "gnss"))
    if fitted.air_data is not None:
        aircraft.pressures = PressureSensors(fitted.air_data, site.rng(member.name, "air_data"))
    aircraft.rangers = Rangers(member.name, fitted, land.ground.scene, partial(site.rng, member.name))
    return aircraft
