"""MCAP logs read again: in order of time, within bounded memory, checked."""

import contextlib
import errno
import heapq
import struct
from collections.abc import Container, Iterable, Iterator, Mapping
from itertools import islice
from pathlib import Path
from typing import IO

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.reader import make_reader
from mcap.records import Channel, Chunk, Message, Metadata, Schema
from mcap.stream_reader import StreamReader, breakup_chunk
from mcap.writer import MCAP0_MAGIC
from zstandard import ZstdError

from schemas.topics import CLOCK, SYSTEM
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.interface import Sample
from uvf.runtime.messages.step_times import NS

BROKEN = (McapError, ZstdError, EOFError, ValueError, KeyError, struct.error, OverflowError, MemoryError)
"""What the readers raise for bytes that are no log, the last two for lengths that are nonsense."""
BEGINNING, RESTARTS = "uvf.begin", "restarts"
"""Note at the head of a log, and what it tells: how often time had started over in its run."""
HEADING = 4  # records, among which it is
HELD = 16_000_000  # bytes of chunks, while a log is read in order of time
HEAD = struct.Struct("<BQ")  # kind and length of a record


@contextlib.contextmanager
def opened_log(path: Path) -> Iterator[IO[bytes]]:
    """Opens a log for reading. Raises BadInput for what cannot be read or is no whole log."""
    try:
        if not (path.is_file() or path.is_dir()) and path.exists():  # a pipe would never be opened
            raise BadInput(f"log {path}: is no file")
        with path.open("rb") as file:
            _check_kind(path, file)
            yield file
    except IsADirectoryError as error:
        inside = min(path.glob("*.mcap"), default=None)
        hint = f"name the log in it, such as {inside}" if inside else "and there is no log in it"
        raise BadInput(f"log {path}: is a folder; {hint}") from error
    except (OSError, *BROKEN) as error:
        # What is too short to have an end is looked for before its beginning: an invalid argument.
        if isinstance(error, OSError) and error.errno != errno.EINVAL:
            raise BadInput(f"log {path}: {error.strerror}") from error
        raise BadInput(f"log {path}: still being written, cut off or broken; 'uvf log recover {path}' copies what is whole") from error


def is_log(path: Path) -> bool:
    """Whether a file begins as a log does, whole or not. Raises OSError."""
    with path.open("rb") as file:
        return file.read(len(MCAP0_MAGIC)) == MCAP0_MAGIC


def _check_kind(path: Path, file: IO[bytes]) -> None:
    start = file.read(len(MCAP0_MAGIC))
    if not start:
        raise BadInput(f"log {path}: is empty: nothing was recorded in it")
    if not MCAP0_MAGIC.startswith(start):
        raise BadInput(f"log {path}: is no MCAP log; logs of runs are runs/<time>/log-000.mcap")
    file.seek(0)


class _HeldChunks:
    """The messages of chunks, each in order of time, as far as they fit into HELD; the others are read again when they are needed."""

    def __init__(self, file: IO[bytes], channels: Container[int], heads: Mapping[int, bytes]) -> None:
        """heads: the first bytes that a chunk has, by its offset: with others it is none any more."""
        self._file = file
        self._heads = heads
        self._channels = channels
        self._held: dict[int, tuple[int, list[Message]]] = {}  # offset -> size, messages; the one used last at the end

    def get(self, offset: int) -> list[Message]:
        size, messages = self._held.pop(offset) if offset in self._held else self._read(offset)
        self._held[offset] = size, messages
        while sum(size for size, _ in self._held.values()) > HELD and len(self._held) > 1:
            self.drop(next(iter(self._held)))
        return messages

    def drop(self, offset: int) -> None:
        del self._held[offset]

    def _read(self, offset: int) -> tuple[int, list[Message]]:
        self._file.seek(offset)
        if self._file.read(HEAD.size) != self._heads[offset]:
            raise McapError(f"no chunk at {offset}")
        chunk = Chunk.read(ReadDataStream(self._file))
        found = [r for r in breakup_chunk(chunk, validate_crc=True) if isinstance(r, Message) and r.channel_id in self._channels]
        return chunk.uncompressed_size, sorted(found, key=lambda m: m.log_time)


def _in_order(file: IO[bytes], topics: Container[str] | None = None) -> Iterator[tuple[Schema | None, Channel, Message]]:
    """In order of (log time, chunk, place in the chunk), as ``iter_messages`` of mcap's reader.

    That one holds a chunk from its earliest message to its latest: with one message without a stamp in each, the whole log.
    """
    reader = make_reader(file)
    summary = reader.get_summary()
    if summary is None or not summary.chunk_indexes:
        # Of an empty log, or of one without an index, which none of ours is.
        yield from (found for found in reader.iter_messages() if topics is None or found[1].topic in topics)
        return
    channels = {n: c for n, c in summary.channels.items() if topics is None or c.topic in topics}
    wanted = [i for i in summary.chunk_indexes if not i.message_index_offsets or not channels.keys().isdisjoint(i.message_index_offsets)]
    heads = {i.chunk_start_offset: HEAD.pack(Opcode.CHUNK, i.chunk_length - HEAD.size) for i in wanted}
    held = _HeldChunks(file, channels, heads)
    ahead = [(index.message_start_time, index.chunk_start_offset, 0) for index in wanted]
    heapq.heapify(ahead)
    while ahead:
        _, offset, begin = heapq.heappop(ahead)
        messages = held.get(offset)
        for n in range(begin, len(messages)):
            message = messages[n]
            if ahead and (message.log_time, offset) > ahead[0][:2]:
                heapq.heappush(ahead, (message.log_time, offset, n))
                break
            channel = channels[message.channel_id]
            yield summary.schemas.get(channel.schema_id), channel, message
        else:
            held.drop(offset)


def read_log(path: Path, keys: Iterable[str] | None = None) -> Iterator[Sample]:
    """Messages of a log, of all keys or of these, in order of time. Raises BadInput for a file that is not a whole log."""
    topics = None if keys is None else {f"/{key}" for key in keys}
    with opened_log(path) as file:
        for schema, channel, message in _in_order(file, topics):
            name = schema.name if schema else ""
            yield Sample(channel.topic[1:], name, message.data, message.log_time, message.sequence, 0)


def log_keys(path: Path) -> list[str]:
    """The keys that a log has messages of, sorted. Raises BadInput for a file that is not a whole log."""
    with opened_log(path) as file:
        summary = make_reader(file).get_summary()
        if summary is None or summary.statistics is None:  # a log of another program: none of ours is
            return sorted({channel.topic[1:] for _, channel, _ in _in_order(file)})
        counts = summary.statistics.channel_message_counts
        return sorted({channel.topic[1:] for n, channel in summary.channels.items() if counts.get(n)})


def log_begin(path: Path) -> int:
    """Simulation time [ns] at which the recording began, for one that did not begin with the run; else 0. Raises BadInput.

    What is stamped earlier stands at the head of the file and is repeated from before.
    """
    first = next(read_log(path, [CLOCK.at(SYSTEM)]), None)
    return first.stamp_ns if first is not None and first.stamp_ns > NS / CLOCK.hz else 0


def log_end(path: Path) -> int | None:
    """Simulation time [ns] of the last tick of the clock; None without any. Raises BadInput.

    What is stamped later is of services whose outputs come late.
    """
    with opened_log(path) as file:
        ticks = make_reader(file).iter_messages([f"/{CLOCK.at(SYSTEM)}"], reverse=True)
        return next((tick.log_time for *_, tick in ticks), None)


def log_metadata(path: Path) -> dict[str, str]:
    """Notes of the recorder at the end of a log: message count, completeness, hash, gaps. Raises BadInput."""
    with opened_log(path) as file:
        return next((dict(m.metadata) for m in make_reader(file).iter_metadata() if m.name == "uvf"), {})


def restarts_of(path: Path) -> int:
    """How often time had started over in its run when this log began; 0 for a file that does not say, or is none."""
    with contextlib.suppress(OSError, *BROKEN), path.open("rb") as file:
        for record in islice(StreamReader(file, emit_chunks=True).records, HEADING):
            if isinstance(record, Metadata) and record.name == BEGINNING and (told := record.metadata.get(RESTARTS, "")).isdecimal():
                return int(told[:9])
    return 0


def log_attachments(path: Path) -> dict[str, bytes]:
    """Files that say what was run, by name. Raises BadInput."""
    with opened_log(path) as file:
        return {a.name: a.data for a in make_reader(file).iter_attachments()}
