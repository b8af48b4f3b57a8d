"""What runs in the browser besides viser (``page.js``, ``page.css``), and how it speaks with us."""

import json
from pathlib import Path

STYLE = Path(__file__).with_name("page.css")
SCRIPT = Path(__file__).with_name("page.js")


def script(bridge: str) -> str:
    """bridge: the id of the hidden text field through which the page speaks."""
    arguments = ", ".join(json.dumps(text) for text in (bridge, STYLE.read_text(encoding="utf-8")))
    return f"{SCRIPT.read_text(encoding='utf-8').strip()}({arguments})"


def follow(on: bool) -> str:
    """Makes one page's view go along with the chosen vehicle, or stand still again."""
    return f"window.__gcsFollow = {json.dumps(on)}"


def bar_source(content: str, beat: int) -> str:
    """The hidden element that the bar is copied from; a new ``beat`` shows that the ground station lives."""
    return f"<div id='gcs-bar-source' data-beat='{beat}' hidden>{content}</div>"


def padded(content: str) -> str:
    """viser lays HTML flush with the panel's edge; buttons and pictures stand a little off it."""
    return f"<div class='g-pad'>{content}</div>"


def selected_in(value: str) -> str:
    """The vehicle that a card's message names; empty when it is no such message."""
    try:
        said = json.loads(value)
    except ValueError:
        return ""
    if not isinstance(said, list) or not said or not isinstance(said[0], str) or not said[0].startswith("select:"):
        return ""
    return said[0].removeprefix("select:")
