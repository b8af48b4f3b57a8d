"""Puts the picture of one step together: scene at the page's full rate, words at a fifth to a half of it."""

from collections.abc import Callable

from schemas.messages import ModeRequest
from services.gcs import camera_panel, panels, records, status, wheel
from services.gcs.commands import Arm, Cancel, Commander, SetMode, StopAll, describe, modes_of
from services.gcs.drawing import Button, Picture
from services.gcs.overview import Overview
from services.gcs.state import Model
from services.gcs.view import View

FAST = 2
"""Steps between two drawings of what tells at once; of the rest one is drawn with each step."""


class Composer:
    def __init__(self, model: Model, commander: Commander) -> None:
        self._model = model
        self._commander = commander
        self._view = View(model)
        self._overview = Overview(model)
        self._html: dict[str, str] = {}
        self._step = 0

    def picture(self, t: float) -> Picture:
        """What to show at ``t`` [s, wall]."""
        chosen = self._model.chosen
        fast: dict[str, Callable[[], str]] = {
            "bar": lambda: status.status_bar(self._model, t),
            "stop": lambda: status.stop_line(self._model),
            "orders": lambda: panels.orders(chosen) if chosen is not None else "",
            "wheel": lambda: wheel.wheel(chosen, self._commander.by_hand) if chosen is not None else "",
            "instrument": lambda: panels.instrument(chosen) if chosen is not None else "",
        }
        slow: dict[str, Callable[[], str]] = {
            "fleet": lambda: panels.fleet(self._model, t),
            "cameras": lambda: camera_panel.panel(self._model, t),
            "facts": lambda: panels.facts(chosen, t) if chosen is not None else "",
            "overview": self._overview.svg,
            "log": lambda: records.event_log(self._model.log),
            "processes": lambda: records.processes(self._model, t),
        }
        due = fast if self._step % FAST == 0 else {}
        turn = list(slow)[self._step % len(slow)]
        due = {**due, **(slow if self._step == 0 else {turn: slow[turn]})}
        self._html.update((name, draw()) for name, draw in due.items())
        self._step += 1
        image, gimbal = camera_panel.picture(self._model, t), camera_panel.gimbal_panel(self._model)
        return Picture(self._view.nodes(t), self._view.places(), dict(self._html), self.buttons(t), image, gimbal)

    def buttons(self, t: float) -> list[Button]:
        """The commands that make sense for the chosen vehicle, and STOP ALL, which always does."""
        stopped, v = self._model.stopped, self._model.chosen
        shown = [
            Button("stop", "STOP ALL", StopAll(True), "Ground vehicles stop, aircraft hold", lit=stopped, colour="red"),
            Button(
                "release",
                "Release STOP",
                StopAll(False),
                "Vehicles obey commands again",
                enabled=stopped,
                colour="yellow" if stopped else "",
            ),
        ]
        if v is None:
            return shown
        mode = v.status.mode if v.status is not None else None
        shown += [
            Button(f"mode {name}", name, SetMode(name), f"{v.name}: {describe(ModeRequest(mode=value))}", lit=value == mode)
            for name, value in modes_of(v).items()
        ]
        armed = v.status is not None and v.status.armed
        word = "Disarm" if armed else "Arm"
        sure = self._commander.waits_for_confirmation(v.name, not armed, t)
        label, colour = (f"Confirm: {word.lower()} {v.name}", "orange") if sure else (f"{word} {v.name}", "")
        shown.append(Button("arm", label, Arm(not armed), "Asks for a second click", colour=colour))
        if panels.drives_to_goal(v):
            shown.append(Button("cancel", "Cancel goal", Cancel(), f"{v.name} stops and goes back to its job"))
        return shown
