"""A ground station before scripted vehicles, as a process of its own: ``python -m tests.hostile.page_station PORT``.

Each line of its output says what it has sent so far: STOPs, requests, drives, aims of the gimbal.
"""

import sys
import time

from services.gcs.export import NoExporter
from services.gcs.page import viser_socket
from services.gcs.page.viser_page import ViserPage
from services.gcs.service import GroundStation
from services.gcs.surveying import SurveyProcess
from services.gcs.view.scene.cameras import cameras
from tests.services.gcs.scripted import Script, demo_site, with_eyes
from tests.services.gcs.watches import FakeWatch
from uvf.runtime.bus.address import Address
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service_runner import ServiceRunner

SILENT_FOR = 3.0  # s, instead of ten that a test would wait for


def main(port: int) -> None:
    viser_socket.SILENT_FOR = SILENT_FOR
    site, script = with_eyes(demo_site()), Script()
    page = ViserPage(Address(port=port), next(iter(cameras(site).values())), {})
    shell = ServiceRunner(
        ServiceInstance(GroundStation, lambda: GroundStation(site, page, FakeWatch(), NoExporter(), SurveyProcess())), script.bus
    )
    begin, told = time.monotonic(), None
    while True:
        script.publish(time.monotonic() - begin)
        shell.advance()
        sent = (len(script.stops), len(script.asked), len(script.drives), len(script.gimbals))
        if sent != told:
            sys.stdout.write(f"{' '.join(map(str, sent))}\n")
            sys.stdout.flush()
            told = sent
        time.sleep(0.05)


if __name__ == "__main__":
    main(int(sys.argv[1]))
