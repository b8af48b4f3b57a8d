"""The tab Plan: the mission that is drawn for the vehicle on show, what will come of it, and how it differs from the one in force."""

import json
from math import degrees
from urllib.parse import quote

import numpy as np

from schemas.messages import MissionItem
from services.gcs.state.plans.area_draft import PARTS
from services.gcs.state.plans.plan_draft import PLACED, PlanDraft, kind_name
from services.gcs.state.plans.plan_file import plan_text
from services.gcs.state.plans.plan_outlook import PlanOutlook
from services.gcs.state.remembered import Remembered
from services.gcs.state.session import BrowserSession
from services.gcs.state.vehicle_model import VehicleModel
from services.gcs.view.controls import button, does
from services.gcs.view.markup import Html, html, joined
from services.gcs.view.panels.plans.areas import area_handles, area_panel, part_choice
from services.gcs.view.panels.plots.profile import profile

UNPLACED = {"takeoff": "Take-off", "land": "Landing", "return": "Return", "repeat": "Repeat"}
ON_GROUND = {"return": "Return", "repeat": "Repeat"}
OF_KIND: dict[int, tuple[tuple[str, str, str], ...]] = {
    MissionItem.WAYPOINT: (("hold", "hold", "s"), ("acceptance_radius", "radius", "m")),
    MissionItem.ORBIT: (("radius", "radius, + clockwise", "m"), ("turns", "turns, 0 = no end", "")),
    MissionItem.SPEED: (("speed", "airspeed", "m/s"),),
}
"""Fields of an item beside its place: name, label, unit."""


def plan_panel(v: VehicleModel, session: BrowserSession, t: float, table: Remembered[Html]) -> Html:
    """The panel at ``t`` [s, wall] as one page sees it. table: of the vehicle's items, as it was drawn last."""
    if session.plan_part != "mission":
        return html(
            "<h2 class='g-h'>{} of {}</h2>{}{}",
            PARTS[session.plan_part],
            v.name,
            part_choice(v, session.plan_part),
            area_panel(v, session.plan_part),
        )
    draft = v.draft
    outlook = v.outlook if v.outlook is not None and v.outlook.edits == draft.edits else PlanOutlook(draft.edits)
    return html(
        "<h2 class='g-h'>Mission of {}{}</h2>{}{}{}{}{}{}{}",
        v.name,
        html("<span>{}</span>", _total(v, draft, outlook)),
        part_choice(v, "mission"),
        _state(v, draft, session, outlook, t),
        table.of(_drawn_from(v), lambda: _table(v, draft)),
        _adding(v),
        _remarks(outlook),
        profile(outlook) if v.flies else html(""),
        _files(v),
    )


def _files(v: VehicleModel) -> Html:
    """To keep what is drawn, and to draw what was kept; the page's script reads and writes the files."""
    fence, rally = v.areas.fence, v.areas.rally
    made_of = (v.draft.edits, fence.edits, rally.edits)
    text = v.plan_file.of(made_of, lambda: quote(plan_text(v.draft.items, fence, rally)))
    save = html("<a class='g-btn' download='{}-plan.yaml' href='data:application/yaml;charset=utf-8,{}'>Save plan</a>", v.name, text)
    about = html("data-file='{}' aria-label='Load a plan for {}'", json.dumps(["plan-load", v.name]), v.name)
    load = html("<label class='g-btn g-file'>Load plan<input type='file' accept='.yaml,.yml' {}></label>", about)
    fault = html("<p class='g-order g-bad' role='alert'>✖ {}</p>", v.file_fault) if v.file_fault else html("")
    return html("<div class='g-row g-gap'>{}{}</div>{}", save, load, fault)


def _total(v: VehicleModel, draft: PlanDraft, outlook: PlanOutlook) -> str:
    if not draft.items:
        return "no items"
    if outlook.length == 0.0:
        return f"{len(draft.items)} items"
    more = " a round" if outlook.goes_on else ""
    far = f"{outlook.length / 1000:.2f} km" if outlook.length >= 1000 else f"{outlook.length:.0f} m"
    time = f", {outlook.time:.0f} s" if v.flies else ""
    return f"{far}{time}{more}{'' if outlook.is_flown else ' …'}"


def _state(v: VehicleModel, draft: PlanDraft, session: BrowserSession, outlook: PlanOutlook, t: float) -> Html:
    """How it differs from what is on the vehicle, and the button that changes that."""
    changes = draft.differences(v.mission)
    if changes == 0:
        return html("<div class='g-order g-good'>✓ as it is on {}</div>", v.name)
    count = f"{changes} change{'s' if changes > 1 else ''} not on {v.name}"
    sure = session.confirms(v.name, "upload", t)
    label = f"Confirm: replace the mission that {v.name} flies" if sure else f"Upload to {v.name}"
    style = "g-btn g-sure g-wide" if sure else "g-btn g-main g-wide"
    if outlook.fault:
        upload = button(label, "plan-upload", v.name, style="g-btn g-wide", more=html("aria-disabled='true'"), hint=outlook.fault)
    else:
        upload = button(label, "plan-upload", v.name, style=style)
    back = button("Take from the vehicle", "plan-take", v.name)
    clear = button("Clear", "plan-clear", v.name)
    return html(
        "<div class='g-order g-warn'>{}</div><div class='g-plan-do'>{}<div class='g-row'>{}{}</div></div>", count, upload, back, clear
    )


def _drawn_from(v: VehicleModel) -> tuple[object, ...]:
    current = (v.progress.current, v.progress.total > 0) if v.progress is not None else (-1, False)
    return (v.draft.edits, v.draft.chosen, v.mission, *current)


def _table(v: VehicleModel, draft: PlanDraft) -> Html:
    if not draft.items:
        return html("<p class='g-empty'>Click the map and choose <b>Add waypoint</b>.</p>")
    head = "<tr><th>#</th><th>item</th><th>x m</th><th>y m</th><th>{}</th><td></td></tr>"
    rows = joined(_row(v, draft, i, item) for i, item in enumerate(draft.items))
    return html("<table class='g-plan'>{}{}</table>", html(head, "z m" if v.flies else ""), rows)


def _row(v: VehicleModel, draft: PlanDraft, i: int, item: MissionItem) -> Html:
    current = draft.differences(v.mission) == 0 and v.progress is not None and v.progress.current == i and v.progress.total > 0
    name = f"{'▶ ' if current else ''}{kind_name(item)}"
    choose = button(
        name, "plan-choose", v.name, i, style="g-link", more=html("aria-expanded='{}'", "true" if draft.chosen == i else "false")
    )
    remove = button("✕", "plan-remove", v.name, i, style="g-link", more=html("aria-label='Remove item {}'", i + 1))
    if item.kind in PLACED:
        axes = ("x", "y", "z") if v.flies else ("x", "y")
        cells = joined(html("<td>{}</td>", _number(v, i, axis, getattr(item.position, axis), axis)) for axis in axes)
        cells = joined((cells, html("") if v.flies else html("<td></td>")))
    else:
        cells = html("<td colspan='3' class='g-idle'>{}</td>", _in_words(item))
    row = html("<tr class='{}'><td>{}</td><td>{}</td>{}<td>{}</td></tr>", "g-now" if current else "", i + 1, choose, cells, remove)
    return joined((row, _more(v, i, item))) if draft.chosen == i else row


def _number(v: VehicleModel, i: int, name: str, value: float, label: str) -> Html:
    about = html("step='any' value='{:.1f}' aria-label='{} of item {}'", value + 0.0, label, i + 1)
    return html("<input type='number' {} {} data-key='{}-{}'>", does("plan-set", v.name, i, name), about, name, i)


def _in_words(item: MissionItem) -> str:
    if item.kind == MissionItem.JUMP:
        return f"from item {item.jump_to + 1}, {'for ever' if item.repeat < 0 else f'{item.repeat} times'}"
    if item.kind == MissionItem.SPEED:
        return f"{item.speed:.1f} m/s" if item.speed else "cruise"
    if item.kind == MissionItem.TRIGGER_DISTANCE:
        return f"a picture every {item.distance:.1f} m" if item.distance > 0 else "no more pictures"
    return ""


def _more(v: VehicleModel, i: int, item: MissionItem) -> Html:
    """The other fields of an item, and what can be done with it."""
    fields = joined(
        html("<label>{} {}{}</label>", label, _number(v, i, name, getattr(item, name), label), html(" {}", unit) if unit else "")
        for name, label, unit in OF_KIND.get(item.kind, ())
    )
    course = html("<span>course {:03.0f}°</span>", (90 - degrees(item.course)) % 360) if item.HasField("course") else html("")
    up, down = button("↑ earlier", "plan-shift", v.name, i, -1), button("↓ later", "plan-shift", v.name, i, 1)
    onward = button("Go on from here", "plan-go-to", v.name, i)
    return html("<tr class='g-more'><td colspan='6'>{}{}<div class='g-row'>{}{}{}</div></td></tr>", fields, course, up, down, onward)


def _adding(v: VehicleModel) -> Html:
    """Items that need no click on the map."""
    here = v.place.position if v.place is not None else np.zeros(3)
    kinds = UNPLACED if v.flies else ON_GROUND
    keys = joined(
        button(f"+ {label}", "plan-add", v.name, kind, round(float(here[0]), 1), round(float(here[1]), 1)) for kind, label in kinds.items()
    )
    return html("<div class='g-two g-gap'>{}</div>", keys)


def _remarks(outlook: PlanOutlook) -> Html:
    """Why it cannot be flown, and what is flown otherwise than it is drawn."""
    fault = html("<p class='g-order g-bad'>✖ {}</p>", outlook.fault) if outlook.fault else html("")
    return joined((fault, *(html("<p class='g-why'>⚠ {}: {}</p>", what, why) for what, why in outlook.advice)))


def handles(v: VehicleModel, part: str, drawn: Remembered[Html]) -> Html:
    """The places of what is drawn over the scene, to be moved with the pointer or with the arrow keys. drawn: of its items, last."""
    if part == "mission":
        return drawn.of(_drawn_from(v), lambda: _handles(v))
    return area_handles(v, part)


def _handles(v: VehicleModel) -> Html:
    placed = [(i, item.position) for i, item in enumerate(v.draft.items) if item.kind in PLACED]
    return joined(
        html(
            "<button type='button' class='g-handle{}' data-key='h{}' data-move='{}' data-x='{:.2f}' data-y='{:.2f}' data-z='{:.2f}' "
            "aria-label='Item {} of {}: drag it, or use the arrow keys'>{}</button>",
            " g-held" if v.draft.chosen == i else "",
            i,
            json.dumps(["plan-move", v.name, i]),
            p.x,
            p.y,
            p.z,
            i + 1,
            v.name,
            i + 1,
        )
        for i, p in placed
    )
