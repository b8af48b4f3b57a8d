"""Buttons, check boxes and sliders as markup: what each asks for is its ``data-do``, a word for ``page.words``."""

import json
from collections.abc import Iterable

from services.gcs.view.markup import Html, html, joined


def does(*word: object) -> Html:
    """The attribute of an element that says this word when it is pressed or changed."""
    return html("data-do='{}'", json.dumps(word))


def button(label: object, *word: object, style: str = "g-btn", more: str | Html = "", hint: str = "", pressed: bool | None = None) -> Html:
    """A button. more: further attributes; hint: shown beside the pointer; pressed: of one that stays pressed, whether it is."""
    state = html("") if pressed is None else html(" aria-pressed='{}'", "true" if pressed else "false")
    title = html(" title='{}'", hint) if hint else html("")
    return html("<button type='button' class='{}' {}{}{} {}>{}</button>", style, does(*word), state, title, more, label)


def choice(name: str, options: Iterable[str], chosen: str, verb: str, *before: object) -> Html:
    """A group of buttons of which one is pressed."""
    return html(
        "<div class='g-pressed-group' role='group' aria-label='{}'>{}</div>",
        name,
        joined(button(one, verb, *before, one, style="", pressed=one == chosen) for one in options),
    )


def check_box(label: str, on: bool, *word: object) -> Html:
    """A check box with its label; what is ticked follows the word."""
    return html("<label><input type='checkbox' {}{}> {}</label>", does(*word), html(" checked") if on else html(""), label)
