"""The graph of services as SVG: data flow downwards, layer by layer; topics between the same two services as one bundle."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import hypot

from schemas.topics import SYSTEM
from services.gcs.state.graph.graph_choice import GraphChoice
from services.gcs.state.graph.node_graph import NodeGraph, ServiceState, TopicState
from services.gcs.state.graph.topic_verdicts import Grade
from services.gcs.view.controls import does
from services.gcs.view.markup import Html, html, joined
from uvf.maths.graph_layers import arranged, layers

WIDTH = 348.0  # px
BOX_WIDTH, BOX_HEIGHT, GAP_X, GAP_Y, GAP_LINE = 94.0, 34.0, 11.0, 38.0, 12.0
PER_LINE = 3
MOST_BOXES = 40
COLOURS = {Grade.FINE: "fine", Grade.QUIET: "quiet", Grade.AMBER: "warn", Grade.RED: "bad"}

Bundle = tuple[tuple[str, str], list[TopicState]]


@dataclass(frozen=True)
class _Box:
    """A service's place: the middle of its box [px]."""

    x: float
    y: float
    layer: int


def drawing(graph: NodeGraph, choice: GraphChoice, vehicle: str) -> Html:
    """Services of the vehicle and of the system, and the topics between them; "" while none is known."""
    services = [one for one in graph.services if one.owner in (vehicle, SYSTEM)][:MOST_BOXES]
    if not services:
        return html("")
    names = {one.name for one in services}
    own = [topic for topic in graph.topics if topic.owner in (vehicle, SYSTEM)]
    bundles = {pair: found for pair, found in graph.bundles(own).items() if names >= set(pair)}
    boxes, height = places([one.name for one in services], bundles)
    worst = {pair: max(topic.grade for topic in found) for pair, found in bundles.items()}
    ordered = sorted(bundles.items(), key=lambda item: (worst[item[0]], _is_chosen(choice, item[0])))
    return html(
        "<svg class='g-wiring' viewBox='0 0 {:.0f} {:.0f}' width='100%' role='group' aria-label='services and the topics between them'>"
        "<defs><marker id='g-tip' viewBox='0 0 6 6' refX='5' refY='3' markerWidth='5' markerHeight='5' orient='auto'>"
        "<path d='M0 0L6 3L0 6Z'/></marker></defs>{}{}</svg>",
        WIDTH,
        height,
        joined(_bundle(bundle, boxes, worst[bundle[0]], choice) for bundle in ordered),
        joined(_service(one, boxes[one.name], choice) for one in services),
    )


def places(names: Sequence[str], bundles: Mapping[tuple[str, str], Sequence[TopicState]]) -> tuple[dict[str, _Box], float]:
    """(place of each service, height of the drawing [px]): layer below layer, those of one layer side by side."""
    weights = {pair: float(len(found)) for pair, found in bundles.items()}
    boxes: dict[str, _Box] = {}
    y = BOX_HEIGHT / 2 + 4.0
    for number, row in enumerate(arranged(layers(sorted(names), weights), weights)):
        lines = -(-len(row) // PER_LINE)
        each = -(-len(row) // lines)
        for start in range(0, len(row), each):
            line = row[start : start + each]
            left = (WIDTH - len(line) * BOX_WIDTH - (len(line) - 1) * GAP_X) / 2
            for i, name in enumerate(line):
                boxes[name] = _Box(left + i * (BOX_WIDTH + GAP_X) + BOX_WIDTH / 2, y, number)
            y += BOX_HEIGHT + GAP_LINE
        y += GAP_Y - GAP_LINE
    return boxes, y - BOX_HEIGHT / 2 - GAP_Y + 6.0


def _service(one: ServiceState, box: _Box, choice: GraphChoice) -> Html:
    owner, _, kind = one.name.partition("/")
    first, _, second = kind.partition("_")
    chosen = not choice.to and choice.node == one.name
    lines = (first, f"_{second}") if len(kind) > 13 and second else (kind,)
    text = joined(
        html("<text x='{:.1f}' y='{:.1f}'>{}</text>", box.x, box.y + 4.0 + 12.0 * (i - (len(lines) - 1) / 2), line[:14])
        for i, line in enumerate(lines)
    )
    return html(
        "<g data-key='{}' class='g-box g-of-{} g-{}{}' role='button' tabindex='0' aria-pressed='{}' {}><title>{}{}</title>"
        "<rect x='{:.1f}' y='{:.1f}' width='{}' height='{}' rx='7'/>{}</g>",
        f"box {one.name}",
        "sys" if owner == SYSTEM else "own",
        COLOURS[one.grade],
        " g-picked" if chosen else "",
        "true" if chosen else "false",
        does("service", one.name, ""),
        one.name,
        f": {one.why}" if one.why else "",
        box.x - BOX_WIDTH / 2,
        box.y - BOX_HEIGHT / 2,
        BOX_WIDTH,
        BOX_HEIGHT,
        text,
    )


def _bundle(bundle: Bundle, boxes: Mapping[str, _Box], worst: Grade, choice: GraphChoice) -> Html:
    (a, b), found = bundle
    path, (x, y) = _curve(boxes[a], boxes[b])
    chosen = _is_chosen(choice, (a, b))
    touched = chosen or (choice.node in (a, b) and not choice.to)
    return html(
        "<g data-key='{}' class='g-bundle g-{}{}' role='button' tabindex='0' aria-pressed='{}' {}><title>{} → {}: {} topic{}</title>"
        "<path class='g-hit' d='{}'/><path class='g-wire' d='{}' stroke-width='{:.1f}' marker-end='url(#g-tip)'/>"
        "<circle cx='{:.1f}' cy='{:.1f}' r='7'/><text x='{:.1f}' y='{:.1f}'>{}</text></g>",
        f"bundle {a} {b}",
        COLOURS[worst],
        " g-picked" if chosen else " g-touched" if touched else "",
        "true" if chosen else "false",
        does("service", a, b),
        a,
        b,
        len(found),
        "" if len(found) == 1 else "s",
        path,
        path,
        1.0 + min(len(found), 10) * 0.12,
        x,
        y,
        x,
        y + 3.2,
        len(found),
    )


def _is_chosen(choice: GraphChoice, pair: tuple[str, str]) -> bool:
    return bool(choice.to) and (choice.node, choice.to) == pair


def _curve(a: _Box, b: _Box) -> tuple[str, tuple[float, float]]:
    """(path, place of its number [px]): straight down where data flows on, round the side where it leads back."""
    if b.layer > a.layer:
        lean = 0.18 * (b.x - a.x)
        x0, y0, x1, y1 = a.x + lean, a.y + BOX_HEIGHT / 2, b.x - lean, b.y - BOX_HEIGHT / 2
        bend = max(14.0, 0.35 * (y1 - y0))
        points = ((x0, y0), (x0, y0 + bend), (x1, y1 - bend), (x1, y1))
    else:
        side = 1.0 if a.x + b.x >= WIDTH else -1.0
        x0, x1 = a.x + side * BOX_WIDTH / 2, b.x + side * BOX_WIDTH / 2
        out = min(18.0 + 0.12 * hypot(a.x - b.x, a.y - b.y), 70.0)
        edge = WIDTH - 2.0 if side > 0 else 2.0
        reach = min(max(x0, x1) + out, edge) if side > 0 else max(min(x0, x1) - out, edge)
        points = ((x0, a.y), (reach, a.y), (reach, b.y), (x1, b.y))
    (p, q, r, s) = points
    middle = (0.125 * (p[0] + s[0]) + 0.375 * (q[0] + r[0]), 0.125 * (p[1] + s[1]) + 0.375 * (q[1] + r[1]))
    return f"M{p[0]:.1f} {p[1]:.1f}C{q[0]:.1f} {q[1]:.1f} {r[0]:.1f} {r[1]:.1f} {s[0]:.1f} {s[1]:.1f}", middle
