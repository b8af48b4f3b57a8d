"""Makes the autopilots of a mission, in the air and on the ground."""

from services.autopilot.air import build as air
from services.autopilot.ground import build as ground
from uvf.models.scenario import Scenario
from uvf.runtime.contract.instances import ServiceInstance


def build(site: Scenario) -> list[ServiceInstance]:
    """The autopilots of a mission's aircraft and ground vehicles. Raises BadInput for a job that does not suit its vehicle."""
    return [*air.hosts(site), *ground.hosts(site)]
