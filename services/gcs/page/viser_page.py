"""The page on viser: panels, buttons, picture; clicks go into a queue that the service reads in its step."""

import contextlib
import io
import queue
from collections.abc import Mapping
from typing import Any

import numpy as np
import viser
from numpy.typing import NDArray

from services.gcs.actions import Action, ClickGround, Join, Leave, Select
from services.gcs.page.viser_buttons import ViserButtons
from services.gcs.page.viser_panel import ViserPanel
from services.gcs.page.viser_scene import ViserScene
from services.gcs.page.viser_script import padded
from services.gcs.page.viser_server import guarded_server
from services.gcs.page.viser_views import Views, ViserViews
from services.gcs.view import panels
from services.gcs.view.cameras import FOV
from services.gcs.view.drawing import CameraView, Picture
from services.gcs.view.markup import Html, trusted
from uvf.runtime.bus.address import Address, claim

FLEET_WIDTH, VEHICLE_WIDTH = 270, 350


class ViserPage:
    """The page: one server; every browser sees the same scene and a panel of its own. views: see ``viser_views``."""

    def __init__(self, address: Address, views: Views) -> None:
        claim(address)
        self._actions: queue.SimpleQueue[Action] = queue.SimpleQueue()
        self._server = guarded_server(address)
        self._html: dict[str, Any] = {}
        self._sent: dict[str, Html] = {}
        self._panels: dict[int, ViserPanel] = {}
        self._picked: dict[int, tuple[float, float]] = {}
        self._scene = ViserScene(self._server, self._on_pick)
        self._buttons = ViserButtons(self._server.gui, self._actions.put)
        self._surroundings(next(iter(views(1.0).values())))
        self._views = ViserViews(self._server, views)
        self._fleet_panel()
        self._vehicle_panel()
        self._server.scene.on_click()(self._on_click)  # type: ignore[arg-type]
        self._server.on_client_connect(self._on_connect)
        self._server.on_client_disconnect(self._on_disconnect)

    def _surroundings(self, camera: CameraView) -> None:
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

    def _fleet_panel(self) -> None:
        gui = self._server.gui
        gui.main_panel.dock_left()
        gui.main_panel.set_width(FLEET_WIDTH)
        self._html["stop"] = gui.add_html("", order=1.5)
        gui.add_button_group("View", self._views.names, order=100).on_click(self._views.choose)

    def _vehicle_panel(self) -> None:
        gui = self._server.gui
        panel = gui.add_panel()
        self._tab = panel.add_tab("Vehicle", viser.Icon.GAUGE)
        with panel.add_tab("Log", viser.Icon.LIST):
            self._html["log"] = gui.add_html("")
        with panel.add_tab("System", viser.Icon.CPU):
            self._html["processes"] = gui.add_html("")
        with panel.add_tab("Help", viser.Icon.HELP):
            gui.add_html(padded(trusted(panels.HELP.read_text(encoding="utf-8"))))
        panel.dock_right()
        panel.set_width(VEHICLE_WIDTH)

    async def _on_connect(self, client: viser.ClientHandle) -> None:
        """Its panel is made here, on viser's loop, where it cannot go away meanwhile."""
        self._panels[client.client_id] = ViserPanel(client, self._tab, self._actions.put, self._views.reshape)
        self._actions.put(Join(client.client_id))

    async def _on_disconnect(self, client: viser.ClientHandle) -> None:
        self._panels.pop(client.client_id, None)
        self._picked.pop(client.client_id, None)
        self._actions.put(Leave(client.client_id))

    def _on_pick(self, vehicle: str, event: Any) -> None:
        self._picked[event.client_id] = event.screen_pos
        self._actions.put(Select(event.client_id, vehicle))

    async def _on_click(self, event: Any) -> None:
        """Any click; one on a vehicle has been taken already and sends nobody anywhere."""
        panel = self._panels.get(event.client_id)
        if event.screen_pos != self._picked.pop(event.client_id, None) and panel is not None:
            self._actions.put(ClickGround(panel.vehicle, event.ray_origin, event.ray_direction))

    def show(self, picture: Picture) -> None:
        """Shows a picture in all browsers."""
        with self._server.atomic():
            self._scene.show(picture.nodes, picture.places)
            self._show_html(picture.html)
            self._buttons.show(picture.buttons)
        for page, shown in picture.panels.items():
            panel = self._panels.get(page)
            if panel is not None:
                panel.show(shown)

    def _show_html(self, shown: Mapping[str, Html]) -> None:
        for name, content in shown.items():
            if content != self._sent.get(name):
                self._sent[name] = content
                self._html[name].content = padded(content)

    def actions(self) -> list[Action]:
        """Takes the actions asked for since the last call."""
        taken = []
        while not self._actions.empty():
            taken.append(self._actions.get())
        return taken

    def close(self) -> None:
        """Stops the server."""
        with contextlib.redirect_stdout(io.StringIO()):
            self._server.stop()


def sky() -> NDArray[np.uint8]:
    """Background image (64, 4, 3) RGB: a dusk that ends in the ground's haze at the horizon."""
    share = np.linspace(0, 1, 64)[:, None, None] ** 1.5
    return np.tile(np.array((10, 17, 32)) * (1 - share) + np.array((74, 98, 134)) * share, (1, 4, 1)).astype(np.uint8)
