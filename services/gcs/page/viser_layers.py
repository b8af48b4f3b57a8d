"""Check boxes for the layers of the scene: one browser's own, though the scene is everybody's."""

from collections.abc import Callable, Coroutine, Set
from typing import Any

import viser
from viser import _messages

from services.gcs.actions import Action, Layer
from services.gcs.state.session import ROOTS, SHOWN_AT_FIRST


class ViserLayers:
    """The visible layers of one browser."""

    def __init__(self, client: viser.ClientHandle, ask: Callable[[Action], None]) -> None:
        """ask: takes what is asked for with a click."""
        self._client = client
        self._ask = ask
        self._hidden: Set[str] = frozenset()
        with client.gui.add_folder("Layers", order=200, expand_by_default=False):
            for name in ROOTS:
                box = client.gui.add_checkbox(name, initial_value=name in SHOWN_AT_FIRST)
                box.on_update(self._showing(name))

    def _showing(self, name: str) -> Callable[[Any], Coroutine[Any, Any, None]]:
        """A coroutine, because viser runs those in the order of the clicks."""

        async def showing(event: Any) -> None:
            self._ask(Layer(self._client.client_id, name, bool(event.target.value)))

        return showing

    def show(self, hidden: Set[str]) -> None:
        """Hides these nodes, and what hangs below them, in this browser only; shows the others again."""
        for root in sorted(hidden ^ self._hidden):
            message = _messages.SetSceneNodeVisibilityMessage(root, root not in hidden)
            self._client._websock_connection.queue_message(message)
        self._hidden = hidden
