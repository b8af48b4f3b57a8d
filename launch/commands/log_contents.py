"""What ``uvf log events`` and ``uvf log echo`` print of a recorded run, and what is said of one that has no end."""

from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import typer

from launch.commands.live.topic import sample_text
from launch.scoring.last_words import event_text
from schemas import topics
from schemas.messages import Event
from schemas.topics import SYSTEM
from uvf.runtime.bus.wire import Malformed, decode_sample
from uvf.runtime.log.folder import logs_of
from uvf.runtime.log.run_samples import is_cut_off, matching_keys, run_keys, run_samples
from uvf.runtime.messages.validation import escaped

EVENTS = (topics.EVENTS.by("*").at("*"), topics.SYSTEM_EVENTS.by("*").at(SYSTEM))


def event_lines(run: Path) -> Iterator[str]:
    """Yields one line for each event of a log or of a run's folder, in order of time. Raises BadInput."""
    count = 0
    for sample in run_samples(run, EVENTS):
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
    for sample in islice(run_samples(run, matching_keys(run, key, run_keys(run))), count or None):
        yield sample_text(sample)


def tell_cut_off(run: Path) -> None:
    """Says, beside what is printed of a run, of which of its logs only a part is whole. Raises BadInput."""
    for log in logs_of(run):
        if is_cut_off(log):
            typer.echo(f"{log}: still being written, or cut off: this is what is whole of it", err=True)
