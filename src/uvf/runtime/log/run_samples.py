"""The messages of a whole run, whatever became of its files."""

import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from schemas.topics import PREFIX
from uvf.models.yaml_data import BadInput, nearest
from uvf.runtime.bus.interface import Sample, matches
from uvf.runtime.log.folder import logs_of
from uvf.runtime.log.reading import log_keys, log_metadata, read_log
from uvf.runtime.log.recovery import recover
from uvf.runtime.messages.topic_lookup import full_key

EVERYTHING = (f"{PREFIX}/**",)


def run_samples(run: Path, expressions: Sequence[str] = EVERYTHING) -> Iterator[Sample]:
    """The messages whose keys match, of the log or of all files of the run's folder, in order of time. Raises BadInput.

    A file that was cut off is read as far as it is whole; what a later file repeats at its head from the one before it comes once.
    """
    last: dict[str, tuple[int, int]] = {}
    for log in logs_of(run):
        with whole_log(log) as whole:
            for sample in read_log(whole, _keys(whole, expressions)):
                number = sample.stamp_ns, sample.seq
                if last.get(sample.key) != number:
                    yield sample
                last[sample.key] = number


def run_keys(run: Path) -> list[str]:
    """The keys that the files of a run have messages of, sorted; of one that was cut off, as far as it is whole. Raises BadInput."""
    keys: set[str] = set()
    for log in logs_of(run):
        with whole_log(log) as whole:
            keys.update(log_keys(whole))
    return sorted(keys)


def matching_keys(run: Path, wanted: str, known: Sequence[str]) -> list[str]:
    """Those of the keys ``known`` of a run that match ``wanted``, as people write it. Raises BadInput where none does."""
    found = [key for key in known if matches(full_key(wanted), key)]
    if not found:
        raise BadInput(f"log {run}: no messages of '{wanted}'; {nearest(wanted, (key.removeprefix(f'{PREFIX}/') for key in known))}")
    return found


def is_cut_off(log: Path) -> bool:
    """Whether a log has no end yet, or none any more. Raises BadInput for what is no log."""
    try:
        log_metadata(log)
    except BadInput as error:
        if "cut off" not in str(error):
            raise
        return True
    return False


@contextmanager
def whole_log(log: Path) -> Iterator[Path]:
    """The log, or where it was cut off, a copy of what is whole of it. Raises BadInput where nothing can be read of it."""
    if not is_cut_off(log):
        yield log
        return
    with tempfile.TemporaryDirectory() as folder:
        whole = Path(folder) / log.name
        recover(log, whole)
        yield whole


def _keys(log: Path, expressions: Sequence[str]) -> list[str] | None:
    """None for all of them."""
    if expressions == EVERYTHING:
        return None
    return [key for key in log_keys(log) if any(matches(expression, key) for expression in expressions)]
