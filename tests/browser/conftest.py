"""Chromium, and a ground station in front of scripted vehicles that runs in a thread of its own."""

import contextlib
import threading
from pathlib import Path

import pytest

from services.gcs.export import NoExporter
from services.gcs.page.viser_page import ViserPage
from services.gcs.service import GroundStation
from services.gcs.surveying import SurveyProcess
from services.gcs.view.scene.cameras import cameras
from tests.second_try import Shared
from tests.services.gcs.scripted import Script, demo_site, with_eyes
from tests.services.gcs.watches import LocalWatch
from tests.services.gcs.wire import free_port
from uvf.runtime.bus.address import Address
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service_runner import ServiceRunner

CHROMIUM = Path("/usr/bin/chromium")
FLAGS = [
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
    "--disable-extensions",
]


IS_READY = """(name) => document.querySelector('#gcs-bar .g-status')
  && window.__viserSceneTree && name in window.__viserSceneTree.getState()"""


class LiveStation:
    """The real service on the real page; ``moving`` off holds the vehicles still, ``living`` off the whole station."""

    def __init__(self):
        site, self.port = with_eyes(demo_site()), free_port()
        self.script = Script()
        self.page = ViserPage(Address(port=self.port), next(iter(cameras(site).values())), {})
        self.service = GroundStation(site, self.page, LocalWatch(self.script.bus), NoExporter(), SurveyProcess())
        self.shell = ServiceRunner(ServiceInstance(GroundStation, lambda: self.service), self.script.bus)
        self.moving = self.living = True
        self.t = 0.0
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def _run(self):
        while not self._end.wait(0.05):
            if not self.living:
                continue
            self.t += 0.05 * self.moving
            self.script.publish(self.t)
            self.shell.advance()

    def close(self):
        self._end.set()
        self._thread.join()
        self.service.close()


@pytest.fixture(scope="package")
def browser():
    """Ends with this folder's tests: as long as playwright is open, no test in this thread can run a loop of its own."""
    if not CHROMIUM.exists():
        pytest.skip(f"no browser: {CHROMIUM} is not there (apt-get install chromium)")
    sync_api = pytest.importorskip("playwright.sync_api")
    with sync_api.sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=str(CHROMIUM), headless=True, args=FLAGS)
        yield chromium
        chromium.close()


@contextlib.contextmanager
def opened(browser, port, node, size=(1200, 700)):
    """The page once its bar is there and ``node`` stands in its scene; an error in its script fails the tests that use it."""
    page = browser.new_page(viewport={"width": size[0], "height": size[1]}, color_scheme="dark")
    errors = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.goto(f"http://127.0.0.1:{port}/")
    page.wait_for_function(IS_READY, arg=node, timeout=90_000)
    try:
        yield page
    finally:
        page.close()
    assert errors == []


@contextlib.contextmanager
def staged(browser):
    """(station, page): a station of its own and a page that looks at it."""
    with contextlib.closing(LiveStation()) as station, opened(browser, station.port, "/vehicles/milvus/0") as page:
        yield station, page


@pytest.fixture(scope="module")
def stage(browser):
    """One station and one page for all tests of a module."""
    with contextlib.closing(Shared(lambda: staged(browser))) as stage:
        yield stage


@pytest.fixture
def staging(stage, request):
    return stage.for_test(request)


@pytest.fixture
def station(staging):
    return staging[0]


@pytest.fixture
def page(staging):
    return staging[1]
