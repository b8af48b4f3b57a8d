"""The executive of a mission that has tasks."""

from services.executive.actions.joystick import load_drive_track
from services.executive.service import Executive
from uvf.models.mission.tasks import walk
from uvf.models.scenario import Scenario
from uvf.runtime.contract.instances import ServiceInstance


def build(site: Scenario) -> list[ServiceInstance]:
    """The executive; empty where the mission has no tasks. Raises BadInput for a recorded drive that is none."""
    mission = site.mission
    if not mission.tasks:
        return []
    drives = [task.drive.track for task in walk(mission.tasks) if task.drive is not None]
    tracks = {name: load_drive_track(site.mission_path.parent / name) for name in drives}
    driven = tuple(member.name for member in site.of_kind("ground"))
    return [
        ServiceInstance(
            Executive, lambda: Executive(mission.tasks, site.members, mission.roles, tracks, mission.chargers), writes_for=driven
        )
    ]
