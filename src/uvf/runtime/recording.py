"""MCAP logs of the bytes as they travel: schemas inside, sim time as log time, gaps counted. The only file importing mcap."""

import contextlib
import hashlib
import io
import struct
import time
from collections import defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path
from types import TracebackType
from typing import IO, Any

from google.protobuf.descriptor import FileDescriptor
from google.protobuf.descriptor_pb2 import FileDescriptorSet
from mcap.exceptions import McapError
from mcap.reader import make_reader
from mcap.records import Channel, Message, Schema
from mcap.stream_reader import StreamReader
from mcap.writer import CompressionType, Writer

from schemas.topics import PREFIX, REQUESTS, TOPICS, Qos
from uvf.runtime.bus import Bus, Sample, matches
from uvf.runtime.envelope import GapCounter
from uvf.runtime.params import BadInput

CHUNK = 1_000_000  # bytes
BROKEN = (McapError, EOFError, ValueError, KeyError, struct.error)
"""What the readers raise for bytes that are no log."""
DEPTH = 65_536  # messages that may wait for the writer
_SAID = [t.message for t in TOPICS.values()] + [m for r in REQUESTS.values() for m in (r.message, r.reply)]
_TYPES: dict[str, Any] = {message.DESCRIPTOR.full_name: message for message in _SAID}
_SILENT = [topic.by("*").at("*") for topic in TOPICS.values() if not topic.logged]
_WALL_SOURCES = {"gcs", "mavlink", "recorder", "launcher"}


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
    """Writes every logged message that it is given; a context manager, so that the footer is always there."""

    def __init__(self, path: Path, attachments: Sequence[Path] = ()) -> None:
        try:
            self._file = path.open("wb")
        except OSError as error:
            raise BadInput(f"log {path}: cannot be written: {error.strerror}; choose another with --log") from error
        self._writer = Writer(self._file, chunk_size=CHUNK, compression=CompressionType.ZSTD)
        self._writer.start(profile="", library="uvf")
        self._channels: dict[str, int] = {}
        self._schemas: dict[str, int] = {}
        self._counter = GapCounter()
        self.written = 0
        self.error = ""
        self.hash = LogHash()
        for attached in attachments:
            self._attach(attached)

    def __enter__(self) -> "Recorder":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def follow(self, bus: Bus) -> None:
        """Subscribes to everything below ``uvf/`` (on Zenoh, ``ZenohBus.subscribe_all`` brings the history too)."""
        bus.subscribe(f"{PREFIX}/**", Qos.SENSOR, self.write, DEPTH)

    def write(self, sample: Sample) -> None:
        """One message; a full disk ends the recording with one line in ``error``, never the program."""
        if self.error or any(matches(key, sample.key) for key in _SILENT):
            return
        self._counter.count(sample.key, sample.boot, sample.seq)
        try:
            channel = self._channels.get(sample.key) or self._add_channel(sample)
            self._writer.add_message(channel, sample.stamp_ns, sample.payload, time.time_ns(), sample.seq)
        except OSError as error:
            self.error = f"log: {error.strerror}: recording ends here with {self.written} messages"
            return
        self.hash.add(sample.key, sample.stamp_ns, sample.seq, sample.payload)
        self.written += 1

    @property
    def gaps(self) -> dict[str, int]:
        """Messages missed, by key."""
        return dict(self._counter.gaps)

    def _add_channel(self, sample: Sample) -> int:
        if sample.type_name not in self._schemas:
            data = descriptor_set(sample.type_name)
            self._schemas[sample.type_name] = self._writer.register_schema(sample.type_name, "protobuf" if data else "", data)
        channel = self._writer.register_channel("/" + sample.key, "protobuf", self._schemas[sample.type_name], {"zenoh_key": sample.key})
        self._channels[sample.key] = channel
        return channel

    def _attach(self, path: Path) -> None:
        self._writer.add_attachment(0, 0, str(path.name), "application/octet-stream", path.read_bytes())

    def flush(self) -> None:
        """Closes the chunk, so that a killed recorder loses no more than what came after."""
        if not self.error:
            try:
                # The writer closes a chunk by size only and offers no public way to do it by time.
                getattr(self._writer, "_Writer__finalize_chunk")()  # noqa: B009
                self._file.flush()
            except OSError as error:
                self.error = f"log: {error.strerror}: recording ends here with {self.written} messages"

    def close(self) -> None:
        if self._file.closed:
            return
        # After an error, what is left in the buffers cannot be written either.
        with contextlib.suppress(OSError) if self.error else contextlib.nullcontext(), self._file:
            if not self.error:
                self._writer.add_metadata("uvf", self._summary())
                self._writer.finish()  # type: ignore[no-untyped-call]

    def _summary(self) -> dict[str, str]:
        summary = {"messages": str(self.written), "complete": str(not self.gaps).lower(), "hash": self.hash.hexdigest()}
        return summary | {f"gap {key}": str(n) for key, n in self.gaps.items()}


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
            yield file
    except OSError as error:
        raise BadInput(f"log {path}: {error.strerror}") from error
    except BROKEN as error:
        raise BadInput(f"log {path}: still being written, cut off or broken; 'uvf log recover {path}' copies what is whole") from error


def read_log(path: Path) -> Iterator[Sample]:
    """The messages of a log in order of time. Raises BadInput for a file that is not a whole log."""
    with _opened(path) as file:
        for schema, channel, message in make_reader(file).iter_messages():
            name = schema.name if schema else ""
            yield Sample(channel.topic[1:], name, message.data, message.log_time, message.sequence, 0)


def log_metadata(path: Path) -> dict[str, str]:
    """What the recorder noted at the end: message count, completeness, hash, gaps. Raises BadInput."""
    with _opened(path) as file:
        return next((dict(m.metadata) for m in make_reader(file).iter_metadata() if m.name == "uvf"), {})


def recover(source: Path, target: Path) -> int:
    """Copies every message of the whole chunks of a cut-off log into a new, complete one; returns how many.

    Raises BadInput when there is nothing to save.
    """
    with _opened(source) as file:
        saved = list(_salvage(file.read()))
    if not saved:
        raise BadInput(f"log {source}: holds no whole message that could be saved")
    with Recorder(target) as out:
        for sample in saved:
            out.write(sample)
    return out.written


def _salvage(data: bytes) -> Iterator[Sample]:
    schemas: dict[int, Schema] = {}
    channels: dict[int, Channel] = {}
    try:
        for record in StreamReader(io.BytesIO(data)).records:
            if isinstance(record, Schema):
                schemas[record.id] = record
            elif isinstance(record, Channel):
                channels[record.id] = record
            elif isinstance(record, Message):
                channel = channels[record.channel_id]
                name = schemas[channel.schema_id].name
                yield Sample(channel.topic[1:], name, record.data, record.log_time, record.sequence, 0)
    except BROKEN:
        return
