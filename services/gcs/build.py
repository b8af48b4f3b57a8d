"""The ground station of a mission: one page for all its vehicles."""

import sys

from services.gcs.export import NoExporter
from services.gcs.service import GroundStation
from services.gcs.surveying import SurveyProcess
from uvf.models.scenario import Scenario
from uvf.runtime.bus.address import address_from, router_from
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.log.folder import log_folder


def build(site: Scenario) -> list[ServiceInstance]:
    """The ground station's service; its page's address is UVF_GCS_HOST:UVF_GCS_PORT. Raises BadInput."""
    address = address_from()

    def make() -> GroundStation:
        from services.gcs.log_exporter import LogExporter
        from services.gcs.page.viser_page import ViserPage
        from services.gcs.view.scene.cameras import cameras
        from services.gcs.zenoh_watch import ZenohWatch

        folder = log_folder()
        exporter = LogExporter(folder) if folder is not None else NoExporter()
        page = ViserPage(address, next(iter(cameras(site).values())), exporter.files)
        if address.token:
            sys.stderr.write(f"gcs: the page, for those who have its token: {address.url}\n")
        return GroundStation(site, page, ZenohWatch(router_from()), exporter, SurveyProcess())

    return [ServiceInstance(GroundStation, make, writes_for=tuple(site.members))]
