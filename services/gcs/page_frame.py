"""Puts the picture of one step together: scene at the page's full rate, words at a fifth to a half of it."""

from collections.abc import Callable

from services.gcs import panels
from services.gcs.commands import MODES, Arm, Commander, SetMode, StopAll, mode_name
from services.gcs.drawing import Button, Picture, Toast
from services.gcs.overview import Overview
from services.gcs.state import Model
from services.gcs.view import View

FAST, SLOW = 2, 4
"""Steps between two drawings of the instruments, and of everything that is read slowly."""


class Composer:
    def __init__(self, model: Model, commander: Commander) -> None:
        self._model = model
        self._commander = commander
        self._view = View(model)
        self._overview = Overview(model)
        self._html: dict[str, str] = {}
        self._step = 0

    def picture(self, t: float, toasts: list[Toast]) -> Picture:
        """What to show at ``t`` [s, wall]."""
        chosen = self._model.chosen
        slow: dict[str, Callable[[], str]] = {
            "bar": lambda: panels.status_bar(self._model, t),
            "fleet": lambda: panels.fleet(self._model, t),
            "facts": lambda: panels.facts(chosen, t) if chosen is not None else "",
            "overview": self._overview.svg,
            "log": lambda: panels.event_log(self._model.log),
            "processes": lambda: panels.processes(self._model),
        }
        if self._step % FAST == 0 and chosen is not None:
            self._html["instrument"] = panels.instrument(chosen)
        name = list(slow)[self._step % len(slow)]
        for each in slow if self._step == 0 else (name,):
            self._html[each] = slow[each]()
        self._step += 1
        image = chosen.image.data if chosen is not None and chosen.image is not None else None
        return Picture(self._view.nodes(t), self._view.places(), dict(self._html), self.buttons(t), image, toasts)

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
        mode = mode_name(v.status.mode) if v.status is not None else ""
        shown += [
            Button(f"mode {name}", name, SetMode(name), f"{v.name}: mode {name}", lit=name == mode) for name in MODES[v.member.file.kind]
        ]
        armed = v.status is not None and v.status.armed
        word = "Disarm" if armed else "Arm"
        sure = self._commander.waits_for_confirmation(v.name, not armed, t)
        label, colour = (f"Confirm: {word.lower()} {v.name}", "orange") if sure else (f"{word} {v.name}", "")
        shown.append(Button("arm", label, Arm(not armed), "Asks for a second click", colour=colour))
        return shown
