"""The autopilot of every ground vehicle of the mission."""

from services.autopilot.ground import fence as fences
from services.autopilot.ground.mission import refusal
from services.autopilot.ground.params import GroundAutopilotParams
from services.autopilot.ground.safety import SensorLooks
from services.autopilot.ground.service import GroundAutopilot
from uvf.models.scenario import MissionVehicle, Scenario
from uvf.models.urdf.model import load_urdf
from uvf.models.vehicle.joints import moved_joints
from uvf.models.yaml_data import BadInput
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.messages.plans.fences import fence_message, fencing
from uvf.runtime.messages.plans.mission_files import item_from_file
from uvf.sensors.cliffs import floor_sights
from uvf.sensors.fitted import sweeping_of


def hosts(site: Scenario) -> list[ServiceInstance]:
    """The autopilots of a mission's ground vehicles. Raises BadInput when a job's mission is not one for a ground vehicle."""
    return [_host(member, site) for member in site.of_kind("ground")]


def _host(member: MissionVehicle, site: Scenario) -> ServiceInstance:
    start, body, job = member.entry.start, member.file.ground, member.entry.job
    if body is None:
        raise BadInput(f"{member.folder / 'vehicle.yaml'}: there is no 'ground:' section")
    items = [item_from_file(w) for w in job.mission]
    reason = refusal(items)
    if reason:
        raise BadInput(f"{site.mission_path}: {member.name}: job: mission: {reason}")
    fence = fence_message(member.entry.fence, f"{site.mission_path}: {member.name}: fence")
    if outside := fences.refusal(items, fencing(fence), body.radius):
        raise BadInput(f"{site.mission_path}: {member.name}: fence: {outside}")
    sensors = member.file.sensors
    looks = SensorLooks(
        sensors.imu.mount.rpy if sensors.imu is not None else (0.0, 0.0, 0.0),
        {f"{member.name}/{lidar.frame}": sweeping_of(lidar) for lidar in sensors.lidars},
        floor_sights(sensors.rangefinders),
    )
    armed = (job.explore or bool(items)) if job.armed is None else job.armed
    begins = armed and (job.explore or bool(items))
    params = member.params("autopilot_ground", GroundAutopilotParams)

    joints = moved_joints(load_urdf(member.folder / body.urdf), body.joints) if body.joints else {}

    def make() -> GroundAutopilot:
        return GroundAutopilot(body, (start.x, start.y), (armed, begins, items), member.entry.system_id, params, fence, looks, joints)

    return ServiceInstance(GroundAutopilot, make, member.name)
