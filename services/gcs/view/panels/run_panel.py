"""The tab Run: the simulation's clock, the wind, and the missions that can be started."""

from collections.abc import Mapping
from functools import lru_cache
from math import hypot
from pathlib import Path

from schemas.messages import Clock
from services.gcs.state.session import BrowserSession
from services.gcs.state.state import Model
from services.gcs.state.wording import bearing_from
from services.gcs.view.controls import button, does
from services.gcs.view.markup import Html, html, joined
from services.gcs.view.panels.status import clock_text
from services.gcs.view.panels.tasks import tasks_section
from services.gcs.view.panels.vehicle.progress import order_line
from uvf.models.yaml_data import BadInput, read_yaml

RATES = (0.25, 0.5, 1.0, 2.0, 5.0, 0.0)
LONGEST = 160  # letters of what a mission is about


def run_panel(model: Model, session: BrowserSession, t: float) -> Html:
    """The panel at ``t`` [s, wall] as one page sees it."""
    return html(
        "<h2 class='g-h'>Simulation{}</h2>{}{}{}<h2 class='g-h'>Missions</h2>{}{}",
        html("<span>{}</span>", _state(model)),
        _clock(model, session, t),
        tasks_section(model.tasks),
        _wind(model),
        order_line(model.order),
        joined(_mission(model, session, name, about, t) for name, about in missions(model.site.mission_path.parent).items()),
    )


def _state(model: Model) -> str:
    clock = model.clock
    if clock is None:
        return "no clock is heard"
    held = f", waits for {clock.waiting_for}" if clock.waiting_for else ""
    return f"{'paused' if clock.state == Clock.PAUSED else 'runs'} at {clock_text(model.sim_time)}, × {clock.rate:.2f}{held}"


def _clock(model: Model, session: BrowserSession, t: float) -> Html:
    clock = model.clock
    paused = clock is not None and clock.state == Clock.PAUSED
    go = button("▶ Resume", "clock", "resume", style="g-btn g-main") if paused else button("❚❚ Pause", "clock", "pause")
    off = html("") if paused else html("aria-disabled='true'")
    step = button("One step", "clock", "step", more=off, hint="One tick of the clock" if paused else "Pause it first")
    sure = session.confirms("", "clock_request reset", t)
    reset = button("Confirm: start afresh" if sure else "↺ Reset", "clock", "reset", style="g-btn g-sure" if sure else "g-btn")
    wanted = clock.rate_wanted if clock is not None else 1.0
    rates = joined(button(f"×{rate:g}" if rate else "fastest", "rate", rate, style="", pressed=rate == wanted) for rate in RATES)
    group = html("<div class='g-pressed-group g-gap' role='group' aria-label='Rate'>{}</div>", rates)
    return html("<div class='g-row'>{}{}{}</div>{}", go, step, reset, group)


def _wind(model: Model) -> Html:
    """The wind about the first aircraft, and a form for another one; empty without aircraft."""
    flying = next((v for v in model.vehicles.values() if v.flies), None)
    if flying is None:
        return html("")
    now = "not known"
    if flying.nav is not None:
        wind = flying.nav.wind
        now = f"{hypot(wind.x, wind.y):.1f} m/s from {bearing_from(wind):03.0f}°, as {flying.name} estimates"
    fields = joined(
        html("<input type='number' name='{}' min='0' max='{}' step='any' placeholder='{}' aria-label='{}' required>", *field)
        for field in (("direction", 360, "from °", "Wind from, degrees"), ("speed", 60, "m/s", "Wind speed, metres per second"))
    )
    form = html("<form class='g-form' {}>{}<button type='submit' class='g-btn'>Blow</button></form>", does("wind"), fields)
    return html("<h2 class='g-h'>Wind<span>{}</span></h2>{}", now, form)


def _mission(model: Model, session: BrowserSession, name: str, about: str, t: float) -> Html:
    runs = name == model.site.mission_path.stem
    sure = session.confirms("", f"launch {name}", t)
    label = f"Confirm: end this run, start {name}" if sure else "runs now: start again" if runs else f"Start {name}"
    start = button(label, "launch", name, style="g-btn g-sure g-wide" if sure else "g-btn g-wide")
    return html("<div class='g-mission{}'><b>{}</b><p>{}</p>{}</div>", " g-chosen" if runs else "", name, about, start)


@lru_cache(maxsize=4)
def missions(folder: Path) -> Mapping[str, str]:
    """Name -> what it is about, of the missions in a folder; one that cannot be read says so."""
    return {path.stem: _about(path) for path in sorted(folder.glob("*.yaml"))}


def _about(path: Path) -> str:
    try:
        data = read_yaml(path)
    except BadInput as error:
        return f"cannot be read: {error}"[:LONGEST]
    about = data.get("about", "") if isinstance(data, dict) else ""
    return str(about)[:LONGEST]
