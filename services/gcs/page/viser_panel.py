"""What one browser alone is shown on viser, and hears from it: markup for the slots of its page, its view, its layers, its own scene."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import viser
from viser import _messages

from services.gcs.actions.page import PageAction
from services.gcs.page.viser_ground import dress
from services.gcs.page.viser_scene import ViserScene
from services.gcs.page.words import action_in
from services.gcs.view.drawing import CameraView, PagePanel
from services.gcs.view.markup import Html, html

BEAT = 0.5  # s between two signs of life to the page
NEAR = 0.2  # m
SETTLES = 0.5  # s that a browser has to say where its camera is


class ViserPanel:
    """A browser's own panel. ask: takes what it asks for."""

    def __init__(self, client: viser.ClientHandle, ask: Callable[[PageAction], None]) -> None:
        self._client = client
        self._ask = ask
        self._slots: dict[str, Any] = {}
        self._sent: dict[str, Html] = {}
        self._beat = -BEAT
        self._hidden: frozenset[str] = frozenset()
        self._looked = (-1, -SETTLES)
        self._theme = ""
        with client._websock_connection.get_message_buffer().sanctioned_dead_writes():
            bridge = client.gui.add_text("page", "", visible=False)
        bridge.on_update(self._on_word)
        self._bridge = bridge._impl.uuid
        self._scene = ViserScene(client, lambda vehicle, event: None)

    async def _on_word(self, event: Any) -> None:
        """What the page's own script says. A coroutine, because viser runs those in the order of the words."""
        action = action_in(event.target.value, self._client.client_id)
        if action is not None:
            self._ask(action)

    def show(self, panel: PagePanel) -> None:
        """Shows the panel; writing to a browser that has gone meanwhile is no fault."""
        try:
            with self._client._websock_connection.get_message_buffer().sanctioned_dead_writes(), self._client.atomic():
                self._show_html(panel.html, panel.t)
                self._show_layers(panel.hidden)
                self._scene.show(panel.nodes, panel.places)
                if panel.theme != self._theme:
                    self._theme = panel.theme
                    dress(self._client.scene, panel.theme)
                self._look(panel)
        except RuntimeError:
            # viser's own thread takes away what a browser had as it goes, and refuses to write to it.
            if not any(slot._impl.removed for slot in self._slots.values()):
                raise

    def _show_html(self, shown: Mapping[str, Html], t: float) -> None:
        """Each slot's markup travels in a template, which the page's script reads and the browser does not draw."""
        for name, content in shown.items():
            beats = name == "bar" and t - self._beat >= BEAT
            if content == self._sent.get(name) and not beats:
                continue
            self._sent[name] = content
            if beats:
                self._beat = t
            about = html(" data-beat='{:.3f}' data-bridge='{}'", self._beat, self._bridge) if name == "bar" else html("")
            source = str(html("<template data-slot='{}'{}>{}</template>", name, about, content))
            if name in self._slots:
                self._slots[name].content = source
            else:
                self._slots[name] = self._client.gui.add_html(source)

    def _show_layers(self, hidden: frozenset[str]) -> None:
        """Hides these nodes, and what hangs below them, in this browser only; shows the others again."""
        for root in sorted(hidden ^ self._hidden):
            message = _messages.SetSceneNodeVisibilityMessage(root, root not in hidden)
            self._client._websock_connection.queue_message(message)
        self._hidden = hidden

    def _look(self, panel: PagePanel) -> None:
        """Sets the camera when a view is chosen, and again when the window's shape has changed what fits into it."""
        camera, (chosen, at) = panel.camera, self._looked
        if camera is None or (chosen == panel.views_chosen and (panel.t - at < SETTLES or self._is_at(camera))):
            return
        self._looked = (panel.views_chosen, panel.t)
        self._client.camera.position, self._client.camera.look_at = camera.position, camera.look_at

    def _is_at(self, camera: CameraView) -> bool:
        return bool(np.allclose(self._client.camera.position, camera.position, rtol=0, atol=NEAR))
