"""The tab Graph: what is wrong, in words; the table of topics, declared against heard; and one topic's newest message."""

from collections.abc import Sequence

from schemas.topics import SYSTEM
from services.gcs.state.graph.graph_book import GraphBook
from services.gcs.state.graph.graph_choice import GraphChoice
from services.gcs.state.graph.node_graph import NodeGraph, ServiceState, TopicState
from services.gcs.state.graph.topic_verdicts import Grade
from services.gcs.state.graph.traffic import short
from services.gcs.view.controls import button, does
from services.gcs.view.markup import Html, html, joined
from services.gcs.view.panels.graphs.message_text import message_text

PROBLEMS, ROWS, WHO = 6, 120, 3
STYLES = {Grade.FINE: "good", Grade.QUIET: "idle", Grade.AMBER: "warn", Grade.RED: "bad"}
SIGNS = {Grade.FINE: "●", Grade.QUIET: "○", Grade.AMBER: "⚠", Grade.RED: "✖"}
WORDS = {Grade.FINE: "fine", Grade.QUIET: "quiet", Grade.AMBER: "warning", Grade.RED: "bad"}


def summary(graph: NodeGraph, listened: bool) -> Html:
    """One line, then a line for each problem with its cause, the worst first. listened: whether the services are known yet."""
    if not listened:
        return html("<div class='g-empty' role='status'>Listening to the bus …</div>")
    problems = graph.problems
    worst = STYLES[problems[0].grade] if problems else "good"
    what = f"{len(problems)} problem{'s' if len(problems) != 1 else ''}" if problems else "no problem"
    line = html("<b>{} topics, {} services: <span class='g-{}'>{}</span></b>", len(graph.topics), len(graph.services), worst, what)
    rows = joined(_problem(one, graph) for one in problems[:PROBLEMS])
    more = (
        html("<li class='g-idle'>and {} more: choose “problems” below</li>", len(problems) - PROBLEMS) if len(problems) > PROBLEMS else ""
    )
    return html("<div class='g-sum' role='status'>{}</div><ul class='g-problems'>{}{}</ul>", line, rows, more)


def _problem(one: ServiceState | TopicState, graph: NodeGraph) -> Html:
    word: tuple[str, ...]
    if isinstance(one, TopicState):
        name, word, why = short(one.key), ("topic", one.key), one.why
    else:
        lost = sum(topic.gone == one.name and topic.grade >= Grade.AMBER for topic in graph.topics)
        name, word, why = one.name, ("service", one.name, ""), f"service {one.why}"
        why += f"; {lost} of its topics {'is' if lost == 1 else 'are'} missed" if lost else ""
    return html(
        "<li class='g-a-{}'>{} <button type='button' class='g-link' {}>{}</button> <span>{}</span></li>",
        STYLES[one.grade],
        SIGNS[one.grade],
        does(*word),
        name,
        why,
    )


def listed(graph: NodeGraph, choice: GraphChoice, vehicle: str) -> list[TopicState]:
    """The topics that a browser lists: those of its scope, of the chosen service or bundle, with the text in them."""
    return [one for one in graph.topics if _in_scope(one, choice, vehicle) and _is_chosen(one, choice) and _has(one, choice.text.lower())]


def _in_scope(one: TopicState, choice: GraphChoice, vehicle: str) -> bool:
    if choice.scope == "problems":
        return one.grade >= Grade.AMBER
    return choice.scope == "all" or one.owner in (vehicle, SYSTEM)


def _is_chosen(one: TopicState, choice: GraphChoice) -> bool:
    if choice.to:
        return choice.node in one.writers and choice.to in one.readers
    return not choice.node or choice.node in (*one.writers, *one.readers)


def _has(one: TopicState, text: str) -> bool:
    return not text or any(text in word.lower() for word in (one.key, one.type_name, *one.writers, *one.readers))


def topics(graph: NodeGraph, choice: GraphChoice, vehicle: str, book: GraphBook) -> Html:
    """The filters and the table of topics, each with its rate against the nominal one, its age and who writes and reads it."""
    found = listed(graph, choice, vehicle)
    head = joined(html("<th>{}</th>", name) for name in ("topic", "Hz", "age s", "kB/s"))
    rows = joined(_row(one, choice, book) for one in found[:ROWS])
    more = html("<p class='g-why'>and {} more: type a part of the name</p>", len(found) - ROWS) if len(found) > ROWS else ""
    body = (
        html("<table class='g-system g-topics'><tr>{}</tr>{}</table>{}", head, rows, more) if found else html("<p class='g-empty'>None</p>")
    )
    return html("<h2 class='g-h'>Topics <span>{} of {}</span></h2>{}{}", len(found), len(graph.topics), _filters(choice, vehicle), body)


def _filters(choice: GraphChoice, vehicle: str) -> Html:
    labels = {"vehicle": vehicle or "system", "all": "all", "problems": "problems"}
    scopes = joined(button(label, "topics-scope", scope, style="", pressed=scope == choice.scope) for scope, label in labels.items())
    text = html(
        "<input type='search' data-key='topics-text' aria-label='part of a topic, a type or a service' placeholder='filter' "
        "maxlength='64' value='{}' {}/>",
        choice.text,
        does("topics-text"),
    )
    chosen = ""
    if choice.node:
        what = f"{choice.node} → {choice.to}" if choice.to else choice.node
        chosen = html("<p class='g-only'>only of <b>{}</b> {}</p>", what, button("show all", "service", "", "", style="g-link"))
    group = html("<span class='g-pressed-group' role='group' aria-label='topics listed'>{}</span>", scopes)
    return html("<div class='g-topic-filters'>{}{}</div>{}", group, text, chosen)


def _row(one: TopicState, choice: GraphChoice, book: GraphBook) -> Html:
    is_open = one.key == choice.topic
    nominal = f"/{one.nominal:g}" if one.nominal > 0 else ""
    cells = html(
        "<td><button type='button' class='g-link' {} aria-expanded='{}'><i class='g-{}' role='img' aria-label='{}'>{}</i> {}</button></td>"
        "<td>{}<i>{}</i></td><td>{}</td><td>{}</td>",
        does("topic", one.key),
        "true" if is_open else "false",
        STYLES[one.grade],
        WORDS[one.grade],
        SIGNS[one.grade],
        short(one.key),
        _number(one.rate) if one.age is not None else "–",
        nominal,
        _age(one.age),
        _number(one.bytes_per_second / 1000.0) if one.age is not None else "–",
    )
    who = html("{} → {}", _names(one.writers), _names(one.readers))
    why = html("<span class='g-{}'>{}</span><br>", STYLES[one.grade], one.why) if one.grade >= Grade.AMBER else html("")
    row = html("<tr>{}</tr><tr class='g-who'><td colspan='4'>{}{}</td></tr>", cells, why, who)
    return joined((row, _message(one, book))) if is_open else row


def _message(one: TopicState, book: GraphBook) -> Html:
    heard = book.traffic.keys.get(one.key)
    text = message_text(heard) if heard is not None else "nothing has been heard yet"
    remark = f" · {one.why}" if one.grade is Grade.QUIET else ""
    return html(
        "<tr class='g-message'><td colspan='4'><div>{}{}</div><pre tabindex='0' aria-label='newest message'>{}</pre></td></tr>",
        one.type_name,
        remark,
        text,
    )


def _names(names: Sequence[str]) -> str:
    return ", ".join(names[:WHO]) + (f" +{len(names) - WHO}" if len(names) > WHO else "") or "nobody"


def _number(value: float) -> str:
    return f"{value:.0f}" if value >= 99.95 else f"{value:.1f}"


def _age(age: float | None) -> str:
    if age is None:
        return "–"
    return f"{age:.1f}" if age < 100.0 else f"{age / 60.0:.0f} min"
