"""Makes the autopilots of a mission, in the air and on the ground."""

from services.autopilot.air import build as air
from services.autopilot.ground import build as ground
from uvf.models.scenario import Site
from uvf.runtime.contract.instances import Host


def build(site: Site) -> list[Host]:
    return [*air.hosts(site), *ground.hosts(site)]
