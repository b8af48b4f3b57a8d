"""Puts the picture of one step together: scene at the page's full rate, words at a fifth to a half of it; for each browser its own."""

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from services.gcs.orders.by_hand import ManualDriving
from services.gcs.state.graph.graph_choice import GraphChoice
from services.gcs.state.graph.node_graph import NodeGraph
from services.gcs.state.plans.area_draft import Ring
from services.gcs.state.pointing import Pointed
from services.gcs.state.remembered import Remembered
from services.gcs.state.session import ROOTS, SHED_AFTER, VIEWS, BrowserSession, hidden_roots
from services.gcs.state.state import Model
from services.gcs.state.vehicle_model import DisplayPose, VehicleModel
from services.gcs.view.controls import check_box, choice
from services.gcs.view.drawing import CameraView, Colour, Node, PagePanel, Picture, Polyline
from services.gcs.view.markup import Html, html, joined, trusted
from services.gcs.view.panels import fleet, records, run_panel, status
from services.gcs.view.panels.graphs import graph, graph_drawing
from services.gcs.view.panels.overview import Overview
from services.gcs.view.panels.plans import plan
from services.gcs.view.panels.plots import plot, trends
from services.gcs.view.panels.timeline import TimeBar, timeline
from services.gcs.view.panels.vehicle import camera_panel, command_panel, facts, map_panel, menus, teleoperation
from services.gcs.view.past import PastView
from services.gcs.view.scene.cameras import ASPECT, cameras
from services.gcs.view.scene.levels import UP
from services.gcs.view.scene.scene_view import SceneView

Floats = NDArray[np.float64]

HELP = Path(__file__).with_name("panels") / "help.html"
COLOURS: Mapping[str, Colour] = {"/own/way": (150, 160, 175), "/own/drawn": (140, 150, 168), "/own/flown": (232, 74, 214)}
AREA: Colour = (90, 200, 250)
FLOWN_PERIOD = 0.5  # s between two drawings of a line that is being flown ahead
FAST = ("time", "run", "plan", "handles", "stop", "bar", "alerts", "commands", "menu", "wheel", "instrument", "picture")
EVERY = 2
"""Steps between two drawings of these, which tell at once."""
SELDOM = 6
"""Steps between two drawings of the rest, some of which are due with each step."""
SLOW = (
    "mapping",
    "plot",
    "fleet",
    "table",
    "cameras",
    "trends",
    "facts",
    "overview",
    "log",
    "graph",
    "wiring",
    "topics",
    "processes",
    "notices",
    "layers",
    "views",
    "hint",
    "help",
)
OF_TAB: Mapping[str, tuple[str, ...]] = {
    "fly": ("instrument", "picture", "cameras", "trends", "facts"),
    "drive": ("instrument", "picture", "wheel", "mapping", "cameras", "facts"),
    "plan": ("plan", "handles"),
    "plot": ("plot",),
    "run": ("run",),
    "graph": ("graph", "wiring", "topics", "processes"),
    "log": ("log",),
    "help": ("help",),
}
"""What is drawn of a tab while it is open."""

Draw = Callable[[], Html]
OnShow = tuple[str, str, str, GraphChoice, bool]
"""The vehicle, its camera, the tab, what is chosen in the tab Graph, and whether it is the past."""


class Composer:
    """Composes what the page shows from the state of the ground station."""

    def __init__(self, model: Model, by_hand: ManualDriving, time_bar: TimeBar) -> None:
        self._model = model
        self._by_hand = by_hand
        self._time_bar = time_bar
        self._past_views: dict[int, PastView] = {}
        self._view = SceneView(model)
        self._overview = Overview(model)
        self._help = trusted(HELP.read_text(encoding="utf-8"))
        self._fitted: dict[int, tuple[float, Mapping[str, CameraView]]] = {}
        """Page -> the shape of its view, and the named views for it."""
        self._own: dict[int, tuple[OnShow, dict[str, Html]]] = {}
        """Page -> what it showed, and the words."""
        self._drawn: dict[tuple[str, str], Html] = {}
        """What has been drawn in this step: (what, of which vehicle); browsers that show the same share it."""
        self._drawn_before: dict[tuple[str, str], Remembered[Html]] = {}
        """What is long and seldom another: (what, of which vehicle)."""
        self._previews: dict[int, dict[str, tuple[object, Node]]] = {}
        self._step = 0

    def picture(self, t: float) -> Picture:
        """The picture to show at ``t`` [s, wall]."""
        self._drawn.clear()
        sessions = self._model.sessions
        self._own = {page: own for page, own in self._own.items() if page in sessions}
        self._fitted = {page: fitted for page, fitted in self._fitted.items() if page in sessions}
        self._past_views = {page: view for page, view in self._past_views.items() if page in self._time_bar.pasts}
        self._previews = {page: made for page, made in self._previews.items() if page in sessions}
        self._drawn_before = {key: drawn for key, drawn in self._drawn_before.items() if key[1] in self._model.vehicles}
        shown = {page: self._panel(session, t) for page, session in sessions.items()}
        self._step += 1
        return Picture(self._view.nodes(t), self._view.places(), shown)

    def _due(self, draws: Mapping[str, Draw], everything: bool) -> dict[str, Html]:
        fast = self._step % EVERY == 0
        slow = {name for i, name in enumerate(SLOW) if (self._step + i) % SELDOM == 0}
        due = {name for name in draws if everything or name in slow or (fast and name in FAST)}
        return {name: draws[name]() for name in draws if name in due}

    def _panel(self, session: BrowserSession, t: float) -> PagePanel:
        """Drawn as a whole when another vehicle or tab comes on show: never the words about one under the name of another."""
        chosen = self._model.chosen_by(session)
        on_show = (session.vehicle, session.camera, session.tab, session.graph, session.past is not None)
        before, words = self._own.get(session.page, (None, {}))
        new = not words or before != on_show
        draws = self._words(session, chosen, t)
        words = {name: content for name, content in words.items() if name in draws}
        if session.behind(t) > SHED_AFTER:  # a slow browser keeps the picture that it has: words and poses come first
            draws.pop("picture", None)
            words = {name: content for name, content in words.items() if name != "picture" or not new}
        words |= self._due(draws, new)
        self._own[session.page] = (on_show, words)
        nodes: Mapping[str, Node] = self._preview(session, t)
        places: Mapping[str, DisplayPose] = {}
        if session.past is not None:
            then = self._past_view(session)
            nodes, places = then.nodes(session.past.t), then.places()
        hidden = hidden_roots(session.layers, session.past is not None)
        return PagePanel(words, nodes, places, hidden, session.theme, self._camera(session), session.views_chosen, t)

    def _past_view(self, session: BrowserSession) -> PastView:
        past = self._time_bar.pasts[session.page]
        if session.page not in self._past_views or self._past_views[session.page].past is not past:
            self._past_views[session.page] = PastView(past)
        return self._past_views[session.page]

    def _words(self, session: BrowserSession, v: VehicleModel | None, t: float) -> dict[str, Draw]:
        model = self._model
        always: dict[str, Draw] = {
            "stop": self._once("stop", None, lambda: status.stop_panel(model)),
            "bar": lambda: status.status_bar(model, session, v, t),
            "alerts": self._once("alerts", None, lambda: status.alert_lines(model, t)),
            "notices": self._once("notices", None, lambda: status.notices(model, t)),
            "overview": self._once("overview", v, lambda: self._overview.svg(v)),
            "table": self._once("table", None, lambda: fleet.fleet_table(model, t)) if session.table else _nothing,
            "views": lambda: _views(session),
            "time": lambda: timeline(self._time_bar, session, self._sim_time(session), t),
            "layers": lambda: _layers(session),
        }
        in_tabs = {
            **self._graph(session, t),
            "processes": self._once("processes", None, lambda: records.processes(model, t)),
            "run": lambda: run_panel.run_panel(model, session, t),
            "log": self._once("log", None, lambda: records.event_log(model.log)),
            "help": lambda: self._help,
        }
        if v is not None:
            always |= {
                "handles": _nothing,
                "fleet": self._once("fleet", v, lambda: fleet.fleet(model, v, t)),
                "commands": lambda: command_panel.command_panel(model, v, session, t),
                "menu": lambda: menus.menu(model, session),
                "hint": lambda: menus.hint(model, v, session),
            }
            in_tabs |= {
                "plot": lambda: plot.plot_panel(model, v, session),
                "instrument": self._once("instrument", v, lambda: facts.instrument(v)),
                "trends": lambda: trends.trend_charts(v.trends, t if session.past is None else session.past.t),
                "wheel": lambda: teleoperation.wheel(v, self._by_hand, session.page),
                "picture": lambda: camera_panel.picture(v, session, t),
                "mapping": lambda: map_panel.map_panel(v, session, t),
                "cameras": lambda: camera_panel.panel(v, session, t),
                "facts": self._once("facts", v, lambda: facts.facts(v, t)),
                "plan": lambda: plan.plan_panel(v, session, t, self._remembered("plan", v)),
                "handles": lambda: plan.handles(v, session.plan_part, self._remembered("handles", v)),
            }
        shown = always | {name: in_tabs[name] for name in OF_TAB.get(session.tab, ()) if name in in_tabs}
        if session.past is None:
            return shown
        then = self._past_view(session).words(session, session.past.t)
        return {name: then.get(name, draw) for name, draw in shown.items()}

    def _sim_time(self, session: BrowserSession) -> float:
        return (self._model if session.past is None else self._time_bar.pasts[session.page].model).sim_time

    def _graph(self, session: BrowserSession, t: float) -> dict[str, Draw]:
        model, choice, vehicle = self._model, session.graph, session.vehicle

        def now() -> NodeGraph:
            return model.graph.graph(t, model.clock, model.clock_at)

        return {
            "graph": self._once("graph", None, lambda: graph.summary(now(), model.graph.has_looked)),
            "wiring": lambda: graph_drawing.drawing(now(), choice, vehicle),
            "topics": lambda: graph.topics(now(), choice, vehicle, model.graph),
        }

    def _remembered(self, what: str, v: VehicleModel) -> Remembered[Html]:
        return self._drawn_before.setdefault((what, v.name), Remembered())

    def _once(self, what: str, v: VehicleModel | None, draw: Draw) -> Draw:
        key = (what, v.name if v is not None else "")

        def drawn() -> Html:
            if key not in self._drawn:
                self._drawn[key] = draw()
            return self._drawn[key]

        return drawn

    def _camera(self, session: BrowserSession) -> CameraView | None:
        """None while somebody has turned the view, or follows a vehicle, which the page does itself."""
        if session.touched:
            return None
        aspect = session.aspect or ASPECT
        if session.page not in self._fitted or self._fitted[session.page][0] != aspect:
            self._fitted[session.page] = (aspect, cameras(self._model.site, aspect))
        return self._fitted[session.page][1].get(session.view)

    def _preview(self, session: BrowserSession, t: float) -> dict[str, Node]:
        """What only this page sees: the way to the place that it has clicked, and the mission that is drawn in its tab Plan."""
        made = self._previews.setdefault(session.page, {})
        lines: dict[str, tuple[object, Floats | None]] = {"/own/way": _way(session.pointed)}
        v = self._model.vehicles.get(session.vehicle)
        if v is not None and v.outlook is not None and session.tab == "plan":
            lines["/own/drawn"] = ((v.outlook, "drawn"), v.outlook.places)
            lines["/own/flown"] = ((v.outlook, "flown" if v.outlook.is_flown else round(t / FLOWN_PERIOD)), v.outlook.line)
        if v is not None and session.tab == "plan" and (area := v.areas.of(session.plan_part)) is not None:
            for i, ring in enumerate(area.rings):
                if (points := outline_of(ring)) is not None:
                    lines[f"/own/area/{i}"] = ((v.name, session.plan_part, area.edits), points)
        nodes: dict[str, Node] = {}
        for name, (of, points) in lines.items():
            if points is None or len(points) < 2:
                continue
            if name not in made or made[name][0] != of:
                made[name] = (of, Polyline(points, COLOURS.get(name, AREA), 3.0))
            nodes[name] = made[name][1]
        return nodes


def _way(pointed: Pointed | None) -> tuple[object, Floats | None]:
    """(what it is made from, (n, 3) m, world) of a measured distance, or of the way that the planner would take."""
    if pointed is not None and pointed.to is not None:
        return (pointed.x, pointed.y, *pointed.to), np.array(((pointed.x, pointed.y, 3 * UP), (*pointed.to, 3 * UP)))
    found = pointed.preview if pointed is not None else None
    if found is None:
        return None, None
    return id(found), np.array([(pose.position.x, pose.position.y, 3 * UP) for pose in found.poses]).reshape(-1, 3)


def outline_of(ring: Ring) -> Floats | None:
    """(n, 3) m, world: a drawn ring, closed, on the ground; None where there is nothing to draw."""
    if ring.radius > 0.0 and ring.corners:
        turn = np.linspace(0.0, 2 * np.pi, 49)
        flat = np.array(ring.corners[0]) + ring.radius * np.column_stack((np.cos(turn), np.sin(turn)))
    elif len(ring.corners) > 1:
        flat = np.array([*ring.corners, ring.corners[0]])
    else:
        return None
    return np.column_stack((flat, np.full(len(flat), 5 * UP)))


def _views(session: BrowserSession) -> Html:
    return html("<div data-views='{}'>{}</div>", session.views_chosen, choice("View", VIEWS, session.view, "view"))


def _layers(session: BrowserSession) -> Html:
    return html("<div class='g-checks'>{}</div>", joined(check_box(name, name in session.layers, "layer", name) for name in ROOTS))


def _nothing() -> Html:
    return html("")
