"""MCAP logs of the bytes as they travel: schemas inside, sim time as log time, gaps counted. The only file importing mcap."""

import contextlib
import errno
import hashlib
import heapq
import io
import itertools
import struct
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Container, Iterable, Iterator, Mapping
from pathlib import Path
from types import TracebackType
from typing import IO, Any

from google.protobuf.descriptor import FileDescriptor
from google.protobuf.descriptor_pb2 import FileDescriptorSet
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.reader import make_reader
from mcap.records import Attachment, Channel, Chunk, McapRecord, Message, Schema
from mcap.stream_reader import StreamReader, breakup_chunk
from mcap.writer import MCAP0_MAGIC, CompressionType, Writer
from zstandard import ZstdError

from schemas.topics import CLOCK, PREFIX, SYSTEM, Qos
from uvf.runtime.bus import Bus, Sample
from uvf.runtime.clock import NS
from uvf.runtime.envelope import WRAP, GapCounter
from uvf.runtime.log_bounds import Admission, Standing
from uvf.runtime.params import BadInput
from uvf.runtime.topic_lookup import MESSAGES, topic_of

CHUNK = 1_000_000  # bytes
BROKEN = (McapError, ZstdError, EOFError, ValueError, KeyError, struct.error, OverflowError, MemoryError)
"""What the readers raise for bytes that are no log, the last two for lengths that are nonsense."""
HELD = 16_000_000  # bytes of chunks, while a log is read in order of time
DEPTH = 65_536  # messages that may wait for the writer
HEAD = struct.Struct("<BQ")  # kind and length of a record
_WALL_SOURCES = {"gcs", "mavlink", "recorder", "launcher"}
_NO_SPACE = (errno.ENOSPC, errno.EDQUOT)


class LogHash:
    """SHA-256 over the messages of each topic in order of (stamp, seq), then over the topics in order."""

    def __init__(self) -> None:
        self._topics: defaultdict[str, Any] = defaultdict(hashlib.sha256)

    def add(self, topic: str, stamp_ns: int, seq: int, payload: bytes) -> None:
        """Messages of one topic must come in their order; wall-clock sources are left out."""
        if topic.rpartition("/")[2] in _WALL_SOURCES:
            return
        self._topics[topic].update(stamp_ns.to_bytes(8, "big") + seq.to_bytes(8, "big") + payload)

    def hexdigest(self) -> str:
        whole = hashlib.sha256()
        for topic in sorted(self._topics):
            whole.update(topic.encode() + self._topics[topic].digest())
        return whole.hexdigest()


class Recorder:
    """Writes every logged message that it is given; a context manager, so that the footer is always there.

    before: the recorder of the file before this one. Its counts go on, and this file begins with the newest message
    of each topic that stands until the next one (latched and kept topics), so that it can be read and replayed alone.

    Sequence numbers have 32 bits in a log: after 4294967295 comes 0. What no log can hold is refused and counted.
    """

    def __init__(self, path: Path, attachments: Mapping[str, bytes] | None = None, before: "Recorder | None" = None) -> None:
        """attachments: contents by name. Raises BadInput where nothing can be written, except for want of space: see ``error``."""
        self.path = path
        self.error = ""
        """Why nothing is written any more; such a recorder still remembers what stands, for the file after it."""
        self.written = 0
        self.hash = LogHash()
        self._file = self._open()
        self._writer = Writer(self._file, chunk_size=CHUNK, compression=CompressionType.ZSTD)
        self._channels: dict[tuple[str, str], int] = {}
        self._schemas: dict[str, int] = {}
        self._counter: GapCounter = before._counter if before else GapCounter()
        self._admission: Admission = before._admission if before else Admission()
        self._standing: Standing = before._standing if before else Standing()
        self._unsaved: Counter[str] = Counter()
        with self._disk():
            self._writer.start(profile="", library="uvf")
            for name, data in (attachments or {}).items():
                self._writer.add_attachment(0, 0, name, "application/octet-stream", data)
        for sample in self._standing.in_force():
            self._put(sample)
        self.carried = self.written
        """How many messages at the head are repeated from before."""

    def _open(self) -> IO[bytes]:
        try:
            return self.path.open("wb")
        except OSError as error:
            if error.errno not in _NO_SPACE:
                raise BadInput(f"log {self.path}: cannot be written: {error.strerror}; choose another place") from error
            self.error = f"log {self.path}: {error.strerror}: nothing is recorded"
            return io.BytesIO()

    def __enter__(self) -> "Recorder":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def follow(self, bus: Bus) -> None:
        """Subscribes to everything below ``uvf/`` (on Zenoh, ``ZenohBus.subscribe_all`` brings the history too)."""
        bus.subscribe(f"{PREFIX}/**", Qos.SENSOR, self.write, DEPTH)

    def write(self, sample: Sample) -> None:
        """One message; a full disk ends the recording with one line in ``error``, never the program."""
        topic = topic_of(sample.key)
        if (topic is not None and not topic.logged) or not self._admission.admits(sample):
            return
        stands = topic is not None and (topic.kept or topic.qos is Qos.LATCHED)
        if stands and not self._standing.remember(sample):
            self.refused["head"] += 1
        self._unsaved[sample.key] += not self.error
        self._put(sample)

    def _put(self, sample: Sample) -> None:
        if self.error:
            return
        self._counter.count(sample.key, sample.boot, sample.seq)
        seq = sample.seq % WRAP
        try:
            channel = self._channels.get((sample.key, sample.type_name)) or self._add_channel(sample)
            self._writer.add_message(channel, sample.stamp_ns, sample.payload, time.time_ns(), seq)
            self.hash.add(sample.key, sample.stamp_ns, seq, sample.payload)
            self.written += 1
        except OSError as error:
            self._end(error)

    @contextlib.contextmanager
    def _disk(self) -> Iterator[None]:
        """What the disk refuses ends this file."""
        try:
            yield
        except OSError as error:
            self._end(error)

    def _end(self, error: OSError) -> None:
        """What came since the last flush may be lost with the file and counts as missed."""
        self.error = f"log {self.path}: {error.strerror}: recording ends here with {self.written} messages"
        for key, count in self._unsaved.items():
            self._counter.gaps[key] += count

    @property
    def gaps(self) -> dict[str, int]:
        """Messages missed, by key, since the first file of the run began."""
        return dict(self._counter.gaps)

    @property
    def refused(self) -> Counter[str]:
        """Messages that could not be recorded since the first file of the run began, by the words of ``log_bounds.REFUSED``."""
        return self._admission.refused

    @property
    def size(self) -> int:
        """Bytes written so far; the open chunk comes on top."""
        return self._file.tell()

    def _add_channel(self, sample: Sample) -> int:
        if sample.type_name not in self._schemas:
            data = descriptor_set(sample.type_name)
            self._schemas[sample.type_name] = self._writer.register_schema(sample.type_name, "protobuf" if data else "", data)
        channel = self._writer.register_channel("/" + sample.key, "protobuf", self._schemas[sample.type_name], {"zenoh_key": sample.key})
        self._channels[sample.key, sample.type_name] = channel
        return channel

    def flush(self) -> None:
        """Closes the chunk, so that a killed recorder loses no more than what came after."""
        if not self.error:
            with self._disk():
                self._writer.flush()  # type: ignore[no-untyped-call]
                self._unsaved.clear()

    def close(self) -> None:
        if self._file.closed:
            return
        if not self.error:
            with self._disk():
                self._writer.add_metadata("uvf", self._summary())
                self._writer.finish()  # type: ignore[no-untyped-call]
                self._file.flush()
        # After an error, what is left in the buffer cannot be written either.
        with contextlib.suppress(OSError):
            self._file.close()

    def _summary(self) -> dict[str, str]:
        complete = str(not self.gaps and not self.refused).lower()
        summary = {"messages": str(self.written), "carried": str(self.carried), "complete": complete, "hash": self.hash.hexdigest()}
        refused = {f"refused {why}": str(n) for why, n in self.refused.items()}
        return summary | refused | {f"gap {key}": str(n) for key, n in self.gaps.items()}


def descriptor_set(type_name: str) -> bytes:
    """The FileDescriptorSet of a type of the table with all that it imports; empty for an unknown type."""
    if type_name not in MESSAGES:
        return b""
    files: dict[str, FileDescriptor] = {}

    def add(file: FileDescriptor) -> None:
        for imported in file.dependencies:
            add(imported)
        files[file.name] = file

    add(MESSAGES[type_name].DESCRIPTOR.file)
    out = FileDescriptorSet()
    for file in files.values():
        file.CopyToProto(out.file.add())
    return out.SerializeToString(deterministic=True)


@contextlib.contextmanager
def _opened(path: Path) -> Iterator[IO[bytes]]:
    """Raises BadInput for what cannot be read or is no whole log."""
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
    """The messages of a log, of all keys or of these, in order of time. Raises BadInput for a file that is not a whole log."""
    topics = None if keys is None else {f"/{key}" for key in keys}
    with _opened(path) as file:
        for schema, channel, message in _in_order(file, topics):
            name = schema.name if schema else ""
            yield Sample(channel.topic[1:], name, message.data, message.log_time, message.sequence, 0)


def log_begin(path: Path) -> int:
    """The simulation time [ns] at which the recording began, for one that did not begin with the run; else 0. Raises BadInput.

    What is stamped earlier stands at the head of the file and is repeated from before.
    """
    first = next(read_log(path, [CLOCK.at(SYSTEM)]), None)
    return first.stamp_ns if first is not None and first.stamp_ns > NS / CLOCK.hz else 0


def log_end(path: Path) -> int | None:
    """The simulation time [ns] of the last tick of the clock; None without any. Raises BadInput.

    What is stamped later is of services whose outputs come late.
    """
    with _opened(path) as file:
        ticks = make_reader(file).iter_messages([f"/{CLOCK.at(SYSTEM)}"], reverse=True)
        return next((tick.log_time for *_, tick in ticks), None)


def log_metadata(path: Path) -> dict[str, str]:
    """What the recorder noted at the end: message count, completeness, hash, gaps. Raises BadInput."""
    with _opened(path) as file:
        return next((dict(m.metadata) for m in make_reader(file).iter_metadata() if m.name == "uvf"), {})


def log_attachments(path: Path) -> dict[str, bytes]:
    """The files that say what was run, by name. Raises BadInput."""
    with _opened(path) as file:
        return {a.name: a.data for a in make_reader(file).iter_attachments()}


def recover(source: Path, target: Path, tell: Callable[[str], None] = lambda line: None) -> int:
    """Copies every message of the whole chunks of a log, and what is attached, into a new, complete one; returns how many.

    tell: takes a line about what is damaged in the middle of it. Raises BadInput when there is nothing to save, or where the
    new log would take the place of the old one.
    """
    if target.exists() and target.samefile(source):
        raise BadInput(f"log {target}: is the log that is to be saved; name another file")
    with _opened(source) as file:
        outside = [r for r in _whole_records(file) if isinstance(r, (Attachment, Schema, Channel))]
        attached = {r.name: r.data for r in outside if isinstance(r, Attachment)}
        damaged: list[Chunk] = []
        # What a damaged chunk has defined stands at the end of a log once more.
        defined = [r for r in outside if not isinstance(r, Attachment)]
        samples = _samples(itertools.chain(defined, _in_chunks(_whole_records(file), damaged)))
        first = next(samples, None)
        if first is None:
            raise BadInput(f"log {source}: holds no whole message that could be saved")
        with Recorder(target, attached) as out:
            for sample in itertools.chain((first,), samples):
                out.write(sample)
    if out.error:
        raise BadInput(out.error)
    for chunk in damaged:
        tell(f"damaged and left out: {chunk.message_start_time / NS:.1f} to {chunk.message_end_time / NS:.1f} s")
    return out.written


def _whole_records(file: IO[bytes]) -> Iterator[McapRecord]:
    """From the beginning of the file, as they are read, chunks as they are; behind nonsense it goes on at the next chunk of the index."""
    size = file.seek(0, io.SEEK_END)
    file.seek(0)
    index = []
    with contextlib.suppress(*BROKEN):
        summary = make_reader(file).get_summary()
        index = sorted(i.chunk_start_offset for i in summary.chunk_indexes) if summary is not None else []
    begin: int | None = 0
    while begin is not None:
        file.seek(begin)
        with contextlib.suppress(*BROKEN):
            yield from StreamReader(file, skip_magic=begin > 0, emit_chunks=True, record_size_limit=size).records
            return
        reached = file.tell()
        begin = next((offset for offset in index if offset > max(reached, begin)), None)


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


def _samples(records: Iterable[McapRecord]) -> Iterator[Sample]:
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
            yield Sample(channel.topic[1:], name, record.data, record.log_time, record.sequence, 0)
