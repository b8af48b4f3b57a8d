"""A page that only remembers, and a ground station that runs on it."""

import json
import re
from dataclasses import dataclass
from html import unescape
from typing import Any

from services.gcs.actions.page import Beat, ClickGround, Hello, Join, OpenTab, Point
from services.gcs.export import ExportState
from services.gcs.page.words import action_in
from services.gcs.service import GroundStation
from tests.services.gcs.scripted import Script, demo_site
from tests.services.gcs.watches import FakeWatch, LocalWatch
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service_runner import ServiceRunner

ME, OTHER = 1, 2
"""Two browsers; the first one has joined from the start."""
OPERATORS = {ME: "a" * 32, OTHER: "b" * 32}


@dataclass
class Seen:
    """All that one browser shows: what is everybody's and what is its own."""

    nodes: Any
    places: Any
    html: Any
    own: Any
    own_places: Any
    camera: Any
    hidden: Any
    theme: Any

    @property
    def vehicle(self):
        """The one on show, as the page's script reads it."""
        found = re.search(r"g-shown' hidden data-name='([^']*)'", self.html["bar"])
        return found[1] if found else ""

    @property
    def words(self):
        """What each button, box and slider of the page would say, by its label."""
        elements = re.findall(r"<(?:button|input)[^>]*data-do='([^']*)'[^>]*>([^<]*)", "".join(self.html.values()))
        return {unescape(label).strip(): json.loads(unescape(word)) for word, label in elements}

    def greyed(self, label):
        """Whether a command is shown as one that cannot be given now."""
        return bool(re.search(rf"aria-disabled='true'[^>]*>{re.escape(label)}<", self.html["commands"]))

    def pressed(self):
        """Labels of the buttons that are shown as pressed in."""
        return re.findall(r"<button[^>]*aria-pressed='true'[^>]*>([^<]+)</button>", self.html["commands"])


class FakePage:
    """Tells of its beats as a browser does, unless it is ``asleep``."""

    def __init__(self):
        self.pictures = []
        self.clicks = [Join(ME), Hello(ME, OPERATORS[ME], ""), OpenTab(ME, "drive")]
        self.asleep = False
        self.closed = False

    @property
    def now(self):
        return self.seen_by(ME)

    def seen_by(self, page):
        picture = self.pictures[-1]
        own = picture.panels[page]
        return Seen(picture.nodes, picture.places, own.html, own.nodes, own.places, own.camera, own.hidden, own.theme)

    def show(self, picture):
        self.pictures.append(picture)

    def actions(self):
        beats = [Beat(page, f"{own.t:.3f}") for page, own in self.pictures[-1].panels.items()] if self.pictures and not self.asleep else []
        taken, self.clicks = [*beats, *self.clicks], []
        return taken

    def close(self):
        self.closed = True


class FakeExporter:
    """Notes what is asked for."""

    def __init__(self):
        self.state = ExportState()
        self.begun = []
        self.closed = False

    def begin(self, kind, ended, length):
        self.begun.append((kind, ended, length))

    def close(self):
        self.closed = True


class FakeSurveys:
    """Notes what is asked for; ``done`` is what has been made."""

    def __init__(self):
        self.begun = []
        self.done = []

    def begin(self, name, survey):
        self.begun.append((name, survey))

    def made(self):
        taken, self.done = self.done, []
        return taken

    def close(self):
        self.closed = True


class Station:
    """The service on a fake page, with scripted vehicles; ``run`` lets simulation and wall time pass alike."""

    def __init__(self, accept=True, site=None, listens=False):
        self.script = Script(accept=accept)
        self.page = FakePage()
        self.watch = LocalWatch(self.script.bus) if listens else FakeWatch()
        self.exporter = FakeExporter()
        self.surveys = FakeSurveys()
        self.site = site or demo_site()
        self.service = GroundStation(self.site, self.page, self.watch, self.exporter, self.surveys)
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

    def push(self, label, page=ME, seconds=0.1):
        """Presses the button with this label, as it is shown on a page."""
        self.press(action_in(json.dumps([1, *self.page.seen_by(page).words[label]]), page), seconds=seconds)

    def join_other(self):
        """The second browser comes, with another operator before it."""
        self.press(Join(OTHER), Hello(OTHER, OPERATORS[OTHER], ""))

    def go(self, x, y, page=ME):
        """Clicks a place as seen from the south-west, 10 m up, and chooses from its menu to go there."""
        self.press(click(x, y, page), Point(page, "go"))


def click(x, y, page=ME):
    """A click that looks at the point from the south-west, 10 m up."""
    return ClickGround(page, (x - 5.0, y - 7.0, 10.0), (5.0, 7.0, -10.0))
