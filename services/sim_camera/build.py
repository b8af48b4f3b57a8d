"""The cameras of a mission: one instance for all of them."""

from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path

from services.sim_camera.fitted import FittedCamera
from services.sim_camera.renderer import BulletRenderer, Look
from services.sim_camera.service import SimCamera
from uvf.models.aircraft.shape import aircraft_shape
from uvf.models.scenario import MissionVehicle, Scenario
from uvf.models.shapes.solid import Solid
from uvf.models.urdf.model import engine_urdf, load_urdf
from uvf.models.vehicle.file import VehicleFile, load_vehicle
from uvf.models.vehicle.sensors import Camera, Sensors
from uvf.models.world.file import WorldFile
from uvf.models.world.geometry import land, seen
from uvf.models.world.terrain_picture import raised_mesh, with_ground_of
from uvf.models.yaml_data import BadInput, FileLocation, nearest
from uvf.runtime.contract.instances import ServiceInstance
from uvf.sensors.carrier import Carrier

OUTPUTS = {"camera": "image", "chase": "chase", "gimbal": "gimbal"}
"""The output that each camera's pictures go out by."""


def build(site: Scenario) -> list[ServiceInstance]:
    """The camera service; empty when no vehicle has a camera. Raises BadInput."""
    cameras = {(m.name, kind): camera for m in site.members.values() for kind, camera in _cameras(m.file.sensors).items()}
    for member in site.members.values():
        for fault in camera_faults(member.file.sensors, FileLocation(str(member.folder / "vehicle.yaml"))):
            raise BadInput(fault)
    if not cameras:
        return []
    looks = {name: look_at(member.folder, member.file) for name, member in site.members.items()}
    world, rendered = with_ground_of(site.world), _rendered(site.world)

    @cache
    def look_of(model: str) -> Look | None:
        with suppress(BadInput):
            return look_at(site.vehicles_folder / model, load_vehicle(site.vehicles_folder, model))
        return None

    def make() -> SimCamera:
        fitted = [
            FittedCamera(name, camera, site.rng(name, kind), OUTPUTS[kind], _carrier(site.members[name], camera))
            for (name, kind), camera in cameras.items()
        ]
        return SimCamera(BulletRenderer(world, rendered, looks), fitted, look_of)

    return [ServiceInstance(SimCamera, make, writes_for=tuple(dict.fromkeys(name for name, _ in cameras)))]


def _carrier(member: MissionVehicle, camera: Camera) -> Carrier | None:
    """The link that a camera sits on, where joints move it."""
    body, link = member.file.ground, camera.mount.link
    if body is None or link is None:
        return None
    model = load_urdf(member.folder / body.urdf)
    return Carrier(model, link) if link in model.carried_by(body.turning_joints) else None


def _rendered(world: WorldFile) -> list[Solid]:
    """What is rendered of a world, of its terrain what stands out of the ground."""
    raised = None if world.terrain is None else raised_mesh(world.terrain)
    return seen(world) if world.terrain is None or raised is None else [*seen(world), land(world.terrain, raised)]


def _cameras(sensors: Sensors) -> dict[str, Camera]:
    """By what they are called in the vehicle's file."""
    return {kind: camera for kind in OUTPUTS if (camera := getattr(sensors, kind)) is not None}


def camera_faults(sensors: Sensors, place: FileLocation) -> Iterator[str]:
    """What the simulator of the cameras does not have of a vehicle's, a line each."""
    for kind, camera in _cameras(sensors).items():
        if camera.depth and kind != "camera":
            yield f"{place.at('sensors', kind, 'depth')}: only 'camera' sends depth; take it out"
        if camera.hz > SimCamera.hz:
            yield f"{place.at('sensors', kind, 'hz')}: {camera.hz:g}; the cameras' simulator gives {SimCamera.hz:g} at most"


def look_at(folder: Path, file: VehicleFile) -> Look:
    """The appearance of the vehicle in this folder. Raises BadInput."""
    if file.ground is not None:
        return engine_urdf(folder / file.ground.urdf)
    mesh = file.air.mesh if file.air is not None else None
    if mesh is not None and not (folder / mesh).is_file():
        place = f"{folder / 'vehicle.yaml'}: air: mesh"
        raise BadInput(f"{place}: no file '{mesh}' in that folder; {nearest(mesh, (p.name for p in folder.iterdir()))}")
    return aircraft_shape(folder, file)
