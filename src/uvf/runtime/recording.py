"""MCAP logs of the bytes as they travel: schemas inside, sim time as log time, gaps counted. The only file importing mcap."""

import contextlib
import errno
import functools
import hashlib
import io
import struct
import time
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from types import TracebackType
from typing import IO, Any

from google.protobuf.descriptor import FileDescriptor
from google.protobuf.descriptor_pb2 import FileDescriptorSet
from google.protobuf.message import Message as ProtobufMessage
from mcap.exceptions import McapError
from mcap.reader import make_reader
from mcap.records import Attachment, Channel, McapRecord, Message, Schema
from mcap.stream_reader import StreamReader
from mcap.writer import MCAP0_MAGIC, CompressionType, Writer
from zstandard import ZstdError

from schemas.topics import CLOCK, PREFIX, REQUESTS, SYSTEM, TOPICS, Qos, Topic
from uvf.runtime.bus import Bus, Sample, matches
from uvf.runtime.clock import NS
from uvf.runtime.envelope import GapCounter
from uvf.runtime.params import BadInput

CHUNK = 1_000_000  # bytes
BROKEN = (McapError, ZstdError, EOFError, ValueError, KeyError, struct.error, OverflowError, MemoryError)
"""What the readers raise for bytes that are no log, the last two for lengths that are nonsense."""
DEPTH = 65_536  # messages that may wait for the writer
_SAID = [t.message for t in TOPICS.values()] + [m for r in REQUESTS.values() for m in (r.message, r.reply)]
_TYPES: dict[str, Any] = {message.DESCRIPTOR.full_name: message for message in _SAID}
_WALL_SOURCES = {"gcs", "mavlink", "recorder", "launcher"}
_NO_SPACE = (errno.ENOSPC, errno.EDQUOT)


@functools.cache
def topic_of(key: str) -> Topic[ProtobufMessage] | None:
    """The line of the table that a key belongs to."""
    return next((topic for topic in TOPICS.values() if matches(topic.by("*").at("*"), key)), None)


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

    before: the recorder of the file before this one. Its count of gaps goes on, and this file begins with the newest message
    of each topic that stands until the next one (latched and kept topics), so that it can be read and replayed alone.
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
        self._channels: dict[str, int] = {}
        self._schemas: dict[str, int] = {}
        self._counter: GapCounter = before._counter if before else GapCounter()
        self._standing: dict[str, Sample] = dict(before._standing) if before else {}
        self._unsaved: Counter[str] = Counter()
        with self._disk():
            self._writer.start(profile="", library="uvf")
            for name, data in (attachments or {}).items():
                self._writer.add_attachment(0, 0, name, "application/octet-stream", data)
        for sample in _in_force(self._standing.values()):
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
        if topic is not None:
            if not topic.logged:
                return
            if topic.kept or topic.qos is Qos.LATCHED:
                self._remember(sample)
        self._unsaved[sample.key] += not self.error
        self._put(sample)

    def _remember(self, sample: Sample) -> None:
        """History that comes late does not take the place of what is newer."""
        old = self._standing.get(sample.key)
        if old is None or old.boot != sample.boot or old.seq <= sample.seq:
            self._standing[sample.key] = sample

    def _put(self, sample: Sample) -> None:
        if self.error:
            return
        self._counter.count(sample.key, sample.boot, sample.seq)
        try:
            channel = self._channels.get(sample.key) or self._add_channel(sample)
            self._writer.add_message(channel, sample.stamp_ns, sample.payload, time.time_ns(), sample.seq)
            self.hash.add(sample.key, sample.stamp_ns, sample.seq, sample.payload)
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
    def size(self) -> int:
        """Bytes written so far; the open chunk comes on top."""
        return self._file.tell()

    def _add_channel(self, sample: Sample) -> int:
        if sample.type_name not in self._schemas:
            data = descriptor_set(sample.type_name)
            self._schemas[sample.type_name] = self._writer.register_schema(sample.type_name, "protobuf" if data else "", data)
        channel = self._writer.register_channel("/" + sample.key, "protobuf", self._schemas[sample.type_name], {"zenoh_key": sample.key})
        self._channels[sample.key] = channel
        return channel

    def flush(self) -> None:
        """Closes the chunk, so that a killed recorder loses no more than what came after."""
        if not self.error:
            with self._disk():
                # The writer closes a chunk by size only and offers no public way to do it by time.
                getattr(self._writer, "_Writer__finalize_chunk")()  # noqa: B009
                self._file.flush()
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
        summary = {"messages": str(self.written), "carried": str(self.carried), "complete": str(not self.gaps).lower()}
        return summary | {"hash": self.hash.hexdigest()} | {f"gap {key}": str(n) for key, n in self.gaps.items()}


def _in_force(samples: Iterable[Sample]) -> list[Sample]:
    """Without those of an epoch that is over, except what holds on when time starts over (an operator's word)."""
    samples = sorted(samples, key=lambda s: (s.stamp_ns, s.key))
    newest = max((s.epoch for s in samples), default=0)
    return [s for s in samples if s.epoch in (0, newest) or ((topic := topic_of(s.key)) is not None and topic.across_epochs)]


def descriptor_set(type_name: str) -> bytes:
    """The FileDescriptorSet of a type of the table with all that it imports; empty for an unknown type."""
    if type_name not in _TYPES:
        return b""
    files: dict[str, FileDescriptor] = {}

    def add(file: FileDescriptor) -> None:
        for imported in file.dependencies:
            add(imported)
        files[file.name] = file

    add(_TYPES[type_name].DESCRIPTOR.file)
    out = FileDescriptorSet()
    for file in files.values():
        file.CopyToProto(out.file.add())
    return out.SerializeToString(deterministic=True)


@contextlib.contextmanager
def _opened(path: Path) -> Iterator[IO[bytes]]:
    """Raises BadInput for what cannot be read or is no whole log."""
    try:
        with path.open("rb") as file:
            _check_kind(path, file)
            yield file
    except IsADirectoryError as error:
        inside = min(path.glob("*.mcap"), default=None)
        hint = f"name the log in it, such as {inside}" if inside else "and there is no log in it"
        raise BadInput(f"log {path}: is a folder; {hint}") from error
    except OSError as error:
        raise BadInput(f"log {path}: {error.strerror}") from error
    except BROKEN as error:
        raise BadInput(f"log {path}: still being written, cut off or broken; 'uvf log recover {path}' copies what is whole") from error


def _check_kind(path: Path, file: IO[bytes]) -> None:
    start = file.read(len(MCAP0_MAGIC)) if file.seekable() else b""
    if not start:
        raise BadInput(f"log {path}: is empty: nothing was recorded in it" if path.is_file() else f"log {path}: is no file")
    if not MCAP0_MAGIC.startswith(start):
        raise BadInput(f"log {path}: is no MCAP log; logs of runs are runs/<time>/log-000.mcap")
    file.seek(0)


def read_log(path: Path) -> Iterator[Sample]:
    """The messages of a log in order of time. Raises BadInput for a file that is not a whole log."""
    with _opened(path) as file:
        for schema, channel, message in make_reader(file).iter_messages():
            name = schema.name if schema else ""
            yield Sample(channel.topic[1:], name, message.data, message.log_time, message.sequence, 0)


def log_begin(path: Path) -> int:
    """The simulation time [ns] at which the recording began, for one that did not begin with the run; else 0. Raises BadInput.

    What is stamped earlier stands at the head of the file and is repeated from before.
    """
    with _opened(path) as file:
        first = next((m for *_, m in make_reader(file).iter_messages(topics=[f"/{CLOCK.at(SYSTEM)}"])), None)
    return first.log_time if first is not None and first.log_time > NS / CLOCK.hz else 0


def log_metadata(path: Path) -> dict[str, str]:
    """What the recorder noted at the end: message count, completeness, hash, gaps. Raises BadInput."""
    with _opened(path) as file:
        return next((dict(m.metadata) for m in make_reader(file).iter_metadata() if m.name == "uvf"), {})


def log_attachments(path: Path) -> dict[str, bytes]:
    """The files that say what was run, by name. Raises BadInput."""
    with _opened(path) as file:
        return {a.name: a.data for a in make_reader(file).iter_attachments()}


def recover(source: Path, target: Path) -> int:
    """Copies every message of the whole chunks of a cut-off log, and what is attached, into a new, complete one; returns how many.

    Raises BadInput when there is nothing to save.
    """
    with _opened(source) as file:
        records = list(_whole_records(io.BytesIO(file.read())))
    saved = list(_samples(records))
    if not saved:
        raise BadInput(f"log {source}: holds no whole message that could be saved")
    with Recorder(target, {r.name: r.data for r in records if isinstance(r, Attachment)}) as out:
        for sample in saved:
            out.write(sample)
    if out.error:
        raise BadInput(out.error)
    return out.written


def _whole_records(file: IO[bytes]) -> Iterator[McapRecord]:
    with contextlib.suppress(*BROKEN):
        yield from StreamReader(file).records


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
