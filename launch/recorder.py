"""The body of the recorder's process: the log of a run as a series of files, within the disk's space and the quota."""

import shutil
import time
from collections.abc import Callable, Mapping
from pathlib import Path

from launch import settings
from launch.attachments import attachments
from launch.processes import open_bus
from launch.runs import hold, keep_quota
from launch.worker import Worker, freeze_gc, lower_priority, worker
from schemas import topics
from schemas.messages import Event
from uvf.models.scenario import load_scenario
from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.interface import Sample
from uvf.runtime.bus.zenoh_bus import ZenohBus
from uvf.runtime.log.bounds import REFUSED
from uvf.runtime.log.folder import log_name, next_number
from uvf.runtime.log.recording import DEPTH, Recorder
from uvf.runtime.log.versions import versions

FLUSH_PERIOD = 1.0  # s
ROTATE_BYTES = 500_000_000
RESTARTS_EVERY = 1.0  # s, at most: who floods the bus with clocks does not flood the disk with files
ROOM = 100_000_000  # bytes free on the disk, from which recording is taken up again
NICE = 10
LOOK = 0.05  # s
CLOCK = topics.CLOCK.at(topics.SYSTEM)
LAST = 5.0  # s, for what has arrived until the end; who floods the bus does not keep the log open

Tell = Callable[[str, Event.Severity], None]


def free_space(folder: Path) -> int:
    """Free bytes on the folder's disk; 0 where the folder is gone."""
    try:
        return shutil.disk_usage(folder).free
    except OSError:
        return 0


class LogSeries:
    """``log-000.mcap``, ``log-001.mcap``, ...: each is readable alone; where the disk refuses, recording pauses and resumes.

    make_room: called before each file but the first.
    """

    def __init__(
        self,
        folder: Path,
        attachments: Mapping[str, bytes],
        tell: Tell,
        make_room: Callable[[], None] = lambda: None,
        rotate_bytes: float = ROTATE_BYTES,
        free: Callable[[Path], int] = free_space,
    ) -> None:
        """Raises BadInput where nothing can be written."""
        self._folder = folder
        self._attachments = attachments
        self._tell = tell
        self._make_room = make_room
        self._rotate_bytes = rotate_bytes
        self._free = free
        self._told = False
        self._told_refused: set[str] = set()
        self._epoch = self._restarts = 0
        self._restarted_at = -RESTARTS_EVERY
        self._number = next_number(folder)
        self._recorder = self._begin(None)

    def _begin(self, before: Recorder | None) -> Recorder:
        """The next file, with its head on the disk; if the disk refuses that, ``error`` says so and nothing is left behind."""
        path = self._folder / log_name(self._number)
        begun = Recorder(path, self._attachments, before, versions(), self._restarts)
        begun.flush()
        if begun.error:
            begun.close()
            path.unlink(missing_ok=True)
        else:
            self._number += 1
        return begun

    def write(self, sample: Sample) -> None:
        """Records a sample and rotates the file when it is full, and when time starts over."""
        if sample.key == CLOCK and sample.epoch > self._epoch:
            if self._epoch > 0 and time.monotonic() - self._restarted_at >= RESTARTS_EVERY:
                self._restarted_at = time.monotonic()
                self._restarts += 1
                self._recorder.start_over(sample)
                self._rotate()
            self._epoch = sample.epoch
        self._recorder.write(sample)
        if not self._recorder.error and self._recorder.size >= self._rotate_bytes:
            self._rotate()

    def _rotate(self) -> None:
        self._recorder.close()
        if not self._recorder.error:
            self._begin_next()

    def _begin_next(self) -> None:
        """Called while no file is being written."""
        self._make_room()
        try:
            self._recorder = self._begin(self._recorder)
        except BadInput as error:
            self._recorder.error = str(error)

    def flush(self) -> None:
        """Flushes what has been written, and resumes recording where the disk had refused."""
        self._recorder.flush()
        self._tell_refused()
        if not self._recorder.error and not self._recorder.path.exists():
            self._recorder.error = f"log {self._recorder.path}: has been removed: recording ends here"
        if self._recorder.error:
            self._take_up_again()

    def _tell_refused(self) -> None:
        """Each kind once; the log's metadata have the counts."""
        for why in self._recorder.refused.keys() - self._told_refused:
            self._told_refused.add(why)
            self._tell(f"not recorded: messages {REFUSED[why]}; 'uvf log info' shows how many", Event.WARNING)

    def _take_up_again(self) -> None:
        if not self._told:
            self._told = True
            self._tell(f"{self._recorder.error}; it goes on when there is room", Event.CRITICAL)
        self._recorder.close()
        if self._free(self._folder) >= ROOM:
            self._begin_next()
        if not self._recorder.error:
            self._told = False
            self._tell(f"recording goes on in {self._recorder.path}", Event.INFO)

    def close(self) -> None:
        """Closes the current file and reports an error that was not yet reported."""
        self._recorder.close()
        if self._recorder.error and not self._told:
            self._tell(self._recorder.error, Event.CRITICAL)


def run_recorder(folder: Path, mission: str) -> None:
    """Writes everything on the bus to ``folder`` until told to stop."""
    with worker("recorder") as life:
        lower_priority(NICE)
        site = load_scenario(settings.mission_path(mission))
        quota = settings.runs_quota()
        try:
            folder.mkdir(parents=True, exist_ok=True)
            hold(folder)
        except OSError as error:
            raise BadInput(f"{folder}: {error.strerror}: choose another folder") from error
        with open_bus(life) as bus:
            rotate_bytes = min(ROTATE_BYTES, quota / 4)
            make_room = _room_maker(folder, quota - rotate_bytes, life)
            series = LogSeries(folder, attachments(site), _voice(bus, life), make_room, rotate_bytes)
            try:
                _record(life, bus, series)
            finally:
                series.close()


def _voice(bus: ZenohBus, life: Worker) -> Tell:
    events = topics.SYSTEM_EVENTS.by("recorder")
    publisher = bus.publisher(events.at("sys"), Event.DESCRIPTOR.full_name, events.qos)

    def tell(line: str, severity: Event.Severity) -> None:
        life.warn(line)
        publisher.put(Event(severity=severity, text=line, source="recorder").SerializeToString(deterministic=True), 0)

    return tell


def _room_maker(folder: Path, limit: float, life: Worker) -> Callable[[], None]:
    """limit: the quota less the file that is to be written next."""

    def make_room() -> None:
        removed = keep_quota(folder, limit)
        if removed:
            life.warn(f"over the quota of UVF_RUNS_QUOTA_GB: removed {', '.join(map(str, removed))}")

    return make_room


def _record(life: Worker, bus: ZenohBus, series: LogSeries) -> None:
    arrived: list[Sample] = []
    bus.subscribe_all(arrived.append, DEPTH)
    bus.token(f"@node/sys/recorder/{bus.boot:x}")
    freeze_gc()
    flushed = time.monotonic()

    def write() -> bool:
        more = bus.poll()
        for sample in arrived:
            series.write(sample)
        arrived.clear()
        return more

    while life.goes_on():
        more = write()
        if time.monotonic() - flushed > FLUSH_PERIOD:
            series.flush()
            flushed = time.monotonic()
        if life.stop.wait(0.0 if more else LOOK):
            break
    end = time.monotonic() + LAST
    while write() and time.monotonic() < end:
        pass
