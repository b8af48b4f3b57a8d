"""The page on viser: panels, buttons, picture; clicks go into a queue that the service reads in its step."""

import contextlib
import io
import json
import logging
import queue
import time
from collections.abc import Callable, Coroutine, Mapping, Sequence, Set
from typing import Any

import numpy as np
import viser
import websockets.asyncio.server as websocket_server
from numpy.typing import NDArray
from viser import _messages

from services.gcs import panels, viser_join
from services.gcs.cameras import FOV
from services.gcs.commands import Action, ClickGround, Layer, Select
from services.gcs.drawing import Button, Camera, Picture
from services.gcs.guard import Guard
from services.gcs.state import LAYERS
from services.gcs.viser_cameras import ViserCameras
from services.gcs.viser_scene import ViserScene
from services.gcs.viser_script import action_in, bar_source, padded, script, shape_in
from services.gcs.viser_views import Views, ViserViews
from uvf.runtime.address import Address, claim
from uvf.runtime.params import BadInput

FLEET_WIDTH, VEHICLE_WIDTH = 270, 350
BEAT = 1.0  # s between two signs of life to the page
ORDERS = {"stop": 1.0, "release": 1.1, "cancel": 55.0}
"""Places in the panel of buttons that do not stand in the row of commands: the cancelling one under the goal's progress."""


class ViserPage:
    """One server; every browser sees the same picture. views: see ``viser_views``."""

    def __init__(self, address: Address, views: Views, layers: Set[str]) -> None:
        claim(address)
        self._actions: queue.SimpleQueue[Action] = queue.SimpleQueue()
        self._server = _guarded_server(address)
        self._html: dict[str, Any] = {}
        self._sent: dict[str, str] = {}
        self._buttons: dict[str, tuple[Any, Button]] = {}
        self._meaning: dict[str, Action] = {}
        self._picked: tuple[float, float] | None = None
        self._beat = 0.0
        self._scene = ViserScene(self._server, self._on_pick)
        self._surroundings(next(iter(views(1.0).values())))
        self._views = ViserViews(self._server, views)
        self._fleet_panel(layers)
        self._vehicle_panel()
        self._listen()

    def _surroundings(self, camera: Camera) -> None:
        gui, scene = self._server.gui, self._server.scene
        gui.configure_theme(dark_mode=True, show_logo=False, show_share_button=False, brand_color=(46, 120, 200))
        gui.set_panel_label("Fleet")
        start = self._server.initial_camera
        start.position, start.look_at, start.fov, start.far = camera.position, camera.look_at, FOV, 5000.0
        scene.add_grid(
            "/world/ground",
            infinite_grid=True,
            cell_size=10.0,
            section_size=100.0,
            cell_color=(66, 80, 100),
            section_color=(96, 114, 140),
            cell_thickness=0.8,
            section_thickness=1.2,
            fade_distance=900.0,
            plane_color=(22, 30, 42),
            plane_opacity=1.0,
            position=(0, 0, -0.12),
        )
        scene.configure_environment_map(hdri=None)
        scene.set_background_image(sky(), format="png")
        scene.add_light_ambient("/world/ambient", intensity=0.7)
        scene.add_light_hemisphere("/world/sky", sky_color=(235, 242, 255), ground_color=(120, 110, 100), intensity=1.6)

    def _fleet_panel(self, layers: Set[str]) -> None:
        gui = self._server.gui
        gui.main_panel.dock_left()
        gui.main_panel.set_width(FLEET_WIDTH)
        self._html["bar"] = gui.add_html(bar_source("", 0), order=0)
        self._html["stop"] = gui.add_html("", order=1.5)
        self._html["fleet"] = gui.add_html("", order=2)
        self._html["orders"] = gui.add_html("", order=50)
        self._html["wheel"] = gui.add_html("", order=60)
        gui.add_button_group("View", self._views.names, order=100).on_click(self._views.choose)
        self._html["overview"] = gui.add_html("", order=150)
        with gui.add_folder("Layers", order=200, expand_by_default=False):
            for name in LAYERS:
                box = gui.add_checkbox(name, initial_value=name in layers)
                box.on_update(self._asking(lambda event, n=name: Layer(n, bool(event.target.value))))  # type: ignore[misc]

    def _vehicle_panel(self) -> None:
        gui = self._server.gui
        panel = gui.add_panel()
        with panel.add_tab("Vehicle", viser.Icon.GAUGE):
            self._html["instrument"] = gui.add_html("", order=1)
            self._html["facts"] = gui.add_html("", order=100)
            self._cameras = ViserCameras(self._server, self._actions.put)
            self._html["cameras"] = self._cameras.words
        with panel.add_tab("Log", viser.Icon.LIST):
            self._html["log"] = gui.add_html("")
        with panel.add_tab("System", viser.Icon.CPU):
            self._html["processes"] = gui.add_html("")
        with panel.add_tab("Help", viser.Icon.HELP):
            gui.add_html(padded(panels.HELP.read_text(encoding="utf-8")))
        panel.dock_right()
        panel.set_width(VEHICLE_WIDTH)

    def _listen(self) -> None:
        self._server.scene.on_click()(self._on_click)  # type: ignore[arg-type]
        bridge = self._server.gui.add_text("page", "", visible=False)
        bridge.on_update(self._on_word)
        self._server._websock_server.queue_message(_messages.RunJavascriptMessage(source=script(bridge._impl.uuid)))

    async def _on_word(self, event: Any) -> None:
        """What the page's own script says."""
        shape, action = shape_in(event.target.value), action_in(event.target.value)
        if action is not None:
            self._actions.put(action)
        elif shape is not None and event.client is not None:
            self._views.reshape(event.client, *shape)

    def _asking(self, action: Callable[[Any], Action]) -> Callable[[Any], Coroutine[Any, Any, None]]:
        """A callback that queues an action, found when it is called: the same button may by then mean another.

        It is a coroutine because viser runs those in the order of the clicks, and plain functions in any order.
        """

        async def asked(event: Any) -> None:
            self._actions.put(action(event))

        return asked

    def _on_pick(self, vehicle: str, event: Any) -> None:
        self._picked = event.screen_pos
        self._actions.put(Select(vehicle))

    async def _on_click(self, event: Any) -> None:
        """Any click; one on a vehicle has been taken already and sends nobody anywhere."""
        if event.screen_pos != self._picked:
            self._actions.put(ClickGround(event.ray_origin, event.ray_direction))
        self._picked = None

    def show(self, picture: Picture) -> None:
        with self._server.atomic():
            self._scene.show(picture.nodes, picture.places)
            self._show_html(picture.html)
            self._show_buttons(picture.buttons)
            self._cameras.show(picture)

    def _show_html(self, html: Mapping[str, str]) -> None:
        now = time.monotonic()
        for name, content in html.items():
            beats = name == "bar" and now - self._beat > BEAT
            if content == self._sent.get(name) and not beats:
                continue
            self._sent[name] = content
            if name == "bar":
                self._beat = now
                content = bar_source(content, int(now * 1000))
            self._html[name].content = content if name == "bar" else padded(content)

    def _show_buttons(self, buttons: Sequence[Button]) -> None:
        wanted = {b.key: b for b in buttons}
        self._meaning.update((b.key, b.action) for b in buttons)
        for key in [k for k in self._buttons if k not in wanted]:
            self._buttons.pop(key)[0].remove()
        for i, button in enumerate(buttons):
            before = self._buttons.get(button.key)
            if before is None:
                order = ORDERS.get(button.key, 10.0 + i)
                handle = self._server.gui.add_button(
                    button.label, order=order, hint=button.hint, color=_colour(button), disabled=not button.enabled
                )
                handle.on_click(self._asking(lambda event, key=button.key: self._meaning[key]))  # type: ignore[misc]
                self._buttons[button.key] = (handle, button)
            elif before[1] != button:
                self._buttons[button.key] = (before[0], button)
                _change(before[0], before[1], button)

    def actions(self) -> list[Action]:
        taken = []
        while not self._actions.empty():
            taken.append(self._actions.get())
        return taken

    def close(self) -> None:
        with contextlib.redirect_stdout(io.StringIO()):
            self._server.stop()


def sky() -> NDArray[np.uint8]:
    """A dusk that leaves the ground's haze at the horizon: (64, 4, 3)."""
    share = np.linspace(0, 1, 64)[:, None, None] ** 1.5
    return np.tile(np.array((10, 17, 32)) * (1 - share) + np.array((74, 98, 134)) * share, (1, 4, 1)).astype(np.uint8)


def _colour(button: Button) -> Any:
    if button.colour:
        return button.colour
    return "green" if button.lit else "gray"


def _change(handle: Any, old: Button, new: Button) -> None:
    if old.label != new.label:
        handle.label = new.label
    if _colour(old) != _colour(new):
        handle.color = _colour(new)
    if old.enabled != new.enabled:
        handle.disabled = not new.enabled


def _guarded_server(address: Address) -> viser.ViserServer:
    """viser's server behind the guard: websockets' ``serve``, which viser looks up when it starts, is wrapped meanwhile."""
    viser_join.apply()
    logging.getLogger("websockets.server").setLevel(logging.CRITICAL)  # a browser's idle connection is not worth a traceback
    guard = Guard(address.port, address.token, lambda: json.dumps({"status": "ok"}).encode())
    plain = websocket_server.serve

    def serve(*args: Any, process_request: Any = None, **kwargs: Any) -> Any:
        return plain(*args, process_request=guard.wrap(process_request), **kwargs)

    websocket_server.serve = serve  # type: ignore[assignment, misc]
    try:
        with contextlib.redirect_stdout(io.StringIO()):  # viser prints a box of its own even when told to be quiet
            server = viser.ViserServer(address.host, address.port, verbose=False)
    finally:
        websocket_server.serve = plain  # type: ignore[misc]
    server._websock_server.unregister_handler(_messages.ShareUrlRequest)
    if server.get_port() != address.port:
        server.stop()
        raise BadInput(f"gcs: port {address.port} is taken; choose another, for example UVF_GCS_PORT=8081")
    return server
