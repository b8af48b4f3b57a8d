"""Text becomes markup in one place, which escapes it."""

import ast
from pathlib import Path
from typing import get_type_hints

import numpy as np
import pytest

from services import gcs
from services.gcs.view.markup import Html, html, joined, trusted
from services.gcs.view.panels.vehicle.instruments import DriveInstruments, FlightInstruments

EVIL = "<img src=x onerror='alert(\"1\")'>&"
SHOWN = "&lt;img src=x onerror=&#x27;alert(&quot;1&quot;)&#x27;&gt;&amp;"
SOURCES = sorted(Path(gcs.__path__[0]).glob("*.py"))


def test_text_is_escaped_between_tags_and_in_attributes():
    assert html("<b title='{}'>{name}</b>", EVIL, name=EVIL) == f"<b title='{SHOWN}'>{SHOWN}</b>"


def test_markup_stays_markup_and_numbers_keep_their_formats():
    assert html("<p>{}{:.1f}{:03d}{:+.0f}</p>", html("<i>{}</i>", "<"), 1.25, 7, np.float32(2)) == "<p><i>&lt;</i>1.2007+2</p>"


def test_braces_in_a_value_are_no_places():
    assert html("{}", "{0} {name}") == "{0} {name}"


def test_what_was_put_together_otherwise_is_text_again():
    assert html("{}", html("<i>") + EVIL) == f"&lt;i&gt;{SHOWN}"
    assert html("{}", f"{html('<i>')}") == "&lt;i&gt;"


def test_joining_escapes_too():
    assert joined((html("<i>"), EVIL, 3), "<br>") == f"<i>&lt;br&gt;{SHOWN}&lt;br&gt;3"
    assert joined((1, 2), html("<br>")) == "1<br>2"


def is_markup(node):
    """An f-string in which a tag stands: markup made past ``html``."""
    if isinstance(node, ast.JoinedStr):
        text = "".join(str(part.value) for part in node.values if isinstance(part, ast.Constant))
        return any(f"<{tag}" in text for tag in "abcdefghijklmnopqrstuvwxyz/")
    return False


@pytest.mark.parametrize("source", [p for p in SOURCES if p.stem != "instruments"], ids=lambda p: p.stem)
def test_no_other_file_makes_markup_by_hand(source):
    tree = ast.parse(source.read_text(encoding="utf-8"))
    assert [node.lineno for node in ast.walk(tree) if is_markup(node)] == []
    calls = [n for n in ast.walk(tree) if isinstance(n, ast.Call) and isinstance(n.func, ast.Name)]
    assert [n.lineno for n in calls if n.func.id == "Html" and source.stem != "markup"] == []


@pytest.mark.parametrize("read", [FlightInstruments, DriveInstruments])
def test_an_instrument_is_drawn_by_hand_for_nothing_but_numbers_and_markup_goes_into_it(read):
    assert set(get_type_hints(read).values()) <= {float, float | None, bool, Html}


def test_only_the_programs_own_text_is_trusted():
    assert isinstance(trusted("<p>"), Html)
    trusting = {p.stem for p in SOURCES if "trusted(" in p.read_text(encoding="utf-8")} - {"markup"}
    assert trusting <= {"viser_page", "instruments"}
