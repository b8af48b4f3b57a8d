"""One merging for all ground vehicles of the mission that draw maps."""

from services.slam.merging.merging_service import MergingService
from uvf.models.scenario import Scenario
from uvf.runtime.contract.instances import ServiceInstance
from uvf.slam.graph.method import GraphSlam
from uvf.slam.made_corridor import there_and_back
from uvf.slam.merging.team import Team


def build(site: Scenario) -> list[ServiceInstance]:
    """The merging service; empty where fewer than two vehicles draw maps."""
    names = tuple(member.name for member in site.mapping)
    if len(names) < 2:
        return []
    warm_up()
    return [ServiceInstance(MergingService, MergingService, writes_for=names)]


def warm_up() -> None:
    """Compiles the kernels, or loads them from their cache, before the first session, by matching one with itself."""
    slam, team = GraphSlam(), Team()
    for reading in there_and_back():
        slam.add(reading)
    for name in ("one", "other"):
        team.follow(name, slam.session())
    team.finish()
