"""The programs that the vehicles of a mission bring along."""

from services.programs.loading import load_program
from uvf.models.scenario import MissionVehicle, Scenario
from uvf.models.yaml_data import FileLocation
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.program import Program


def build(site: Scenario) -> list[ServiceInstance]:
    """The program of each vehicle that has one. Raises BadInput for a file that holds none."""
    file, folder = FileLocation(str(site.mission_path)), site.mission_path.parent
    named = [(member, member.entry.program) for member in site.members.values() if member.entry.program is not None]
    return [_host(member, load_program(folder / program, file.at("vehicles", member.name, "program"))) for member, program in named]


def _host(member: MissionVehicle, program: type[Program]) -> ServiceInstance:
    return ServiceInstance(program, lambda: program(member), member.name)
