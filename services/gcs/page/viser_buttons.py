"""A row of command buttons on viser; sends only what has changed."""

from collections.abc import Callable, Sequence
from typing import Any

from services.gcs.actions import Action
from services.gcs.view.drawing import Button

PLACES = {"stop": 1.0, "release": 1.1, "cancel": 55.0}
"""Places in the panel of buttons, by the first word of their keys, that do not stand in the row: the cancelling one under the progress."""


class ViserButtons:
    """A row of buttons. gui: everybody's or one browser's; ask: takes the action of a click."""

    def __init__(self, gui: Any, ask: Callable[[Action], None]) -> None:
        self._gui = gui
        self._ask = ask
        self._shown: dict[str, tuple[Any, Button]] = {}

    def show(self, buttons: Sequence[Button]) -> None:
        """Shows these buttons, changing only what differs."""
        wanted = {button.key for button in buttons}
        for key in [key for key in self._shown if key not in wanted]:
            self._shown.pop(key)[0].remove()
        for i, button in enumerate(buttons):
            handle, before = self._shown.get(button.key, (None, None))
            if before is None:
                self._shown[button.key] = (self._add(button, 10.0 + i), button)
            elif before != button:
                self._shown[button.key] = (handle, button)
                _change(handle, before, button)

    def _add(self, button: Button, place: float) -> Any:
        place = PLACES.get(button.key.partition(" ")[0], place)
        handle = self._gui.add_button(button.label, order=place, hint=button.hint, color=_colour(button), disabled=not button.enabled)
        handle.on_click(self._pressing(button.key))
        return handle

    def _pressing(self, key: str) -> Callable[[Any], Any]:
        """What a button means is found when it is pressed: by then it may be another thing.

        A coroutine, because viser runs those in the order of the clicks, and plain functions in any order. A button that is
        gone or greyed out means nothing, whatever a client sends.
        """

        async def pressed(_: Any) -> None:
            button = self._shown[key][1] if key in self._shown else None
            if button is not None and button.enabled:
                self._ask(button.action)

        return pressed


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
