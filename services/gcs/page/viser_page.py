"""The page on viser: its picture; words and clicks go into a queue that the service reads in its step."""

import contextlib
import io
import queue
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import viser

from services.gcs.actions.page import ClickGround, Join, Leave, PageAction, Select
from services.gcs.page.viser_ground import light
from services.gcs.page.viser_panel import ViserPanel
from services.gcs.page.viser_scene import ViserScene
from services.gcs.page.viser_server import guarded_server
from services.gcs.state.session import LIVE_ROOTS, ROOTS
from services.gcs.view.drawing import CameraView, Picture
from services.gcs.view.scene.cameras import FOV
from uvf.runtime.bus.address import Address, claim

FAR = 20_000.0  # m
BRAND = (46, 120, 200)


class ViserPage:
    """The page: one server; every browser sees the same scene and a panel of its own.

    camera: where a browser looks from at first; downloads: files that it may take, by their paths on the server.
    """

    def __init__(self, address: Address, camera: CameraView, downloads: Mapping[str, Path]) -> None:
        claim(address)
        self._actions: queue.SimpleQueue[PageAction] = queue.SimpleQueue()
        self._server = guarded_server(address, downloads)
        self._panels: dict[int, ViserPanel] = {}
        self._picked: dict[int, tuple[float, float]] = {}
        self._server.gui.configure_theme(show_logo=False, show_share_button=False, brand_color=BRAND)
        start = self._server.initial_camera
        start.position, start.look_at, start.fov, start.far = camera.position, camera.look_at, FOV, FAR
        for root in sorted({*LIVE_ROOTS, *(root for roots in ROOTS.values() for root in roots)}):
            # There before a browser comes, which hides the whole of it.
            self._server.scene.add_frame(root, show_axes=False)
        light(self._server.scene)
        self._scene = ViserScene(self._server, self._on_pick)
        self._server.scene.on_click()(self._on_click)  # type: ignore[arg-type]
        self._server.on_client_connect(self._on_connect)
        self._server.on_client_disconnect(self._on_disconnect)

    async def _on_connect(self, client: viser.ClientHandle) -> None:
        """Its panel is made here, on viser's loop, where it cannot go away meanwhile."""
        self._panels[client.client_id] = ViserPanel(client, self._actions.put)
        self._actions.put(Join(client.client_id))

    async def _on_disconnect(self, client: viser.ClientHandle) -> None:
        self._panels.pop(client.client_id, None)
        self._picked.pop(client.client_id, None)
        self._actions.put(Leave(client.client_id))

    def _on_pick(self, vehicle: str, event: Any) -> None:
        self._picked[event.client_id] = event.screen_pos
        self._actions.put(Select(event.client_id, vehicle))

    async def _on_click(self, event: Any) -> None:
        """Any click; one on a vehicle has been taken already and points at no place."""
        if event.screen_pos != self._picked.pop(event.client_id, None):
            self._actions.put(ClickGround(event.client_id, event.ray_origin, event.ray_direction))

    def show(self, picture: Picture) -> None:
        """Shows a picture in all browsers."""
        with self._server.atomic():
            self._scene.show(picture.nodes, picture.places)
        for page, shown in picture.panels.items():
            panel = self._panels.get(page)
            if panel is not None:
                panel.show(shown)

    def actions(self) -> list[PageAction]:
        """Takes the actions asked for since the last call."""
        taken = []
        while not self._actions.empty():
            taken.append(self._actions.get())
        return taken

    def close(self) -> None:
        """Stops the server."""
        with contextlib.redirect_stdout(io.StringIO()):
            self._server.stop()
