"""A detector for every vehicle whose file, or mission, has ``params: detector:``."""

from services.detector.detector_service import DetectorParams, DetectorService
from uvf.models.scenario import MissionVehicle, Scenario
from uvf.models.yaml_data import BadInput
from uvf.runtime.contract.instances import ServiceInstance


def build(site: Scenario) -> list[ServiceInstance]:
    """The detector of each vehicle that asks for one. Raises BadInput for a vehicle without a camera."""
    return [_host(member) for member in site.members.values() if DetectorService.name in member.file.params]


def _host(member: MissionVehicle) -> ServiceInstance:
    if member.file.sensors.camera is None:
        raise BadInput(f"{member.folder / 'vehicle.yaml'}: params: detector: no camera to see with; fit one under 'sensors'")
    params = member.params(DetectorService.name, DetectorParams)
    return ServiceInstance(DetectorService, lambda: DetectorService(params), member.name)
