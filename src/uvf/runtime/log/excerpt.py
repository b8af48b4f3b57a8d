"""A part of a run's log as a log of its own: also of one that is still being written."""

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from uvf.models.yaml_data import BadInput
from uvf.runtime.bus.interface import Sample
from uvf.runtime.log.bounds import Standing
from uvf.runtime.log.reading import opened_log
from uvf.runtime.log.recording import Recorder, stands
from uvf.runtime.log.recovery import recorded_so_far


class Span(NamedTuple):
    """From ``since`` up to ``until`` [ns], both included."""

    since: int
    until: int
    recorded: bool = False
    """Times of the recorder's own clock (since 1970) instead of simulation time, which may have started over."""

    def holds(self, stamp_ns: int, recorded_ns: int) -> bool:
        """Whether a message lies in it."""
        return self.since <= (recorded_ns if self.recorded else stamp_ns) <= self.until


def excerpt(logs: Sequence[Path], target: Path, span: Span) -> int:
    """Writes the messages of a span of a run to a log of its own; returns how many.

    It begins with the newest message of each topic that stands until the next one, and has the files that say what was run, so that
    it can be read and replayed alone. logs: of one run, in their order. Raises BadInput, also where the span holds no message.
    """
    if any(target.exists() and target.samefile(log) for log in logs if log.exists()):
        raise BadInput(f"log {target}: is the log that a part is to be taken of; name another file")
    out: Recorder | None = None
    written, standing, attached = 0, Standing(), dict[str, bytes]()
    try:
        for sample, recorded_ns in _read(logs, attached):
            if not span.holds(sample.stamp_ns, recorded_ns):
                if out is None and stands(sample.key):
                    standing.remember(sample)
                continue
            if out is None:
                out = Recorder(target, attached)
                for before in standing.in_force():
                    out.write(before)
            out.write(sample)
            written += 1
    finally:
        if out is not None:
            out.close()
    if out is None:
        raise BadInput(f"log {logs[0]}: holds nothing of that time" if logs else "no log has been written yet")
    if out.error:
        raise BadInput(out.error)
    return written


def _read(logs: Iterable[Path], attached: dict[str, bytes]) -> Iterator[tuple[Sample, int]]:
    """Messages as they were recorded, and when [ns]; what is attached goes to ``attached`` before the first message."""
    for path in logs:
        with opened_log(path) as file:
            yield from recorded_so_far(file, attached)
