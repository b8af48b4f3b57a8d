"""A log as one file that plays it in any browser: the ground station runs on the log, and its pictures are kept instead of shown."""

import contextlib
import io
import json
import secrets
import socket
from collections.abc import Sequence
from math import inf
from pathlib import Path

from services.gcs.actions.page import Beat, Dress, Hello, Join, OpenTab, PageAction
from services.gcs.export import NoExporter
from services.gcs.page.viser_assets import STYLES, WEB
from services.gcs.page.viser_ground import dress, light
from services.gcs.page.viser_scene import ViserScene
from services.gcs.page.viser_server import guarded_server
from services.gcs.service import GroundStation
from services.gcs.surveying import SurveyProcess
from services.gcs.view.drawing import Picture
from services.gcs.view.scene.cameras import FOV, cameras
from services.gcs.watch import WatchedMessage
from uvf.models.scenario import Scenario
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.address import Address
from uvf.runtime.bus.interface import LocalBus, Sample
from uvf.runtime.contract.instances import ServiceInstance
from uvf.runtime.contract.service_runner import ServiceRunner
from uvf.runtime.log.reading import log_begin, log_end, read_log
from uvf.runtime.log.replay import hand_over, logged_site, play
from uvf.runtime.messages.step_times import NS, first_step_after

SLOTS = ("bar", "alerts", "fleet", "notices")
"""What stands beside the scene."""
CAPTIONS_EVERY = 0.5  # s
READER = 1
NOBODY = "0" * 32


class ReplayPage:
    """Keeps pictures as messages with their times, and the words beside them."""

    def __init__(self, site: Scenario, begin: float) -> None:
        """begin: s; what comes before is the first picture."""
        with socket.create_server(("127.0.0.1", 0)) as found:
            port = found.getsockname()[1]
        # The server is there only because viser makes its messages in one; nobody has its token.
        self._server = guarded_server(Address("127.0.0.1", port, secrets.token_urlsafe()), {})
        start, view = self._server.initial_camera, next(iter(cameras(site).values()))
        start.position, start.look_at, start.fov = view.position, view.look_at, FOV
        light(self._server.scene)
        dress(self._server.scene, "light")
        self._scene = ViserScene(self._server, lambda vehicle, event: None)
        self._serializer = self._server.get_scene_serializer()
        self._asked: list[PageAction] = [Join(READER), Hello(READER, NOBODY, ""), OpenTab(READER, "fly"), Dress(READER, "light")]
        self._begin = begin
        self._t = begin
        self._captions: list[tuple[float, dict[str, str]]] = []
        self._told: dict[str, str] = {}
        self._told_at = -inf

    def show(self, picture: Picture) -> None:
        """Keeps a picture."""
        panel = picture.panels.get(READER)
        if panel is None:
            return
        self._asked.append(Beat(READER, f"{panel.t:.3f}"))
        if panel.t > self._t:
            self._serializer.insert_sleep(panel.t - self._t)
            self._t = panel.t
        self._scene.show(picture.nodes, picture.places)
        if panel.t - self._told_at < CAPTIONS_EVERY:
            return
        self._told_at = panel.t
        words = {slot: str(panel.html[slot]) for slot in SLOTS if slot in panel.html}
        new = {slot: text for slot, text in words.items() if self._told.get(slot) != text}
        self._told |= new
        if new:
            self._captions.append((round(self._t - self._begin, 3), new))

    def actions(self) -> list[PageAction]:
        """As of a browser that only looks."""
        taken, self._asked = self._asked, []
        return taken

    def close(self) -> None:
        """Nothing to close before the page has been taken."""

    def html(self) -> str:
        """The whole page."""
        page: str = self._serializer.as_html()
        with contextlib.redirect_stdout(io.StringIO()):
            self._server.stop()
        styles = "".join((WEB / name).read_text(encoding="utf-8") for name in (*STYLES, "replay.css"))
        captions = json.dumps(self._captions).replace("<", "\\u003c")
        shell = (WEB / "replay.html").read_text(encoding="utf-8")
        script = (WEB / "replay.js").read_text(encoding="utf-8")
        own = f"{shell}<script>const CAPTIONS = {captions};\n{script}</script>"
        head, end, body = page.partition("</head>")
        inner, root, rest = body.partition('<div id="root"></div>')
        head = head.replace("<title>Viser</title>", "<title>UVF replay</title>", 1)
        return f"{head}<style>{styles}</style>{end}{inner}{root}{own}{rest}"


class _DeafWatch:
    """Nobody has the tab open for which the bus is watched."""

    def start(self) -> None:
        """Does nothing."""

    def stop(self) -> None:
        """Does nothing."""

    def samples(self) -> Sequence[WatchedMessage]:
        """None."""
        return ()

    def tokens(self) -> Sequence[str] | None:
        """None."""
        return None

    def close(self) -> None:
        """Does nothing."""


def write_replay(log: Path, target: Path) -> None:
    """Writes the page that plays a log. Raises BadInput."""
    begin, end = log_begin(log), log_end(log)
    if end is None:
        raise BadInput(f"log {log}: has no clock, so nothing moves in it")
    with logged_site(log) as site:
        page = ReplayPage(site, begin / NS)
        service = GroundStation(site, page, _DeafWatch(), NoExporter(), SurveyProcess())
        bus = LocalBus()
        shell = ServiceRunner(ServiceInstance(GroundStation, lambda: service, writes_for=tuple(site.members)), bus)
        shell.n = first_step_after(begin, shell.type.hz)

        def take(sample: Sample) -> None:
            if not sample.key.endswith(("/request", "/reply")):
                hand_over(bus, sample)

        for _ in play(shell, read_log(log), take, end):
            pass
        target.write_text(page.html(), encoding="utf-8")
