"""What ``uvf log events`` and ``uvf log echo`` print of a recorded run."""

from collections.abc import Iterable, Iterator
from itertools import islice
from pathlib import Path

from launch.commands.live.topic import full_key, sample_text
from launch.scoring.last_words import event_text
from schemas import topics
from schemas.messages import Event
from schemas.topics import SYSTEM
from uvf.models.yaml_data import BadInput, nearest
from uvf.runtime.bus.interface import Sample, matches
from uvf.runtime.bus.wire import Malformed, decode_sample
from uvf.runtime.log.folder import logs_of
from uvf.runtime.log.reading import log_keys, read_log
from uvf.runtime.messages.validation import escaped

EVENTS = (topics.EVENTS.by("*").at("*"), topics.SYSTEM_EVENTS.by("*").at(SYSTEM))


def event_lines(run: Path) -> Iterator[str]:
    """Yields one line for each event of a log or of a run's folder, in order of time. Raises BadInput."""
    count = 0
    for sample in _samples(run, EVENTS):
        owner = sample.key.split("/")[1]
        try:
            text = event_text(decode_sample(sample, Event))
        except Malformed as error:
            text = str(error)
        count += 1
        yield escaped(f"{sample.stamp_ns / 1e9:9.3f} s  {'system' if owner == SYSTEM else owner}  {text}")
    if not count:
        yield f"no events in {run}"


def message_lines(run: Path, key: str, count: int) -> Iterator[str]:
    """Yields the text of each message that matches a key, at most ``count`` (0 = all), in order of time. Raises BadInput."""
    wanted = full_key(key)
    known = {name for log in logs_of(run) for name in log_keys(log)}
    if not any(matches(wanted, name) for name in known):
        short = sorted(name.removeprefix(f"{topics.PREFIX}/") for name in known)
        raise BadInput(f"log {run}: no messages of '{key}'; {nearest(key, short)}")
    for sample in islice(_samples(run, [wanted]), count or None):
        yield sample_text(sample)


def _samples(run: Path, expressions: Iterable[str]) -> Iterator[Sample]:
    """The samples of all files of a run. What a later file repeats at its head from the file before it comes once."""
    last: dict[str, tuple[int, int]] = {}
    wanted = tuple(expressions)
    for log in logs_of(run):
        keys = [key for key in log_keys(log) if any(matches(expression, key) for expression in wanted)]
        for sample in read_log(log, keys):
            number = sample.stamp_ns, sample.seq
            if last.get(sample.key) != number:
                yield sample
            last[sample.key] = number
