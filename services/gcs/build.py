"""The ground station of a mission: one page for all its vehicles."""

from services.gcs.address import address_from
from services.gcs.service import GroundStation
from uvf.runtime.site import Host, Site


def build(site: Site) -> list[Host]:
    address = address_from()

    def make() -> GroundStation:
        from services.gcs.cameras import cameras
        from services.gcs.state import Model
        from services.gcs.viser_page import ViserPage

        return GroundStation(site, ViserPage(address, cameras(site), Model(site).layers))

    return [Host(GroundStation, make)]
