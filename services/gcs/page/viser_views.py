"""The named views, fitted to each browser's own window, which tells its shape late and may be resized."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import viser
from viser import _messages

from services.gcs.page.viser_script import follow
from services.gcs.view.drawing import CameraView

Views = Callable[[float], Mapping[str, CameraView]]
"""Width by height of a window -> its named views, the opening one first."""
FOLLOW = "Follow"
NEAR = 0.2  # m


class ViserViews:
    """The views of each browser. One that nobody has moved since it was chosen is refitted when the window's shape changes."""

    def __init__(self, server: viser.ViserServer, views: Views) -> None:
        self._views = views
        self._chosen: dict[int, str] = {}
        self._shapes: dict[int, float] = {}
        self._first = next(iter(views(1.0)))
        self.names = (*views(1.0), FOLLOW)
        server.on_client_connect(self._begin)
        server.on_client_disconnect(self._end)

    async def _begin(self, client: viser.ClientHandle) -> None:
        self._look(client, self._first)

    async def _end(self, client: viser.ClientHandle) -> None:
        self._chosen.pop(client.client_id, None)
        self._shapes.pop(client.client_id, None)

    async def choose(self, event: Any) -> None:
        """Handles a click on the row of views, for the page that was clicked only."""
        name = event.target.value
        if name not in self.names:
            return
        event.client._websock_connection.queue_message(_messages.RunJavascriptMessage(source=follow(name == FOLLOW)))
        if name == FOLLOW:
            self._chosen.pop(event.client.client_id, None)
        else:
            self._look(event.client, name)

    def reshape(self, client: Any, shape: float, untouched: bool) -> None:
        """Takes a page's aspect ratio ``shape``, width over height [-], and whether nobody has turned its view by hand."""
        self._shapes[client.client_id] = shape
        name = self._chosen.get(client.client_id)
        if name is None or not untouched:
            return
        if not np.allclose(client.camera.position, self._views(shape)[name].position, rtol=0, atol=NEAR):
            self._look(client, name)

    def _look(self, client: Any, name: str) -> None:
        view = self._views(self._shapes.get(client.client_id, client.camera.aspect))[name]
        self._chosen[client.client_id] = name
        with client.atomic():
            client.camera.position, client.camera.look_at = view.position, view.look_at
