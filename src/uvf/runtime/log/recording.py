"""MCAP logs of the bytes as they travel: schemas inside, sim time as log time, gaps counted. They are read by ``reading``."""

import contextlib
import errno
import hashlib
import io
import time
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import TracebackType
from typing import IO, Any

from google.protobuf.descriptor import FileDescriptor
from google.protobuf.descriptor_pb2 import FileDescriptorSet
from mcap.writer import CompressionType, Writer

from schemas.topics import PREFIX, Qos
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.envelope import WRAP, GapCounter
from uvf.runtime.bus.interface import Bus, Sample
from uvf.runtime.log.bounds import Admission, Standing
from uvf.runtime.log.reading import BEGINNING, RESTARTS
from uvf.runtime.messages.topic_lookup import MESSAGES, topic_of

CHUNK = 1_000_000  # bytes
DEPTH = 65_536  # messages that may wait for the writer
_WALL_SOURCES = {"gcs", "mavlink", "recorder", "launcher"}
_NO_SPACE = (errno.ENOSPC, errno.EDQUOT)


class LogHash:
    """SHA-256 over the messages of each topic in order of (stamp, seq), then over the topics in order."""

    def __init__(self) -> None:
        self._topics: defaultdict[str, Any] = defaultdict(hashlib.sha256)

    def add(self, topic: str, stamp_ns: int, seq: int, payload: bytes) -> None:
        """Adds a message; those of one topic must come in their order; wall-clock sources are left out."""
        if topic.rpartition("/")[2] in _WALL_SOURCES:
            return
        self._topics[topic].update(stamp_ns.to_bytes(8, "big") + seq.to_bytes(8, "big") + payload)

    def hexdigest(self) -> str:
        """The hash of all that was added, in hexadecimal."""
        whole = hashlib.sha256()
        for topic in sorted(self._topics):
            whole.update(topic.encode() + self._topics[topic].digest())
        return whole.hexdigest()


class Recorder:
    """Writes every logged message that it is given; a context manager, so that the footer is always there.

    before: the recorder of the file before this one. Its counts go on, and this file begins with the newest message
    of each topic that stands until the next one (latched and kept topics), so that it can be read and replayed alone.

    Sequence numbers have 32 bits in a log: after 4294967295 comes 0. What no log can hold is refused and counted.
    restarts: how often time has started over in the run.
    """

    def __init__(
        self,
        path: Path,
        attachments: Mapping[str, bytes] | None = None,
        before: "Recorder | None" = None,
        made_with: Mapping[str, str] | None = None,
        restarts: int = 0,
    ) -> None:
        """attachments: contents by name; made_with: versions by name.

        Raises BadInput where nothing can be written, except for want of space: see ``error``.
        """
        self.path = path
        self.error = ""
        """Why nothing is written any more; such a recorder still remembers what stands, for the file after it."""
        self.written = 0
        self._made_with = dict(made_with or {})
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
            self._writer.add_metadata(BEGINNING, {RESTARTS: str(restarts)})
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
        """Writes one message; a full disk ends the recording with one line in ``error``, never the program."""
        topic = topic_of(sample.key)
        if (topic is not None and not topic.logged) or not self._admission.admits(sample):
            return
        if stands(sample.key) and not self._standing.remember(sample):
            self.refused["head"] += 1
        self._unsaved[sample.key] += not self.error
        self._put(sample)

    def start_over(self, clock: Sample) -> None:
        """Time starts over with this message: what was said before does not stand in the file that follows."""
        self._standing.remember(clock)

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
        self.error = f"log {self.path}: {error.strerror}: recording ends here, after {self.written} messages; the last may be missing"
        for key, count in self._unsaved.items():
            self._counter.gaps[key] += count

    @property
    def gaps(self) -> dict[str, int]:
        """Number of messages missed, by key, since the first file of the run began."""
        return dict(self._counter.gaps)

    @property
    def refused(self) -> Counter[str]:
        """Number of messages that could not be recorded since the first file of the run began, by the words of ``bounds.REFUSED``."""
        return self._admission.refused

    @property
    def size(self) -> int:
        """Size in bytes written so far; the open chunk comes on top."""
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
        """Writes the footer and closes the file; after an error only what is possible."""
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
        return summary | self._made_with | refused | {f"gap {key}": str(n) for key, n in self.gaps.items()}


def stands(key: str) -> bool:
    """Whether the newest message of a key holds until the next one: of latched and kept topics."""
    topic = topic_of(key)
    return topic is not None and (topic.kept or topic.qos is Qos.LATCHED)


def descriptor_set(type_name: str) -> bytes:
    """FileDescriptorSet of a type of the table with all that it imports; empty for an unknown type."""
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
