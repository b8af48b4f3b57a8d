"""``uvf report``: a page about a run, and its pictures."""

from collections.abc import Iterator
from pathlib import Path

from launch.reports import html
from launch.reports.drive_figures import drive_figures
from launch.reports.drive_page import draw_drive
from launch.reports.flight_figures import Figure, figures
from launch.reports.flight_page import draw
from launch.reports.history import History
from launch.reports.maps import ReportedMap, own_map, reported_maps, team_map
from launch.reports.recorded_run import RecordedRun
from launch.reports.team_page import draw_team
from launch.scoring.last_words import why
from schemas.messages import Event, NavStatus, TaskStatus
from uvf.models.yaml_data import BadInput
from uvf.runtime.messages.enum_names import enum_name

PAGE, TEAM = "report.html", "all-ways.png"
"""No vehicle is called so: names have no hyphen."""
MOST_EVENTS = 500
SEVERE = Event.NOTICE


def vehicle_figures(history: History) -> list[Figure]:
    """The figures of a flight or a drive."""
    return figures(history) if history.is_aircraft else drive_figures(history)


def write_report(run: RecordedRun, target: Path) -> list[Path]:
    """Writes the page and a picture of each vehicle and of all ways into a folder; returns the files. Raises BadInput."""
    if not run.vehicles:
        raise BadInput(f"{run.path}: there is no vehicle in this log: nothing to report")
    try:
        target.mkdir(parents=True, exist_ok=True)
        maps = reported_maps(run)
        pictures = {name: target / f"{name}.png" for name in run.vehicles}
        for name, history in run.vehicles.items():
            if history.is_aircraft:
                draw(history, pictures[name])
            else:
                draw_drive(history, own_map(history), pictures[name])
        draw_team(run, team_map(maps), target / TEAM)
        page = target / PAGE
        page.write_text(html.document(f"Report: {run.title}", list(_sections(run, maps, target)), _head(run)), encoding="utf-8")
    except OSError as error:
        raise BadInput(f"{target}: {error.strerror}: choose another folder with --out") from error
    return [page, target / TEAM, *pictures.values()]


def _head(run: RecordedRun) -> str:
    verdict = f'<span class="{run.verdict.split()[0]}">{run.verdict}</span>' if run.verdict else ""
    about = run.site.mission.about if run.site is not None else run.note
    facts = [run.stopped_at or f"{run.end:.1f} s", f"{len(run.vehicles)} vehicles", str(run.path.resolve())]
    if run.site is not None:
        facts[:0] = [f"world {run.site.mission.world}", f"seed {run.site.mission.seed}"]
    return f'<h1>{html.text(run.title)} {verdict}</h1><p>{html.text(about)}</p><p class="about">{html.text(" · ".join(facts))}</p>'


def _sections(run: RecordedRun, maps: list[ReportedMap], target: Path) -> Iterator[tuple[str, str]]:
    if run.verdicts or run.failures:
        yield "Criteria", _criteria(run) + html.paragraphs((*run.failures, *why(run.verdicts, run.told)))
    yield "Ways", html.picture(target / TEAM, "the ways of all vehicles over the world") + html.folded("Tasks as a table", _tasks(run))
    for name, history in run.vehicles.items():
        rows = [(figure.name, figure.value) for figure in vehicle_figures(history)]
        kind = "flight" if history.is_aircraft else "drive"
        content = html.picture(target / f"{name}.png", f"plots of the {kind} of {name}") + html.folded(
            "Figures", html.table(("figure", "value"), rows)
        )
        yield name, content + html.folded("What the planner decided", _decisions(history))
    if maps:
        yield "Maps", _maps(maps)
    yield "Events", _events(run)
    yield "Messages", _messages(run)
    if any(history.params for history in run.vehicles.values()):
        yield "Parameters", "".join(_parameters(history) for history in run.vehicles.values())
    yield "Versions", html.table(("what", "value"), run.metadata.items())
    if run.site is not None:
        yield "Mission", html.block(run.site.mission_path.read_text(encoding="utf-8"))


def _criteria(run: RecordedRun) -> str:
    rows = ((v.subject, v.criterion.measure, v.found.value, v.limits, v.margin, v.word, v.found.circumstances) for v in run.verdicts)
    return html.table(("subject", "measure", "value", "limit", "margin", "", "decided by"), rows)


def _tasks(run: RecordedRun) -> str:
    rows = (
        (
            "\N{MIDDLE DOT} " * task.depth + (task.name or task.kind),
            enum_name(TaskStatus.State, task.state),
            f"{run.begun[i]:.1f} s" if i in run.begun else "",
            f"{task.since:.1f} s" if task.state in (TaskStatus.DONE, TaskStatus.FAILED, TaskStatus.STOPPED) else "",
            task.reason,
        )
        for i, task in enumerate(run.tasks)
    )
    return html.table(("task", "state", "began", "ended", "why"), rows)


def _decisions(history: History) -> str:
    rows = [
        (
            f"{t:.1f} s",
            enum_name(NavStatus.State, status.state),
            status.job,
            f"({status.goal.x:.2f}, {status.goal.y:.2f}) m" if status.job else "",
            status.distance_left,
            status.reason,
        )
        for t, status in history.navigation
    ]
    return html.table(("time", "state", "job", "goal", "m left", "reason"), rows)


PLACED = "Each map lies where the mission's start puts it, not where it fits best. Walls count where the map knows the place before them."


def _maps(maps: list[ReportedMap]) -> str:
    head = ("map", "m^2 known", "wall F1, 5 cm", "wall F1, 10 cm", "IoU free", "IoU occupied", "floor unknown", "doubled walls")
    return html.table(head, map(_of_map, maps)) + html.paragraphs((PLACED,))


def _of_map(each: ReportedMap) -> tuple[object, ...]:
    area, found = float((each.grid.cells >= 0).sum()) * each.grid.resolution**2, each.score
    if found is None:
        return each.name, area, *[""] * 6
    shares = (*(d.f1 for d in found.walls.detections), found.free_iou, found.occupied_iou, found.unknown)
    return each.name, area, *(f"{share:.3f}" for share in shares), found.double_walls


def _events(run: RecordedRun) -> str:
    rows = [(f"{e.t:.1f} s", e.owner, enum_name(Event.Severity, e.event.severity), e.event.text, e.event.cause) for e in run.events]
    grave = [row for row, e in zip(rows, run.events, strict=True) if e.event.severity >= SEVERE]
    head = ("time", "who", "severity", "text", "cause")
    left_out = f", the first {MOST_EVENTS}" if len(rows) > MOST_EVENTS else ""
    return html.table(head, grave[:MOST_EVENTS]) + html.folded(f"All {len(rows)}{left_out}", html.table(head, rows[:MOST_EVENTS]))


def _messages(run: RecordedRun) -> str:
    rows = (
        (
            each.key.removeprefix("uvf/"),
            each.count,
            f"{each.topic.hz:g}" if each.topic is not None and each.topic.hz else "",
            each.rate,
            each.longest_gap,
            each.missing,
            1000 * each.median_age,
            1000 * max(each.ages, default=0.0),
            each.size / 1000,
        )
        for each in run.traffic.topics
    )
    head = ("topic", "messages", "Hz, nominal", "Hz", "longest gap, s", "missing", "age, ms, median", "largest", "kB")
    said = "Age: simulation time from what a message tells of to when it was sent."
    return html.paragraphs((said,)) + html.folded(f"{len(run.traffic.topics)} topics", html.table(head, rows))


def _parameters(history: History) -> str:
    rows = [(service, name, value) for service, told in sorted(history.params.items()) for name, value in sorted(told.values.items())]
    return html.folded(f"{history.name}: {len(rows)}", html.table(("service", "parameter", "value"), rows))
