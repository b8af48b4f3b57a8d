"""``uvf log export`` and ``uvf log layout``: a run for other programs, as tables, one file a topic, and with a layout to look at it."""

import json
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Literal

import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet
import typer
from google.protobuf.message import DecodeError

from launch.commands.log_contents import tell_cut_off
from launch.reports.foxglove import foxglove_layout
from uvf.models.yaml_data import BadInput
from uvf.runtime.log.folder import refuse_log, run_folder
from uvf.runtime.log.run_samples import matching_keys, run_keys, run_samples
from uvf.runtime.messages.fields import Getter, columns_of
from uvf.runtime.messages.step_times import NS
from uvf.runtime.messages.topic_lookup import topic_of

Kind = Literal["csv", "parquet"]
BATCH = 2000  # rows that are written at once
TYPES: dict[type, Any] = {float: pa.float64(), int: pa.int64(), bool: pa.bool_(), str: pa.string(), list: pa.list_(pa.float64())}


class TopicTable:
    """A file of one topic: column ``t`` [s, simulation], then one for each field of the message."""

    def __init__(self, key: str, target: Path, kind: Kind) -> None:
        """Raises OSError."""
        topic = topic_of(key)
        assert topic is not None
        self._message = topic.message
        self._columns = columns_of(topic.message.DESCRIPTOR)
        if kind == "csv":  # has no lists
            self._columns |= {name: (str, _json_of(get)) for name, (type_, get) in self._columns.items() if type_ is list}
        self._schema = pa.schema([("t", pa.float64()), *((name, TYPES[type_]) for name, (type_, _) in self._columns.items())])
        self._rows: list[list[Any]] = [[] for _ in self._schema.names]
        self._writer = (pa.csv.CSVWriter if kind == "csv" else pa.parquet.ParquetWriter)(target, self._schema)
        self.count = 0

    def add(self, stamp_ns: int, payload: bytes) -> None:
        """Adds a message; one that is broken was refused by every service, too, and is left out."""
        try:
            message = self._message.FromString(payload)
        except DecodeError:
            return
        for column, value in zip(self._rows, (stamp_ns / NS, *(get(message) for _, get in self._columns.values())), strict=True):
            column.append(value)
        self.count += 1
        if len(self._rows[0]) >= BATCH:
            self._flush()

    def _flush(self) -> None:
        self._writer.write_batch(pa.record_batch(self._rows, schema=self._schema))
        self._rows = [[] for _ in self._schema.names]

    def close(self) -> None:
        """Writes what is left."""
        if self._rows[0]:
            self._flush()
        self._writer.close()


def _json_of(get: Getter) -> Getter:
    return lambda message: json.dumps(get(message))


def export_log(run: Path, keys: Sequence[str], kind: Kind, out: Path | None) -> None:
    """Writes the topics that match ``keys`` (all, where none is given) into the folder ``out``, or beside the log. Raises BadInput."""
    known = [key for key in run_keys(run) if topic_of(key) is not None]
    chosen = sorted({name for key in keys for name in matching_keys(run, key, known)}) if keys else known
    folder = out or run_folder(run) / kind
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with ExitStack() as stack:
            tables = {key: TopicTable(key, folder / f"{key.partition('/')[2].replace('/', '.')}.{kind}", kind) for key in chosen}
            for table in tables.values():
                stack.callback(table.close)
            for sample in run_samples(run, chosen):
                tables[sample.key].add(sample.stamp_ns, sample.payload)
    except OSError as error:
        raise BadInput(f"{folder}: {error.strerror or error}: choose another folder with --out") from error
    typer.echo(f"{sum(table.count for table in tables.values())} messages of {len(tables)} topics saved into {folder}")
    tell_cut_off(run)


def save_layout(run: Path, out: Path | None) -> None:
    """Writes the layout for Foxglove to ``out``, or beside the log. Raises BadInput."""
    target = out or run_folder(run) / "foxglove.json"
    refuse_log(target, "a layout")
    try:
        target.write_text(json.dumps(foxglove_layout(run_keys(run)), indent=2), encoding="utf-8")
    except OSError as error:
        raise BadInput(f"{target}: {error.strerror}: choose another place with --out") from error
    typer.echo(f"{target}: open the log in Foxglove or Lichtblick, then import this layout")
