"""Puts the picture of one step together: scene at the page's full rate, words at a fifth to a half of it; for each browser its own."""

from collections.abc import Callable, Mapping
from typing import Any

from schemas.messages import ModeRequest
from services.gcs.actions import Arm, Cancel, SetMode, StopAll
from services.gcs.commands import Commander
from services.gcs.state.session import BrowserSession, hidden_roots
from services.gcs.state.state import Model, VehicleModel
from services.gcs.state.wording import describe, modes_of
from services.gcs.view import camera_panel, panels, records, status, teleoperation
from services.gcs.view.drawing import Button, PagePanel, Picture
from services.gcs.view.markup import Html, html
from services.gcs.view.overview import Overview
from services.gcs.view.view import SceneView

FAST = ("stop", "bar", "orders", "wheel", "instrument")
EVERY = 2
"""Steps between two drawings of these, which tell at once; of the rest one is drawn with each step."""
OF_VEHICLE = ("orders", "wheel", "instrument", "fleet", "cameras", "facts")
SLOW = ("fleet", "cameras", "facts", "overview", "log", "processes")

Draw = Callable[[], Html]


class Composer:
    """Composes what the page shows from the state of the ground station."""

    def __init__(self, model: Model, commander: Commander) -> None:
        self._model = model
        self._commander = commander
        self._view = SceneView(model)
        self._overview = Overview(model)
        self._html: dict[str, Html] = {}
        self._own: dict[int, tuple[str, dict[str, Html]]] = {}
        """Page -> the vehicle that it showed, and what it showed of it."""
        self._drawn: dict[tuple[str, str], Html] = {}
        """What has been drawn in this step: (what, of which vehicle); browsers that show the same share it."""
        self._step = 0

    def picture(self, t: float) -> Picture:
        """The picture to show at ``t`` [s, wall]."""
        self._drawn.clear()
        self._html.update(self._due(self._shared(t), everything=self._step == 0))
        self._own = {page: own for page, own in self._own.items() if page in self._model.sessions}
        shown = {page: self._panel(session, t) for page, session in self._model.sessions.items()}
        self._step += 1
        return Picture(self._view.nodes(t), self._view.places(), dict(self._html), self._stop_buttons(), shown)

    def _due(self, draws: Mapping[str, Draw], everything: bool) -> dict[str, Html]:
        turn = SLOW[self._step % len(SLOW)]
        due = {name for name in draws if everything or name == turn or (name in FAST and self._step % EVERY == 0)}
        return {name: draws[name]() for name in draws if name in due}

    def _shared(self, t: float) -> dict[str, Draw]:
        return {
            "stop": lambda: status.stop_line(self._model),
            "log": lambda: records.event_log(self._model.log),
            "processes": lambda: records.processes(self._model, t),
        }

    def _panel(self, session: BrowserSession, t: float) -> PagePanel:
        """Drawn as a whole when another vehicle comes on show: never the words about one under the name of another."""
        chosen = self._model.chosen_by(session)
        before, words = self._own.get(session.page, ("", {}))
        new = not words or before != session.vehicle
        words = {**({} if new else words), **self._due(self._words(session, chosen, t), new)}
        self._own[session.page] = (session.vehicle, words)
        hidden = hidden_roots(session.layers)
        if chosen is None:
            return PagePanel(html=words, hidden=hidden)
        image, gimbal = camera_panel.picture(chosen, session, t), camera_panel.gimbal_panel(chosen, session)
        return PagePanel(chosen.name, words, self._buttons(session, chosen, t), image, gimbal, hidden)

    def _words(self, session: BrowserSession, v: VehicleModel | None, t: float) -> dict[str, Draw]:
        bar = self._once("bar", v, lambda: status.status_bar(self._model, v, t))
        overview = self._once("overview", v, lambda: self._overview.svg(v))
        if v is None:
            return {"bar": bar, "overview": overview, **dict.fromkeys(OF_VEHICLE, _nothing)}
        return {
            "bar": bar,
            "overview": overview,
            "orders": self._once("orders", v, lambda: panels.orders(v)),
            "wheel": lambda: teleoperation.wheel(v, self._commander.by_hand, session.page),
            "instrument": self._once("instrument", v, lambda: panels.instrument(v)),
            "fleet": self._once("fleet", v, lambda: panels.fleet(self._model, v, t)),
            "cameras": lambda: camera_panel.panel(v, session, t),
            "facts": self._once("facts", v, lambda: panels.facts(v, t)),
        }

    def _once(self, what: str, v: VehicleModel | None, draw: Draw) -> Draw:
        key = (what, v.name if v is not None else "")

        def drawn() -> Html:
            if key not in self._drawn:
                self._drawn[key] = draw()
            return self._drawn[key]

        return drawn

    def _stop_buttons(self) -> list[Button]:
        """STOP ALL, which always makes sense, and its release."""
        stopped = self._model.stopped
        return [
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

    def _buttons(self, session: BrowserSession, v: VehicleModel, t: float) -> list[Button]:
        """The commands that make sense for the vehicle that a browser shows; a button is of one vehicle for all its life."""
        mode = v.status.mode if v.status is not None else None
        shown = [
            Button(f"mode {v.name} {name}", name, SetMode(v.name, name), _hint(v, value), lit=value == mode)
            for name, value in modes_of(v).items()
        ]
        armed = v.status is not None and v.status.armed
        word = "Disarm" if armed else "Arm"
        sure = self._commander.waits_for_confirmation(session, v.name, not armed, t)
        label, colour = (f"Confirm: {word.lower()} {v.name}", "orange") if sure else (f"{word} {v.name}", "")
        shown.append(Button(f"arm {v.name}", label, Arm(session.page, v.name, not armed), "Asks for a second click", colour=colour))
        if panels.drives_to_goal(v):
            shown.append(Button(f"cancel {v.name}", "Cancel goal", Cancel(v.name), f"{v.name} stops and goes back to its job"))
        return shown


def _hint(v: VehicleModel, mode: Any) -> str:
    return f"{v.name}: {describe(ModeRequest(mode=mode))}"


def _nothing() -> Html:
    return html("")
