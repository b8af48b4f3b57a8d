"""The parts of the tab Plan beside the mission: fence, rally points, and a field to survey."""

import json

from schemas.messages import Fence, RallyPoints
from services.gcs.state.plans.area_draft import PARTS, AreaDraft, FenceDraft, RallyDraft, Ring, SurveyDraft
from services.gcs.state.vehicle_model import VehicleModel
from services.gcs.view.controls import button, choice, does
from services.gcs.view.markup import Html, html, joined
from uvf.models.mission.fence import ACTIONS

SHOWN_CORNERS = 24


def part_choice(v: VehicleModel, part: str) -> Html:
    """The row of parts; of one that does not fly without the survey."""
    labels = [label for name, label in PARTS.items() if v.flies or name != "survey"]
    return html("<div class='g-parts'>{}</div>", choice("What is drawn", labels, PARTS[part], "plan-part"))


def area_panel(v: VehicleModel, part: str) -> Html:
    """The panel of a part."""
    match part:
        case "fence":
            return _fence(v, v.areas.fence)
        case "rally":
            return _rally(v, v.areas.rally)
        case _:
            return _survey(v, v.areas.survey)


def _fence(v: VehicleModel, draft: FenceDraft) -> Html:
    message = draft.message()
    there = v.fence if v.fence is not None else Fence()
    same = _bare_fence(message) == _bare_fence(there)
    kinds = (("+ keep in", "keep in"), ("+ keep out", "keep out"), ("+ circle in", "circle in"), ("+ circle out", "circle out"))
    adding = joined(button(label, "zone-begin", v.name, kind) for label, kind in kinds)
    limits = joined(_number(v, "fence", name, getattr(draft, name), "m") for name in ("floor", "ceiling")) if v.flies else html("")
    actions = choice("At the fence", [name for name in ACTIONS if v.flies or name != "land"], draft.action, "fence-acts", v.name)
    zones = joined(_zone(v, draft, i, ring) for i, ring in enumerate(draft.rings))
    empty = html("<p class='g-empty'>Add a zone, then click its corners on the map.</p>") if not draft.rings else html("")
    return joined(
        (
            _state(v, "fence", same, draft.fault, "fence"),
            empty,
            zones,
            html("<div class='g-two g-gap'>{}</div>", adding),
            html("<div class='g-fields'>{}</div>{}", limits, actions),
        )
    )


def _bare_fence(fence: Fence) -> bytes:
    """What counts when two are compared."""
    bare = Fence()
    bare.CopyFrom(fence)
    bare.ClearField("timestamp")
    bare.ClearField("origin")
    for zone in bare.zones:
        if zone.vertices:
            zone.ClearField("centre")
            zone.ClearField("radius")
            for vertex in zone.vertices:
                vertex.z = 0.0
        else:
            zone.centre.z = 0.0
    return bare.SerializeToString(deterministic=True)


def _zone(v: VehicleModel, draft: FenceDraft, i: int, ring: Ring) -> Html:
    kind = f"{'keep out of' if ring.excludes else 'keep in'} {'circle' if ring.radius > 0 else 'zone'} {i + 1}"
    is_chosen = i == draft.chosen
    expanded = html("aria-expanded='{}'", "true" if is_chosen else "false")
    name = button(kind, "zone-choose", v.name, i, style="g-link", more=expanded)
    remove = button("✕", "zone-end", v.name, i, style="g-link", more=html("aria-label='Remove zone {}'", i + 1))
    count = f"radius {ring.radius:g} m" if ring.radius > 0 else f"{len(ring.corners)} corners"
    head = html("<div class='g-zone'>{}<span class='g-idle'>{}</span>{}</div>", name, count, remove)
    if not is_chosen:
        return head
    radius = _number(v, "fence", "radius", ring.radius, "m") if ring.radius > 0 else html("")
    return joined((head, html("<div class='g-fields'>{}</div>", radius), _corners(v, "fence", i, ring)))


def _rally(v: VehicleModel, draft: RallyDraft) -> Html:
    mine, there = draft.message(v.flies), v.rally if v.rally is not None else RallyPoints()
    same = [(p.x, p.y, p.z) for p in mine.points] == [(p.x, p.y, p.z) for p in there.points]
    height = html("<div class='g-fields'>{}</div>", _number(v, "rally", "height", draft.height, "m")) if v.flies else html("")
    corners = _corners(v, "rally", 0, draft.rings[0])
    return joined((_state(v, "rally", same, "", "rally points"), corners or html(""), height))


def _survey(v: VehicleModel, draft: SurveyDraft) -> Html:
    fault = html("<p class='g-order g-bad'>✖ {}</p>", draft.fault) if draft.fault else html("")
    if draft.making:
        make = html("<p class='g-order' role='status'>the swaths are being planned …</p>")
    else:
        make = button("Make a mission of it", "survey-make", v.name, style="g-btn g-main g-wide")
    fields = joined(
        _number(v, "survey", name, getattr(draft, name), unit) for name, unit in (("height", "m"), ("sidelap", ""), ("frontlap", ""))
    )
    clear = button("Clear", "area-clear", v.name, "survey")
    return joined((_corners(v, "survey", 0, draft.rings[0]), html("<div class='g-fields'>{}</div>", fields), make, clear, fault))


def _state(v: VehicleModel, part: str, same: bool, fault: str, what: str) -> Html:
    if same:
        return html("<div class='g-order g-good'>✓ {} as on {}</div>", what, v.name)
    more = html("aria-disabled='true'") if fault else html("")
    upload = button(
        f"Upload the {what}", "area-upload", v.name, part, style="g-btn g-main g-wide" if not fault else "g-btn g-wide", more=more
    )
    row = html(
        "<div class='g-row'>{}{}</div>",
        button("Take from the vehicle", "area-take", v.name, part),
        button("Clear", "area-clear", v.name, part),
    )
    why = html("<p class='g-why'>⚠ {}</p>", fault) if fault else html("")
    return html("<div class='g-order g-warn'>{} not as on {}</div><div class='g-plan-do'>{}{}{}</div>", what, v.name, upload, row, why)


def _corners(v: VehicleModel, part: str, ring: int, drawn: Ring) -> Html:
    if not drawn.corners:
        return html("<p class='g-empty'>Click the map and choose <b>{}</b>.</p>", "Add rally point" if part == "rally" else "Add corner")
    rows = joined(
        html(
            "<tr><td>{}</td><td>{:.1f}</td><td>{:.1f}</td><td>{}</td></tr>",
            i + 1,
            x,
            y,
            button("✕", "area-drop", v.name, part, ring, i, style="g-link", more=html("aria-label='Remove corner {}'", i + 1)),
        )
        for i, (x, y) in enumerate(drawn.corners[:SHOWN_CORNERS])
    )
    more = len(drawn.corners) - SHOWN_CORNERS
    rest = html("<p class='g-why'>and {} more</p>", more) if more > 0 else html("")
    return html("<table class='g-plan'><tr><th>#</th><th>x m</th><th>y m</th><td></td></tr>{}</table>{}", rows, rest)


def _number(v: VehicleModel, part: str, name: str, value: float | None, unit: str) -> Html:
    shown = html("") if value is None else html(" value='{:g}'", value)
    field = html("<input type='number' step='any' {}{} data-key='{}-{}'>", does("area-set", v.name, part, name), shown, part, name)
    return html("<label>{} {}{}</label>", name, field, f" {unit}" if unit else "")


def area_handles(v: VehicleModel, part: str) -> Html:
    """The corners over the scene, to be moved like the mission's items."""
    draft: AreaDraft | None = v.areas.of(part)
    if draft is None:
        return html("")
    return joined(
        html(
            "<button type='button' class='g-handle{}' data-key='a{}-{}' data-move='{}' data-x='{:.2f}' data-y='{:.2f}' data-z='0' "
            "aria-label='Corner {} of {}: drag it, or use the arrow keys'>{}</button>",
            " g-held" if r == draft.chosen else "",
            r,
            i,
            _word(v, part, r, i),
            x,
            y,
            i + 1,
            part,
            i + 1,
        )
        for r, ring in enumerate(draft.rings)
        for i, (x, y) in enumerate(ring.corners)
    )


def _word(v: VehicleModel, part: str, ring: int, index: int) -> str:
    return json.dumps(["area-move", v.name, part, ring, index])
