"""A page that only remembers, and a ground station that runs on it."""

from dataclasses import dataclass
from typing import Any

from services.gcs.actions import Join
from services.gcs.service import GroundStation
from tests.services.gcs.scripted import Script, demo_site
from tests.services.gcs.watches import FakeWatch
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service_runner import ServiceRunner

ME, OTHER = 1, 2
"""Two browsers; the first one has joined from the start."""


@dataclass
class Seen:
    """All that one browser shows: what is everybody's and what is its own."""

    nodes: Any
    places: Any
    html: Any
    buttons: Any
    image: Any
    gimbal: Any
    vehicle: str
    hidden: Any


class FakePage:
    def __init__(self):
        self.pictures = []
        self.clicks = [Join(ME)]
        self.closed = False

    @property
    def now(self):
        return self.seen_by(ME)

    def seen_by(self, page):
        picture = self.pictures[-1]
        own = picture.panels[page]
        html, buttons = {**picture.html, **own.html}, [*picture.buttons, *own.buttons]
        return Seen(picture.nodes, picture.places, html, buttons, own.image, own.gimbal, own.vehicle, own.hidden)

    def show(self, picture):
        self.pictures.append(picture)

    def actions(self):
        taken, self.clicks = self.clicks, []
        return taken

    def close(self):
        self.closed = True


class Station:
    """The service on a fake page, with scripted vehicles; ``run`` lets simulation and wall time pass alike."""

    def __init__(self, accept=True, site=None):
        self.script = Script(accept=accept)
        self.page = FakePage()
        self.watch = FakeWatch()
        self.site = site or demo_site()
        self.service = GroundStation(self.site, self.page, self.watch)
        self.shell = ServiceRunner(ServiceInstance(GroundStation, lambda: self.service), self.script.bus)
        self.t = 0.0

    @property
    def model(self):
        return self.service._model

    def run(self, seconds, silent=False):
        for _ in range(round(seconds * GroundStation.hz)):
            self.t += 1 / GroundStation.hz
            if not silent:
                self.script.publish(self.t)
            self.shell.sim_ns = round(self.t * 1e9)
            self.shell.advance()

    def press(self, *actions, seconds=0.1):
        self.page.clicks += actions
        self.run(seconds)
