"""One merging for all ground vehicles of the mission that draw maps."""

from services.slam.graph.method import GraphSlam
from services.slam.made_corridor import there_and_back
from services.slam.merging.merging_service import MergingService
from services.slam.merging.team import Team
from uvf.runtime.site import Host, Site


def build(site: Site) -> list[Host]:
    """None where fewer than two of them do."""
    names = tuple(m.name for m in site.of_kind("ground") if m.entry.maps is None or m.entry.maps.localize is None)
    if len(names) < 2:
        return []
    warm_up()
    return [Host(MergingService, MergingService, writes_for=names)]


def warm_up() -> None:
    """Compiles the kernels, or loads them from their cache, before the first session: one that meets itself."""
    slam, team = GraphSlam(), Team()
    for reading in there_and_back():
        slam.add(reading)
    for name in ("one", "other"):
        team.follow(name, slam.session())
    team.finish()
