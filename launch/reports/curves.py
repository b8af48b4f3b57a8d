"""``uvf plot``: numbers of messages over time, as one picture."""

from collections.abc import Sequence
from pathlib import Path

import matplotlib.figure
import numpy as np
from google.protobuf.message import DecodeError
from matplotlib import colormaps
from numpy.typing import NDArray

from launch.reports.axes import finish, line
from uvf.models.yaml_data import BadInput, nearest
from uvf.runtime.log.run_samples import matching_keys, run_keys, run_samples
from uvf.runtime.messages.fields import Getter, number_of
from uvf.runtime.messages.step_times import NS
from uvf.runtime.messages.topic_lookup import topic_of

Floats = NDArray[np.float64]
KINDS = ("png", "svg", "pdf")
Curves = dict[str, tuple[Floats, Floats]]
"""By key: times (k,) [s, simulation] and values (k,)."""


def curves_of(run: Path, fields: Sequence[str]) -> list[Curves]:
    """The curves of each ``key.field`` as ``burger/nav/pose.pose.position.x``; a ``*`` in the key is any vehicle. Raises BadInput."""
    known = run_keys(run)
    readers = [_readers(run, field, known) for field in fields]
    points: list[dict[str, list[tuple[float, float]]]] = [{key: [] for key in of} for of in readers]
    for sample in run_samples(run, sorted({key for of in readers for key in of})):
        topic = topic_of(sample.key)
        try:
            message = topic.message.FromString(sample.payload) if topic is not None else None
        except DecodeError:
            continue
        for of, found in zip(readers, points, strict=True):
            if sample.key in of and (value := of[sample.key](message)) is not None:
                found[sample.key].append((sample.stamp_ns / NS, value))
    return [{key: _columns(rows) for key, rows in found.items()} for found in points]


def _readers(run: Path, wanted: str, known: Sequence[str]) -> dict[str, Getter]:
    """What reads the field, for each key that matches."""
    key, dot, path = wanted.partition(".")
    if not dot:
        raise BadInput(f"'{wanted}': no field is named; write KEY.FIELD, as burger/nav/pose.pose.position.x")
    readers = {}
    for name in matching_keys(run, key, known):
        topic = topic_of(name)
        if topic is None:
            raise BadInput(f"'{name}' is no topic of the table: its fields are not known")
        readers[name] = number_of(topic.message.DESCRIPTOR, path)
    return readers


def _columns(rows: list[tuple[float, float]]) -> tuple[Floats, Floats]:
    both = np.array(rows, dtype=np.float64).reshape(-1, 2)
    return both[:, 0], both[:, 1]


def draw_curves(run: Path, fields: Sequence[str], target: Path) -> Curves:
    """Draws a panel for each field, one below the other, over one axis of time into a file; returns all curves. Raises BadInput."""
    if (kind := target.suffix.removeprefix(".").lower()) not in KINDS:
        raise BadInput(f"--out {target}: no picture ends so; {nearest(kind, KINDS)}")
    drawn: Curves = {}
    sheet = matplotlib.figure.Figure(figsize=(13.0, 1.0 + 2.6 * len(fields)), layout="constrained")
    panels = sheet.subplots(len(fields), 1, sharex=True, squeeze=False)[:, 0]
    colours = colormaps["tab10"].colors  # type: ignore[attr-defined]
    for axes, field, curves in zip(panels, fields, curves_of(run, fields), strict=True):
        path = field.partition(".")[2]
        for i, (key, (t, values)) in enumerate(curves.items()):
            name = key.partition("/")[2]
            line(axes, t, values, name, colours[i % len(colours)])
            drawn[f"{name}.{path}"] = t, values
        finish(axes, path, 4)
    panels[-1].set_xlabel("s")
    try:
        sheet.savefig(target, dpi=90)
    except OSError as error:
        raise BadInput(f"{target}: {error.strerror}: choose another place with --out") from error
    return drawn
