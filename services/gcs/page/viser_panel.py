"""What one browser alone is shown on viser, and hears from it: its vehicle's words, buttons, camera, its layers, and its own script."""

import time
from collections.abc import Callable, Mapping
from typing import Any

import viser
from viser import _messages

from services.gcs.actions import Action
from services.gcs.page.viser_buttons import ViserButtons
from services.gcs.page.viser_cameras import ViserCameras
from services.gcs.page.viser_layers import ViserLayers
from services.gcs.page.viser_script import action_in, bar_source, padded, script, shape_in
from services.gcs.view.drawing import PagePanel
from services.gcs.view.markup import Html

BEAT = 1.0  # s between two signs of life to the page
IN_FLEET = {"bar": 0.0, "fleet": 2.0, "orders": 50.0, "wheel": 60.0, "overview": 150.0}
IN_TAB = {"instrument": 1.0, "facts": 100.0}
"""Words -> their place among the rest."""


class ViserPanel:
    """A browser's own panel. ask: takes actions; reshape: takes the window's aspect ratio, and whether nobody has turned its view."""

    def __init__(
        self, client: viser.ClientHandle, tab: Any, ask: Callable[[Action], None], reshape: Callable[[Any, float, bool], None]
    ) -> None:
        self._client = client
        self._ask = ask
        self._reshape = reshape
        self._sent: dict[str, Html] = {}
        self._beat = 0.0
        self.vehicle = ""
        """The one on show: what is clicked is meant for it."""
        gui = client.gui
        self._buttons = ViserButtons(gui, ask)
        self._layers = ViserLayers(client, ask)
        self._html: dict[str, Any] = {name: gui.add_html("", order=place) for name, place in IN_FLEET.items()}
        with tab:
            self._html |= {name: gui.add_html("", order=place) for name, place in IN_TAB.items()}
            self._cameras = ViserCameras(gui, ask)
        self._html["cameras"] = self._cameras.words
        bridge = gui.add_text("page", "", visible=False)
        bridge.on_update(self._on_word)
        self._bridge = bridge._impl.uuid
        client._websock_connection.queue_message(_messages.RunJavascriptMessage(source=script(self._bridge)))

    async def _on_word(self, event: Any) -> None:
        """What the page's own script says."""
        shape = shape_in(event.target.value)
        action = action_in(event.target.value, self._client.client_id, self.vehicle)
        if action is not None:
            self._ask(action)
        elif shape is not None:
            self._reshape(self._client, *shape)

    def show(self, panel: PagePanel) -> None:
        """Shows the panel; writing to a browser that has gone meanwhile is no fault."""
        try:
            with self._client._websock_connection.get_message_buffer().sanctioned_dead_writes(), self._client.atomic():
                self.vehicle = panel.vehicle
                self._show_html(panel.html)
                self._buttons.show(panel.buttons)
                self._cameras.show(panel)
                self._layers.show(panel.hidden)
        except RuntimeError:
            # viser's own thread takes away what a browser had as it goes, and refuses to write to it.
            if not any(words._impl.removed for words in self._html.values()):
                raise

    def _show_html(self, shown: Mapping[str, Html]) -> None:
        now = time.monotonic()
        for name, content in shown.items():
            beats = name == "bar" and now - self._beat > BEAT
            if content == self._sent.get(name) and not beats:
                continue
            self._sent[name] = content
            if name == "bar":
                self._beat = now
                self._html[name].content = bar_source(content, int(now * 1000), self._bridge)
            else:
                self._html[name].content = padded(content)
