"""What is wrong with a topic, and why, and what to do about it: what is declared against what is heard."""

from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any

from schemas.topics import Qos, Topic
from services.gcs.state.graph.endpoints import LivingService
from services.gcs.state.graph.traffic import OVER, KeyTraffic

WARM_UP = 5.0  # s, wall: listening for a shorter time tells of nothing that is missing
OLD_AT_LEAST = 2.0  # s, wall: a shorter silence may be the machine's
PAUSE, PAUSE_PERIODS = 0.5, 3.0  # s, periods: after such a pause nobody is slow, but silent
SLOW = 0.5  # share of the nominal rate
BARELY = 1.0  # Hz: what is due more seldom than that is not counted within OVER
AT_WILL = (Qos.CONTROL, Qos.LOCKSTEP)
"""Sent when there is something to command, or when the clock is to wait: silence means nothing unless somebody needs it."""
WRONG_WITHIN = 10.0  # s, wall


class Grade(IntEnum):
    """How bad it is; the worst is the largest."""

    FINE = 0
    QUIET = 1
    """Nothing is wrong, but something is worth knowing."""
    AMBER = 2
    RED = 3


@dataclass
class TopicEvidence:
    """All that is known of one key when it is judged."""

    key: str
    topic: Topic[Any] | None
    """Its line of the table."""
    known: bool
    """Whether the table has it, as a topic or as half a request."""
    traffic: KeyTraffic | None
    t: float
    """Now [s, wall]."""
    listened: float
    """For how long everything has been listened to [s, wall]."""
    pace: float
    """Simulation time per wall time [-], at most 1; 0 while time stands still."""
    writers: list[LivingService] = field(default_factory=list)
    """Those that do write it: by the process that sent it, or because they declare this very key."""
    gone: list[LivingService] = field(default_factory=list)
    """Those that wrote it before they vanished."""
    perhaps: list[LivingService] = field(default_factory=list)
    """Those that may write it: they declare it of any vehicle."""
    readers: list[LivingService] = field(default_factory=list)
    needed_by: list[LivingService] = field(default_factory=list)
    """The readers that cannot step without it."""

    @property
    def age(self) -> float | None:
        """Age of its newest message [s, wall]; None before the first."""
        return self.t - self.traffic.at if self.traffic is not None else None

    @property
    def rate(self) -> float:
        """Messages per second [1/s, wall] over the last seconds."""
        return self.traffic.per_second(self.t)[0] if self.traffic is not None else 0.0

    @property
    def nominal(self) -> float:
        """Rate of the table [1/s, wall] at the present pace; 0 for what is sent on change."""
        return self.topic.hz * self.pace if self.topic is not None else 0.0

    @property
    def max_age(self) -> float:
        """From which age [s, wall] on it counts as old."""
        if self.topic is None or self.pace <= 0.0:
            return float("inf")
        return max(self.topic.max_age / self.pace, OLD_AT_LEAST)

    @property
    def is_silent(self) -> bool:
        """Whether it is never heard, or old."""
        return self.age is None or self.age > self.max_age

    @property
    def may_be_silent(self) -> bool:
        """Whether silence means nothing: nobody has listened for long, time stands still, or it is sent on change only."""
        return self.listened < WARM_UP or self.pace <= 0.0


def judged(e: TopicEvidence) -> tuple[Grade, str]:
    """(how bad, why and what to do) of a topic; the gravest of what is wrong with it."""
    return _misuse(e) or _absence(e) or _slowness(e) or _remark(e)


def names(services: list[LivingService], most: int = 3) -> str:
    """Some services by name: ``burger/slam and 2 more``."""
    told = [service.name for service in services[:most]]
    return ", ".join(told) + (f" and {len(services) - most} more" if len(services) > most else "")


def _misuse(e: TopicEvidence) -> tuple[Grade, str] | None:
    heard = e.traffic
    if heard is None:
        return None
    who = names(e.writers) or "a process that declares nothing"
    if heard.wrong is not None and e.t - heard.wrong[1] <= WRONG_WITHIN and e.topic is not None:
        said, meant = heard.wrong[0] or "no type", e.topic.message.DESCRIPTOR.full_name
        return Grade.RED, f"wrong type: {heard.wrong_count} messages of {said}, the table says {meant}; look at {who}"
    if e.t - heard.rivals_at <= OVER:
        return Grade.RED, f"two processes write it at once ({who}): end one of them"
    if not e.known:
        return Grade.AMBER, f"no such topic in the table; sent by {who}: correct its key, or add a line to schemas/topics.py"
    return None


def _absence(e: TopicEvidence) -> tuple[Grade, str] | None:
    if not e.is_silent or e.may_be_silent:
        return None
    age = f"{e.age:.0f} s" if e.age is not None else ""
    since = f"silent for {age}" if age else "never heard"
    ages = e.topic is not None and e.topic.max_age != float("inf")
    if e.gone and not e.writers and (ages or e.needed_by):
        lacking = f"; {names(e.needed_by)} waits for it" if e.needed_by else ""
        return Grade.RED, f"{since}: its writer {names(e.gone)} is gone{lacking}; start it again"
    if e.needed_by:
        source = names(e.writers) or names(e.perhaps)
        mend = f"see why {source} does not send it" if source else "nobody publishes it: start the service that does"
        return Grade.RED, f"{since}, and {names(e.needed_by)} waits for it: {mend}"
    if not ages or not e.writers:
        return None
    if e.age is None or (e.topic is not None and e.topic.qos in AT_WILL):
        return Grade.QUIET, f"{since}, though {names(e.writers)} may publish it"
    return Grade.AMBER, f"{since}, due every {1.0 / e.nominal:.2g} s: see what {names(e.writers)} does"


def _slowness(e: TopicEvidence) -> tuple[Grade, str] | None:
    if e.traffic is None or e.listened < WARM_UP or e.t - e.traffic.since < OVER or e.nominal < BARELY:
        return None
    if e.topic is None or (e.topic.qos in AT_WILL and not e.needed_by) or e.rate >= SLOW * e.nominal:
        return None
    if e.age is not None and e.age > max(PAUSE_PERIODS / e.nominal, PAUSE):
        return Grade.QUIET, f"silent for {e.age:.1f} s"
    who = names(e.writers) or "its writer"
    return Grade.AMBER, f"slow: {e.rate:.1f} of {e.nominal:.3g} messages a second; {who} does not keep up: see its CPU % and late % below"


def _remark(e: TopicEvidence) -> tuple[Grade, str]:
    if e.is_silent and e.pace <= 0.0 and e.topic is not None and e.topic.hz > 0:
        return Grade.QUIET, "simulation time stands still"
    if e.age is None and not e.writers:
        return Grade.QUIET, "read, but nobody publishes it; none of its readers needs it"
    if not e.readers:
        return Grade.QUIET, "nobody reads it"
    return Grade.FINE, ""
