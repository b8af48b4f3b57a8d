"""The named views, fitted to each browser's own window, which tells its shape late and may be resized."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import viser
from viser import _messages

from services.gcs.drawing import Camera
from services.gcs.viser_script import follow

Views = Callable[[float], Mapping[str, Camera]]
"""Width by height of a window -> its named views, the opening one first."""
FOLLOW = "Follow"
SAME = 0.02  # m, and share of the window's shape


class ViserViews:
    """A view that nobody has moved since it was chosen is fitted anew when the window's shape changes."""

    def __init__(self, server: viser.ViserServer, views: Views) -> None:
        self._views = views
        self._chosen: dict[int, tuple[str, float, Camera]] = {}
        self._first = next(iter(views(1.0)))
        self.names = (*views(1.0), FOLLOW)
        server.on_client_connect(self._begin)
        server.on_client_disconnect(self._end)

    async def _begin(self, client: viser.ClientHandle) -> None:
        self._look(client, self._first)
        client.camera.on_update(self._moved)

    async def _end(self, client: viser.ClientHandle) -> None:
        self._chosen.pop(client.client_id, None)

    async def choose(self, event: Any) -> None:
        """A click on the row of views: it counts for the page that asked alone."""
        name = event.target.value
        event.client._websock_connection.queue_message(_messages.RunJavascriptMessage(source=follow(name == FOLLOW)))
        if name == FOLLOW:
            self._chosen.pop(event.client.client_id, None)
        else:
            self._look(event.client, name)

    async def _moved(self, camera: Any) -> None:
        client = camera.client
        if client.client_id not in self._chosen:
            return
        name, aspect, view = self._chosen[client.client_id]
        if not np.allclose(camera.position, view.position, rtol=0, atol=SAME * 10):
            del self._chosen[client.client_id]
        elif abs(camera.aspect / aspect - 1) > SAME:
            self._look(client, name)

    def _look(self, client: Any, name: str) -> None:
        aspect = client.camera.aspect
        view = self._views(aspect)[name]
        self._chosen[client.client_id] = (name, aspect, view)
        with client.atomic():
            client.camera.position, client.camera.look_at = view.position, view.look_at
