"""Flight accuracy: the course flown by the autopilot on noisy sensors, scored from the truth, in calm, wind and turbulence.

``python -m benchmarks.autopilot.accuracy.cases NAME [CASE ...] [PARAM=VALUE ...]`` flies one aircraft by our law alone.
"""

import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.autopilot.accuracy.flight import Case, scored
from benchmarks.autopilot.accuracy.kept import several
from launch.commands.bench import Figures

SEEDS, FEWER = range(1, 6), range(1, 4)
SPLIT = ("xtrack", "path", "orbit", "level", "slope", "orbit alt", "V sd")
SHOWN = (*SPLIT, "p95", "max", "V mean", "wind", "deg/s", "orbit deg/s", "throttle/s", "bank")
Row = dict[str, float]

ONE = {
    "calm": (Case(),),
    "5 from N": (Case((-5.0, 0.0)),),
    "5 from E": (Case((0.0, -5.0)),),
    "10 from N": (Case((-10.0, 0.0)),),
    "10 from E": (Case((0.0, -10.0)),),
    "light": tuple(Case(severity="light", seed=s) for s in SEEDS),
    "moderate": tuple(Case(severity="moderate", seed=s) for s in SEEDS),
    "10 from E, moderate": tuple(Case((0.0, -10.0), "moderate", s) for s in FEWER),
}


@dataclass(frozen=True)
class Flown:
    """An aircraft with sensors of a preset; ``params`` of its autopilot that are not its file's."""

    model: str
    preset: str
    params: Mapping[str, Any] = field(default_factory=dict)

    def over(self, names: Sequence[str], law: str) -> Iterator[tuple[str, list[Row]]]:
        """(name of the case, figures of each seed), case by case."""
        found = several(scored, [(self.model, case, self.preset, dict(self.params), law) for name in names for case in ONE[name]])
        for name in names:
            yield name, [next(found) for _ in ONE[name]]


def mean(rows: list[Row], metrics: Sequence[str] = SHOWN) -> Row:
    """Each metric's mean over the rows; nothing where there is no row."""
    return {m: float(np.mean([row[m] for row in rows])) for m in metrics} if rows else {}


def parts(rows: list[Row]) -> Figures:
    """Over the seeds the truth, its worst seed, control and estimation apart; ``flown``: the share that has flown the course to its end."""
    whole = [row for row in rows if row]
    found = {"truth": {**mean(whole), "flown": len(whole) / len(rows)}}
    if len(whole) > 1:
        found["worst seed"] = {m: max(row[m] for row in whole) for m in SHOWN}
    split = {part: mean(whole, [f"{part} {m}" for m in SPLIT]) for part in ("control", "estimation")}
    return found | {part: {m.removeprefix(f"{part} "): value for m, value in row.items()} for part, row in split.items()}


def beside(ours: list[Row], theirs: list[Row]) -> Figures:
    """``of thesis``: our way of surfaces over that of the thesis' control, on the seeds on which both fly the course."""
    pairs = [(our, their) for our, their in zip(ours, theirs, strict=True) if our and their]
    found = parts(ours) | {"thesis": parts(theirs)["truth"]}
    if pairs:
        our, their = (mean(list(rows), ["deg/s"])["deg/s"] for rows in zip(*pairs, strict=True))
        found["truth"]["of thesis"] = our / their
    return found


def table(flown: Flown) -> Figures:
    """All cases by our law and, with the sensors that decide, by the thesis' too."""
    names = list(ONE)
    ours = dict(flown.over(names, "energy"))
    theirs = dict(flown.over(names, "thesis")) if flown.preset == "good" else {}
    figures: Figures = {}
    for name in names:
        found = beside(ours[name], theirs[name]) if theirs else parts(ours[name])
        figures |= {f"{flown.model}, {flown.preset}, {name}: {part}": row for part, row in found.items()}
    return figures


def case(model: str, preset: str) -> Callable[[Path | None], Figures]:
    """What measures one aircraft with sensors of a preset."""
    return lambda data: table(Flown(model, preset))


CASES = {f"{model}_{preset}": case(model, preset) for model, preset in (("milvus", "good"), ("stick25", "good"), ("milvus", "book"))}

if __name__ == "__main__":
    MODEL, *WANTED = sys.argv[1:]
    PARAMS = {k: float(v) for k, v in (w.split("=") for w in WANTED if "=" in w)}
    NAMES = [w for w in WANTED if "=" not in w] or list(ONE)
    for NAME, ROWS in Flown(MODEL, "good", PARAMS).over(NAMES, "energy"):
        for PART, ROW in parts(ROWS).items():
            sys.stdout.write(f"{f'{NAME}: {PART}':32} {'  '.join(f'{metric} {value:.2f}' for metric, value in ROW.items())}\n")
            sys.stdout.flush()
