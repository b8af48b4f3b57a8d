"""What runs in the browser besides viser (``page.js``, ``page.css``), and how it speaks with us."""

import json
from pathlib import Path

from services.gcs.actions import Action, LeaveWheel, Looking, Rescale, Select, ShowCamera, Steer, TakeWheel
from services.gcs.view.markup import Html, html

STYLE = Path(__file__).with_name("page.css")
SCRIPT = Path(__file__).with_name("page.js")


def script(bridge: str) -> str:
    """The page's JavaScript. bridge: id of the hidden text field through which the page sends messages."""
    arguments = ", ".join(json.dumps(text) for text in (bridge, STYLE.read_text(encoding="utf-8")))
    return f"{SCRIPT.read_text(encoding='utf-8').strip()}({arguments})"


def follow(on: bool) -> str:
    """JavaScript that makes a page's view follow the chosen vehicle, or stop; either way it counts as not turned by hand."""
    return f"window.__gcsFollow = {json.dumps(on)}; window.__gcsHand = false"


def bar_source(content: Html, beat: int, bridge: str) -> str:
    """The hidden element that the status bar is copied from.

    A new ``beat`` shows that the ground station is alive; bridge: of which connection.
    """
    return str(html("<div id='gcs-bar-source' data-beat='{}' data-bridge='{}' hidden>{}</div>", beat, bridge, content))


def padded(content: Html) -> str:
    """The content with a margin, which viser's panels do not have. A plain string, as viser sends no other."""
    return str(html("<div class='g-pad'>{}</div>", content))


def said_in(value: str) -> tuple[str, str]:
    """(kind, argument) of a message from the page, as in ``select:burger`` or ``shape:1.25``; empty for an invalid one."""
    try:
        said = json.loads(value)
    except ValueError:
        return "", ""
    if not isinstance(said, list) or not said or not isinstance(said[0], str):
        return "", ""
    what, _, about = said[0].partition(":")
    return what, about


def action_in(value: str, page: int, vehicle: str) -> Action | None:
    """The action that a message of a page's script asks for, or None.

    page, vehicle: which page it came from and which vehicle that one shows; its script has no say in that.
    """
    what, about = said_in(value)
    match what, about.split(":"):
        case "select", [name]:
            return Select(page, name)
        case "camera", [name]:
            return ShowCamera(page, name)
        case "looks", [""]:
            return Looking(page)
        case "wheel", ["on"]:
            return TakeWheel(page, vehicle)
        case "wheel", ["off"]:
            return LeaveWheel(page)
        case "scale", [key]:
            return Rescale(page, key)
        case "steer", [forward, left]:
            return _steer(page, forward, left)
    return None


def _steer(page: int, *way: str) -> Steer | None:
    try:
        forward, left = (float(part) for part in way)
    except ValueError:
        return None
    return Steer(page, forward, left) if abs(forward) <= 1 and abs(left) <= 1 else None


def shape_in(value: str) -> tuple[float, bool] | None:
    """(aspect ratio, width over height [-] of the page's scene, whether nobody has turned its view by hand); None for another message."""
    what, shape = said_in(value)
    try:
        return (float(shape), what == "shape") if what in ("shape", "hand") and 0.05 < float(shape) < 20.0 else None
    except ValueError:
        return None
