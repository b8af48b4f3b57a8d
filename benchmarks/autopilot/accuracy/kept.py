"""Figures of flights on all processors; each is kept in ``runs/benchmarks`` when it ends, so that an interrupted benchmark goes on.

A figure counts as long as nothing has changed of what it came from: the services, the mathematics, the vehicles, and the function.
"""

import hashlib
import inspect
import json
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import cache
from typing import Any

import typer

from uvf.models.scenario import ROOT

FOLDER = ROOT / "runs" / "benchmarks"
FLOWN = tuple(f"benchmarks/autopilot/accuracy/{name}.py" for name in ("course", "flight", "score"))
PARTS = ("services/autopilot", "services/sim_air", "src/uvf", "launch/vehicles", "vehicles", *FLOWN)
Figure = Callable[..., dict[str, Any]]


def several(function: Figure, jobs: Sequence[tuple[Any, ...]]) -> Iterator[dict[str, Any]]:
    """``function(*job)`` of each job, in their order; a dict that JSON can hold. Jobs: of what ``repr`` shows whole."""
    with ProcessPoolExecutor() as pool:
        found = [pool.submit(figures_of, function, job) for job in jobs]
        for number, future in enumerate(found, 1):
            yield future.result()
            typer.echo(f"uvf: {number} of {len(jobs)} flights", err=True)


def figures_of(function: Figure, job: tuple[Any, ...]) -> dict[str, Any]:
    """``function(*job)``, or what it was when it was last asked for."""
    path = FOLDER / f"{function.__name__}-{digest(inspect.getfile(function), repr((function.__name__, job)))}.json"
    if path.exists():
        return dict(json.loads(path.read_text()))
    figures = function(*job)
    FOLDER.mkdir(parents=True, exist_ok=True)
    part = path.with_suffix(".part")
    part.write_text(json.dumps(figures))
    part.rename(path)
    return figures


def digest(own: str, key: str) -> str:
    """Of all that figures come from, with the file ``own`` and what ``key`` tells."""
    return hashlib.sha256(f"{_sources(own)} {key}".encode()).hexdigest()[:24]


@cache
def _sources(own: str) -> str:
    """Digest of all that figures come from."""
    found = hashlib.sha256()
    files = [path for part in PARTS for top in ROOT.glob(part) for path in ([top] if top.is_file() else top.rglob("*"))]
    for path in sorted({*files, ROOT / own}):
        if path.is_file() and "__pycache__" not in path.parts:
            found.update(str(path.relative_to(ROOT)).encode() + path.read_bytes())
    return found.hexdigest()
