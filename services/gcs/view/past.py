"""How things stood, for the browsers that look at the past: the same drawings of the model as it was then."""

from collections.abc import Callable, Mapping

from services.gcs.state.past import PastModel
from services.gcs.state.session import PAST_ROOT, BrowserSession
from services.gcs.state.vehicle_model import DisplayPose
from services.gcs.view.controls import button
from services.gcs.view.drawing import Node
from services.gcs.view.markup import Html, html
from services.gcs.view.panels import fleet, records, status
from services.gcs.view.panels.overview import Overview
from services.gcs.view.panels.vehicle import camera_panel, facts
from services.gcs.view.scene.scene_view import SceneView

STATIC = "/world/"
MOVING = "/world/moving/"


class PastView:
    """The past as one browser sees it; what has not changed is the same object as before."""

    def __init__(self, past: PastModel) -> None:
        self.past = past
        self._scene = SceneView(past.model)
        self._overview = Overview(past.model)

    def nodes(self, t: float) -> Mapping[str, Node]:
        """Scene nodes at ``t`` [s, wall]; what never changes is in everybody's scene already."""
        return {PAST_ROOT + name: node for name, node in self._scene.nodes(t).items() if not name.startswith(STATIC) or MOVING in name}

    def places(self) -> Mapping[str, DisplayPose]:
        """Poses of the frames."""
        return {PAST_ROOT + name: place for name, place in self._scene.places().items()}

    def words(self, session: BrowserSession, t: float) -> dict[str, Callable[[], Html]]:
        """Slots that tell of the moment on show, ``t`` [s, wall], in place of those that tell of the present."""
        model = self.past.model
        then: dict[str, Callable[[], Html]] = {
            "bar": lambda: status.status_bar(model, session, model.vehicles.get(session.vehicle), t),
            "alerts": lambda: status.alert_lines(model, t),
            "notices": lambda: status.notices(model, t),
            "table": (lambda: fleet.fleet_table(model, t)) if session.table else _nothing,
            "log": lambda: records.event_log(model.log),
            "menu": _nothing,
            "hint": _nothing,
            "handles": _nothing,
            "wheel": _nothing,
            "mapping": _nothing,
            "commands": _no_commands,
        }
        v = model.vehicles.get(session.vehicle)
        if v is None:
            return then
        return then | {
            "overview": lambda: self._overview.svg(v),
            "fleet": lambda: fleet.fleet(model, v, t),
            "instrument": lambda: facts.instrument(v),
            "cameras": lambda: camera_panel.panel(v, session, t),
            "picture": lambda: camera_panel.picture(v, session, t),
            "facts": lambda: facts.facts(v, t),
        }


def _no_commands() -> Html:
    back = button("Back to the present", "live", style="g-btn g-wide")
    return html("<p class='g-order g-warn'>◷ This is the past: nothing is commanded from here.</p>{}", back)


def _nothing() -> Html:
    return html("")
