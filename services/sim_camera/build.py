"""The cameras of a mission: one instance for all of them."""

from services.sim_camera.renderer import BulletRenderer, Look
from services.sim_camera.service import SimCamera
from uvf.runtime.params import BadInput, nearest
from uvf.runtime.site import Host, Member, Site
from uvf.runtime.urdf_file import check_urdf
from uvf.runtime.vehicle_file import Camera
from uvf.runtime.world_geometry import solids


def build(site: Site) -> list[Host]:
    """Nothing when no vehicle has a camera. Raises BadInput."""
    cameras = {m.name: m.file.sensors.camera for m in site.members.values() if m.file.sensors.camera is not None}
    for name, camera in cameras.items():
        _check(site.members[name], camera)
    looks = {name: _look(member) for name, member in site.members.items()}
    if not cameras:
        return []
    things = solids(site.world, site.world_folder)
    return [Host(SimCamera, lambda: SimCamera(BulletRenderer(site.world, things, looks), cameras), writes_for=tuple(cameras))]


def _check(member: Member, camera: Camera) -> None:
    if SimCamera.hz % camera.hz:
        place = f"{member.folder / 'vehicle.yaml'}: sensors: camera"
        raise BadInput(f"{place}: hz is {camera.hz:g}; make it a divisor of {SimCamera.hz:g}")


def _look(member: Member) -> Look:
    if member.file.ground is not None:
        check_urdf(member.folder / member.file.ground.urdf, ())
        return Look(urdf=member.folder / member.file.ground.urdf)
    mesh = member.file.air.mesh if member.file.air is not None else None
    if mesh is not None and not (member.folder / mesh).is_file():
        place = f"{member.folder / 'vehicle.yaml'}: air: mesh"
        raise BadInput(f"{place}: no file '{mesh}' in that folder; {nearest(mesh, (p.name for p in member.folder.iterdir()))}")
    return Look(mesh=member.folder / mesh if mesh is not None else None)
