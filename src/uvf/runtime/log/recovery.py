"""What is whole of a damaged log, copied into a new one."""

import contextlib
import io
import itertools
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import IO

from mcap.reader import make_reader
from mcap.records import Attachment, Channel, Chunk, McapRecord, Message, Schema
from mcap.stream_reader import StreamReader, breakup_chunk

from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.interface import Sample
from uvf.runtime.log.reading import BROKEN, opened_log
from uvf.runtime.log.recording import Recorder
from uvf.runtime.messages.step_times import NS


def recover(source: Path, target: Path, tell: Callable[[str], None] = lambda line: None) -> int:
    """Copies every message of the whole chunks of a log, and what is attached, into a new, complete one; returns how many.

    tell: takes a line about what is damaged in the middle of it. Raises BadInput when there is nothing to save, or where the
    new log would take the place of the old one.
    """
    if target.exists() and target.samefile(source):
        raise BadInput(f"log {target}: is the log that is to be saved; name another file")
    damaged: list[Chunk] = []
    with opened_log(source) as file:
        outside = [r for r in _whole_records(file) if isinstance(r, (Attachment, Schema, Channel))]
        # What a damaged chunk has defined stands at the end of a log once more.
        defined = (r for r in outside if not isinstance(r, Attachment))
        samples = (sample for sample, _ in _recorded_samples(itertools.chain(defined, _in_chunks(_whole_records(file), damaged))))
        first = next(samples, None)
        if first is None:
            raise BadInput(f"log {source}: holds no whole message that could be saved")
        attached = {r.name: r.data for r in outside if isinstance(r, Attachment)}
        written = _recorded(target, attached, itertools.chain((first,), samples))
    for chunk in damaged:
        tell(f"damaged and left out: {chunk.message_start_time / NS:.1f} to {chunk.message_end_time / NS:.1f} s")
    return written


def _recorded(target: Path, attached: dict[str, bytes], samples: Iterable[Sample]) -> int:
    """Writes a log; how many messages went into it. Raises BadInput where it cannot be written."""
    with Recorder(target, attached) as out:
        for sample in samples:
            out.write(sample)
    if out.error:
        raise BadInput(out.error)
    return out.written


def _whole_records(file: IO[bytes]) -> Iterator[McapRecord]:
    """From the beginning of the file, as they are read, chunks as they are; behind nonsense it goes on at the next chunk of the index."""
    size = file.seek(0, io.SEEK_END)
    index = _chunk_offsets(file)
    begin: int | None = 0
    while begin is not None:
        file.seek(begin)
        with contextlib.suppress(*BROKEN):
            yield from StreamReader(file, skip_magic=begin > 0, emit_chunks=True, record_size_limit=size).records
            return
        reached = file.tell()
        begin = next((offset for offset in index if offset > max(reached, begin)), None)


def _chunk_offsets(file: IO[bytes]) -> list[int]:
    """Where the index at the end of the file says that chunks begin; none where it is lost."""
    file.seek(0)
    with contextlib.suppress(*BROKEN):
        summary = make_reader(file).get_summary()
        return sorted(i.chunk_start_offset for i in summary.chunk_indexes) if summary is not None else []
    return []


def _in_chunks(records: Iterable[McapRecord], damaged: list[Chunk]) -> Iterator[McapRecord]:
    """What the chunks hold; of those whose bytes are no longer what was written, nothing."""
    for record in records:
        if not isinstance(record, Chunk):
            yield record
            continue
        try:
            inside = breakup_chunk(record, validate_crc=True)
        except BROKEN:
            record.data = b""  # only its times are told
            damaged.append(record)
            continue
        yield from inside


def recorded_so_far(file: IO[bytes], attached: dict[str, bytes]) -> Iterator[tuple[Sample, int]]:
    """Whole messages of a log, which may still be being written, in the order of the file, and when each was recorded [ns since 1970].

    What is attached goes into ``attached`` as it is come by: before the first message.
    """
    yield from _recorded_samples(_in_chunks(_noting(_whole_records(file), attached), []))


def _noting(records: Iterable[McapRecord], attached: dict[str, bytes]) -> Iterator[McapRecord]:
    for record in records:
        if isinstance(record, Attachment):
            attached[record.name] = record.data
        yield record


def _recorded_samples(records: Iterable[McapRecord]) -> Iterator[tuple[Sample, int]]:
    """Messages in the order of the file, and when each was recorded [ns since 1970]."""
    schemas: dict[int, Schema] = {}
    channels: dict[int, Channel] = {}
    for record in records:
        if isinstance(record, Schema):
            schemas[record.id] = record
        elif isinstance(record, Channel):
            channels[record.id] = record
        elif isinstance(record, Message) and record.channel_id in channels:
            channel = channels[record.channel_id]
            name = schemas[channel.schema_id].name if channel.schema_id in schemas else ""
            yield Sample(channel.topic[1:], name, record.data, record.log_time, record.sequence, 0), record.publish_time
