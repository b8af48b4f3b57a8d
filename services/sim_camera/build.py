"""The cameras of a mission: one instance for all of them."""

from functools import cache

from services.sim_camera.fitted import Fitted
from services.sim_camera.renderer import BulletRenderer, Look
from services.sim_camera.service import SimCamera
from uvf.runtime.params import BadInput, nearest
from uvf.runtime.site import Host, Member, Site
from uvf.runtime.urdf_model import engine_urdf
from uvf.runtime.vehicle_file import Camera, load_vehicle
from uvf.runtime.world_geometry import solids


def build(site: Site) -> list[Host]:
    """Nothing when no vehicle has a camera. Raises BadInput."""
    cameras = {m.name: m.file.sensors.camera for m in site.members.values() if m.file.sensors.camera is not None}
    for name, camera in cameras.items():
        _check(site.members[name], camera)
    looks = {name: _look(member) for name, member in site.members.items()}
    if not cameras:
        return []
    things = solids(site.world)

    vehicles = next(iter(site.members.values())).folder.parent

    @cache
    def look_of(model: str) -> Look:
        ground = load_vehicle(vehicles, model).ground  # the ground simulation has taken it in
        return Look(urdf=engine_urdf(vehicles / model / ground.urdf)) if ground is not None else Look()

    def make() -> SimCamera:
        fitted = [Fitted(name, camera, site.rng(name, "camera")) for name, camera in cameras.items()]
        return SimCamera(BulletRenderer(site.world, things, looks), fitted, look_of)

    return [Host(SimCamera, make, writes_for=tuple(cameras))]


def _check(member: Member, camera: Camera) -> None:
    if camera.hz > SimCamera.hz:
        place = f"{member.folder / 'vehicle.yaml'}: sensors: camera"
        raise BadInput(f"{place}: hz is {camera.hz:g}; the cameras' simulator gives {SimCamera.hz:g} at most")


def _look(member: Member) -> Look:
    if member.file.ground is not None:
        return Look(urdf=engine_urdf(member.folder / member.file.ground.urdf))
    mesh = member.file.air.mesh if member.file.air is not None else None
    if mesh is not None and not (member.folder / mesh).is_file():
        place = f"{member.folder / 'vehicle.yaml'}: air: mesh"
        raise BadInput(f"{place}: no file '{mesh}' in that folder; {nearest(mesh, (p.name for p in member.folder.iterdir()))}")
    return Look(mesh=member.folder / mesh if mesh is not None else None)
