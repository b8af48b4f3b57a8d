"""STOP ALL as every process knows it: in force while any engagement of any source has not been released by name.

Engagements and releases are two sets that only grow (a two-phase set, Shapiro et al. 2011, "A comprehensive study of
convergent and commutative replicated data types", 3.3.2), so that all who have heard the same words agree, in whatever order
these came, whatever their stamps and epochs, and however often they were repeated.
"""

import contextlib
import hashlib
import secrets
from collections import Counter, deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from google.protobuf.message import DecodeError

from schemas import topics
from schemas.limits import size_of
from schemas.messages import StopCommand, StopEngagement, StopState
from schemas.topics import OPERATORS
from uvf.runtime.bus.interface import Bus, Sample
from uvf.runtime.bus.wire import Malformed, decode_sample
from uvf.runtime.messages.convert import stamp_ns
from uvf.runtime.messages.validation import legible

ENGAGEMENTS_MOST = 64
"""Held at a time, beside one of all others."""
FOLLOW_DEPTH = 64  # words that wait in the subscription
RELEASED_MOST = 512
"""Names remembered; a word that is repeated after its release has been forgotten engages again."""
WAITING_MOST = 1024
"""Words that wait for the next step, which does not come while the clock stands; beyond, the oldest counts at once."""
REFUSED_MOST = 256  # lines that wait to be told
REPEATED_MOST = 64  # releases that a sender says again with each of its words
SOURCE_MOST = 100  # characters
OTHERS = "others"
Name = tuple[str, int]
Word = tuple[int, int]
"""Boot and sequence number of a message."""


@dataclass(frozen=True)
class StopStatus:
    """The engagements of STOP ALL that hold now; true while there is any."""

    engagements: tuple[StopEngagement, ...] = ()
    released_by: str = ""
    """The operator whose release was the last one heard."""

    def __bool__(self) -> bool:
        return bool(self.engagements)

    @property
    def who(self) -> str:
        """Each source once with its reasons: ``gcs (button); launcher (slam was given up)``."""
        return told(self.engagements)


def told(engagements: Iterable[StopEngagement]) -> str:
    """Text of who engages STOP ALL and why; empty when nobody does."""
    reasons: dict[str, list[str]] = {}
    for one in engagements:
        reasons.setdefault(one.source or "somebody unnamed", []).append(one.reason)
    parts = [(source, ", ".join(dict.fromkeys(filter(None, why)))) for source, why in reasons.items()]
    return "; ".join(f"{source} ({why})" if why else source for source, why in parts)


def name_of(engagement: StopEngagement) -> Name:
    """Name of an engagement: its source and its id."""
    return engagement.source, engagement.id


class StopBook:
    """All engagements and releases of STOP ALL that one process has heard of."""

    def __init__(self, at_once: bool = True) -> None:
        """at_once: words count when they arrive. Else a step reads those stamped before it, and at the step after at the latest."""
        self._at_once = at_once
        self._waiting: deque[tuple[Sample, bool]] = deque()
        self._engaged: dict[Name, StopEngagement] = {}
        self._released: dict[Name, Word | None] = {}
        self._words: dict[Name, Word] = {}
        """Which word has engaged it: who repeats that says nothing new."""
        self._released_by = ""
        self._refused: deque[str] = deque(maxlen=REFUSED_MOST)
        self._view = StopStatus()

    def follow(self, bus: Bus) -> None:
        """Subscribes to all words about STOP ALL, and to those that the book beside the router has kept."""
        for topic in (topics.STOP.by("*"), topics.STOP_STATE):
            bus.subscribe(topic.at(topics.SYSTEM), topic.qos, self.push, FOLLOW_DEPTH)

    def push(self, sample: Sample) -> None:
        """Takes a word from the bus, of a source or of the book beside the router."""
        if self._at_once:
            self._apply(sample)
            return
        self._waiting.append((sample, False))
        if len(self._waiting) > WAITING_MOST:
            self._apply(self._waiting.popleft()[0])

    def take(self, t_ns: int) -> StopStatus:
        """Status that holds for the step at ``t_ns`` [ns]. No stamp, however odd, holds a word back for more than one step."""
        if self._waiting:
            waiting, self._waiting = self._waiting, deque()
            for sample, seen in waiting:
                if seen or sample.stamp_ns < t_ns:
                    self._apply(sample)
                else:
                    self._waiting.append((sample, True))
        return self._view

    @property
    def now(self) -> StopStatus:
        """Status by all words that count so far."""
        return self._view

    def refused(self) -> list[str]:
        """Lines about words that did not count, since the last call."""
        lines = list(self._refused)
        self._refused.clear()
        return lines

    def take_up(self, engagements: Iterable[StopEngagement]) -> None:
        """Adds engagements that somebody else has heard: an instance before this one, or the book beside the router."""
        for engagement in engagements:
            self._engage(engagement)
        self._look()

    def state(self, now_ns: int) -> StopState:
        """Message of the whole book at ``now_ns`` [ns], for those who come late."""
        released = [StopEngagement(source=source, id=id_) for source, id_ in list(self._released)[-REPEATED_MOST:]]
        return StopState(timestamp=stamp_ns(now_ns), engagements=self._view.engagements, released=released)

    def _apply(self, sample: Sample) -> None:
        try:
            if sample.key == topics.STOP_STATE.at(topics.SYSTEM):
                self._hear_state(decode_sample(sample, StopState))
            else:
                self._hear_command(sample, decode_sample(sample, StopCommand))
        except Malformed as error:
            self._refused.append(str(error))
            self._hear_broken(sample)
        self._look()

    def _hear_broken(self, sample: Sample) -> None:
        """Whoever says stop is believed, also where the words for it are none, or the time: nothing else in it counts."""
        if sample.type_name != StopCommand.DESCRIPTOR.full_name or len(sample.payload) > size_of(StopCommand):
            return
        with contextlib.suppress(DecodeError):
            broken = StopCommand.FromString(sample.payload)
            if broken.engaged:
                words = StopCommand(engaged=True, id=broken.id, reason=legible(broken.reason))
                self._hear_command(sample, words)

    def _hear_state(self, state: StopState) -> None:
        for name in state.released:
            self._release(name_of(name))
        for engagement in state.engagements:
            self._engage(engagement)

    def _hear_command(self, sample: Sample, command: StopCommand) -> None:
        source = legible(sample.key.rpartition("/")[2], SOURCE_MOST)
        if command.releases and source not in OPERATORS:
            self._refused.append(f"{sample.key}: STOP ALL is released only by {', '.join(OPERATORS)}, not by {source}")
        elif command.releases:
            self._released_by = source
            for name in command.releases:
                self._release(name_of(name))
        elif not command.engaged and not command.id:
            self._refused.append(f"{sample.key}: a release of STOP ALL that names nothing; 'releases' says which engagements end")
        if command.engaged:
            id_ = command.id or self._own_id(sample, source)
            since = command.timestamp if command.HasField("timestamp") else None
            self._engage(StopEngagement(source=source, id=id_, reason=command.reason, since=since), (sample.boot, sample.seq))

    def _own_id(self, sample: Sample, source: str) -> int:
        """Of an engagement without a name: of its envelope, else of its bytes, each time after a release another one."""
        if sample.boot or sample.seq:
            return _digest(b"%d/%d" % (sample.boot, sample.seq))
        ids = (_digest(sample.payload + b"/%d" % n) for n in range(RELEASED_MOST + 1))
        return next(id_ for id_ in ids if (source, id_) not in self._released)

    def _engage(self, engagement: StopEngagement, word: Word | None = None) -> None:
        name = name_of(engagement)
        if name in self._released:
            if word is not None and self._released[name] not in (None, word):
                self._refused.append(f"STOP ALL: engagement {name[1]} of {name[0]} has been released: a new one needs another id")
            return
        if word is not None:
            self._words[name] = word
        if name not in self._engaged:
            self._engaged[name] = engagement
            self._keep_most(name)

    def _keep_most(self, newest: Name) -> None:
        """Of the source that has most, the oldest goes; where each has one, the newest counts under a name that all such share."""
        if len(self._engaged) <= ENGAGEMENTS_MOST:
            return
        most, count = Counter(source for source, _ in self._engaged).most_common(1)[0]
        gone = next(name for name in self._engaged if name[0] == most) if count > 1 else newest
        self._words.pop(gone, None)
        del self._engaged[gone]
        if count == 1 and not any(source == OTHERS for source, _ in self._engaged):
            id_ = _digest(repr(newest).encode())
            reason = f"{newest[0]}, and whoever else came after {ENGAGEMENTS_MOST} sources"
            self._engaged[OTHERS, id_] = StopEngagement(source=OTHERS, id=id_, reason=reason)
            self._refused.append(f"STOP ALL: engaged by more than {ENGAGEMENTS_MOST} sources: those after them are held as '{OTHERS}'")

    def _release(self, name: Name) -> None:
        self._engaged.pop(name, None)
        self._released.setdefault(name, self._words.pop(name, None))
        while len(self._released) > RELEASED_MOST:
            del self._released[next(iter(self._released))]

    def _look(self) -> None:
        """In an order that does not depend on that of arrival."""
        now = tuple(self._engaged[name] for name in sorted(self._engaged))
        if now != self._view.engagements or self._released_by != self._view.released_by:
            self._view = StopStatus(now, self._released_by)


def _digest(data: bytes) -> int:
    """A name that is never 0."""
    return int.from_bytes(hashlib.blake2b(data, digest_size=8).digest(), "big") | 1


class StopVoice:
    """Speaks about STOP ALL for one source; each word repeats its earlier releases, for whoever hears only the last one."""

    def __init__(self, source: str, new_id: Callable[[], int] = lambda: secrets.randbits(63) | 1) -> None:
        self._source = source
        self._new_id = new_id
        self._said = StopCommand(source=source)

    @property
    def engages(self) -> Name | None:
        """Name of the engagement that it stands by; None without one."""
        return (self._source, self._said.id) if self._said.engaged else None

    def engage(self, now_ns: int, reason: str) -> StopCommand:
        """Word of a new engagement, also where an older one holds: a release that is under way does not name it."""
        return self._say(now_ns, engaged=True, id=self._new_id(), reason=reason)

    def withdraw(self, now_ns: int) -> StopCommand:
        """Word by which it no longer stands by an engagement that an operator has released."""
        return self._say(now_ns, engaged=False, id=self._said.id, reason="")

    def release(self, now_ns: int, engagements: Iterable[StopEngagement]) -> StopCommand:
        """Word that releases these engagements by name."""
        names = {name_of(one): StopEngagement(source=one.source, id=one.id) for one in (*self._said.releases, *engagements)}
        own = (self._source, self._said.id)
        command = StopCommand(releases=list(names.values())[-REPEATED_MOST:])
        return self._say(now_ns, engaged=self._said.engaged and own not in names, id=self._said.id, reason="", releases=command.releases)

    def _say(self, now_ns: int, releases: Iterable[StopEngagement] | None = None, **said: bool | int | str) -> StopCommand:
        kept = list(self._said.releases if releases is None else releases)
        said |= {"reason": legible(str(said["reason"]))}
        self._said = StopCommand(timestamp=stamp_ns(max(now_ns, 0)), source=self._source, releases=kept, **said)  # type: ignore[arg-type]
        return self._said
