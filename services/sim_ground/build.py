"""The ground simulator of a mission: one instance for all its ground vehicles."""

from collections.abc import Iterator
from functools import partial

from services.sim_ground.loading import BodyPlacement
from services.sim_ground.rig import STEP_HZ, Rig
from services.sim_ground.service import SimGround
from services.sim_ground.stage import GroundStage, JoiningVehicle
from services.sim_ground.world import BulletWorld
from uvf.maths.raycast import warm_up
from uvf.maths.se2 import Pose2
from uvf.models.aircraft.shape import aircraft_shape
from uvf.models.mission.file import StartPose, Vehicle
from uvf.models.scenario import MissionVehicle, Scenario
from uvf.models.urdf.model import check_urdf, engine_urdf, load_urdf
from uvf.models.urdf.outline import ground_outline
from uvf.models.vehicle.file import GroundBody, load_vehicle
from uvf.models.vehicle.joints import joint_faults, mount_faults
from uvf.models.vehicle.sensors import Sensors
from uvf.models.world.footing import COARSE, Footing
from uvf.models.world.geometry import solids
from uvf.models.yaml_data import BadInput, FileLocation
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.messages.readings.faults import Faults
from uvf.sensors.surroundings import Surroundings, aircraft_solid, own_tree, vehicle_tree


def build(site: Scenario) -> list[ServiceInstance]:
    """The service of the mission's ground vehicles; empty when there are none. Raises BadInput."""
    bodies = {m.name: m.file.ground for m in site.of_kind("ground") if m.file.ground is not None}
    if not bodies:
        return []
    footing = Footing(site.world)
    grounds = {name: _checked(site, site.members[name], footing) for name in bodies}
    _check_chargers(site, footing)
    warm_up()
    return [ServiceInstance(SimGround, lambda: _make(site, bodies, grounds), writes_for=tuple(bodies))]


def _make(site: Scenario, bodies: dict[str, GroundBody], grounds: dict[str, float]) -> SimGround:
    """grounds: z [m] of what each vehicle stands on at its start."""
    members = {name: site.members[name] for name in bodies}
    placed = {n: BodyPlacement(bodies[n], engine_urdf(m.folder / bodies[n].urdf), _start(m), grounds[n]) for n, m in members.items()}
    things = solids(site.world)
    on_wheels = {name: vehicle_tree(load_urdf(m.folder / bodies[name].urdf)) for name, m in members.items()}
    flying = {m.name: aircraft_solid(m.name, aircraft_shape(m.folder, m.file)) for m in site.of_kind("fixed_wing")}
    surroundings = Surroundings(things, on_wheels | {name: own_tree(solid) for name, solid in flying.items()})
    rigs = {name: Rig(site, m, bodies[name], surroundings.still) for name, m in members.items()}
    world = BulletWorld(things, placed)
    for name, solid in flying.items():
        world.let_in(name, solid)
    taken = (*site.members, *(thing.name for thing in things), "floor")
    stage = GroundStage(world, rigs, surroundings, taken, partial(_join, site, surroundings))
    return SimGround(world, surroundings, stage, tuple(flying), Faults(site.mission.faults))


def _join(site: Scenario, surroundings: Surroundings, name: str, model: str, start: tuple[float, float, float], z: float) -> JoiningVehicle:
    """A vehicle that nobody steers but by its actuator topic, made ready while the simulation runs. Raises BadInput."""
    file, (x, y, yaw) = load_vehicle(site.vehicles_folder, model), start
    if file.ground is None:
        raise BadInput(f"'{model}' is no ground vehicle; this is the ground simulator")
    member = MissionVehicle(name, Vehicle(model=model, start=StartPose(x=x, y=y, yaw=yaw), system_id=1), file, site.vehicles_folder / model)
    urdf = member.folder / file.ground.urdf
    _check_body(member, file.ground)
    return JoiningVehicle(
        BodyPlacement(file.ground, engine_urdf(urdf), start, z), Rig(site, member, file.ground, surroundings.still), load_urdf(urdf)
    )


def _start(member: MissionVehicle) -> tuple[float, float, float]:
    return member.entry.start.x, member.entry.start.y, member.entry.start.yaw


def _checked(site: Scenario, member: MissionVehicle, footing: Footing) -> float:
    """z [m] of the ground at the start; of a slope, so much above that no wheel begins in it. Raises for what would fail in the engine."""
    body = member.file.ground
    assert body is not None
    _check_body(member, body)
    start = member.entry.start
    room, height, slope = footing.at(start.x, start.y)
    if not footing.is_free(Pose2(start.x, start.y, start.yaw), ground_outline(member.folder / body.urdf, body.radius)):
        place = FileLocation(str(site.mission_path)).at("vehicles", member.name, "start")
        near = f"its middle is {room:.2f} m from it" if room > 0.0 else "its middle, too"
        raise BadInput(f"{place}: at ({start.x:g}, {start.y:g}) the vehicle stands in a wall or furniture, {near}; move or turn it")
    return height + slope * (body.radius + COARSE)


def _check_chargers(site: Scenario, footing: Footing) -> None:
    for i, charger in enumerate(site.mission.chargers):
        if footing.at(charger.x, charger.y).room == 0.0:
            place = FileLocation(str(site.mission_path)).at("chargers", i)
            raise BadInput(f"{place}: ({charger.x:g}, {charger.y:g}) lies under a wall or furniture, where no vehicle can stand; move it")


def _check_body(member: MissionVehicle, body: GroundBody) -> None:
    model = check_urdf(member.folder / body.urdf, body.drive.all_wheels, body.drive.steered_wheels)
    place = FileLocation(str(member.folder / "vehicle.yaml")).at("sensors")
    for fault in (
        *joint_faults(model, body.joints, body.springs, body.physics_hz),
        *mount_faults(model, body.joints, member.file.sensors, place),
    ):
        raise BadInput(fault)
    _check_rates(member, body)


def _check_rates(member: MissionVehicle, body: GroundBody) -> None:
    for fault in rate_faults(member.file.sensors, body, FileLocation(str(member.folder / "vehicle.yaml"))):
        raise BadInput(fault)


def rate_faults(sensors: Sensors, body: GroundBody, place: FileLocation) -> Iterator[str]:
    """Rates of a vehicle's file that the simulator does not have, a line each."""
    if body.physics_hz % STEP_HZ:
        yield f"{place.at('ground', 'physics_hz')}: {body.physics_hz:g}; make it a multiple of {STEP_HZ:g}"
    for kind in ("lidar", "imu", "encoders", "gnss"):
        sensor, most = getattr(sensors, kind), body.physics_hz if kind == "imu" else STEP_HZ
        if sensor is not None and sensor.hz > most:
            yield f"{place.at('sensors', kind, 'hz')}: {sensor.hz:g}; the simulator gives {most:g} at most"
    for kind in ("other_lidars", "sonars", "rangefinders"):
        for i, ranger in enumerate(getattr(sensors, kind)):
            if ranger.hz > STEP_HZ:
                yield f"{place.at('sensors', kind, i, 'hz')}: {ranger.hz:g}; the simulator gives {STEP_HZ:g} at most"
