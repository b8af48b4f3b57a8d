"""Failsafes as rules: when something counts as wrong, when as mended, and what is done about it. Pure; for every kind of vehicle."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Generic, TypeVar

from schemas.messages import Event
from uvf.runtime.messages.convert import stamp

K = TypeVar("K")


class FailsafeAction(IntEnum):
    """What a failsafe does, ordered by increasing priority."""

    WARN = 0
    HOLD = 1
    RETURN = 2
    LAND = 3
    STAND = 4
    """Of a ground vehicle: it stands where it is, for whatever was ordered cannot be done."""
    OFF = 5
    """The same, disarmed."""


ACTIONS = {
    "wait": FailsafeAction.WARN,
    "warn": FailsafeAction.WARN,
    "hold": FailsafeAction.HOLD,
    "return": FailsafeAction.RETURN,
    "land": FailsafeAction.LAND,
}


@dataclass(frozen=True)
class FailsafeRule(Generic[K]):
    """One row of a failsafe table. Between ``trigger`` and ``clear`` there may be a gap (hysteresis): there the state is kept."""

    name: str
    trigger: Callable[[K], bool]
    clear: Callable[[K], bool]
    raised_text: str
    """What is said when it begins, and when it ends."""
    cleared_text: str
    detail: Callable[[K], str]
    """The numbers of the case, for the event's cause."""
    action: Callable[[K], FailsafeAction] = lambda known: FailsafeAction.WARN
    after: Callable[[K], float] = lambda known: 0.0
    """s that it has to be wrong without a break."""
    clear_delay: float = 0.0
    """s that it has to be mended without a break."""
    severity: Event.Severity = Event.WARNING
    parameters: tuple[str, ...] = ()
    does: str = ""
    """What else follows, for the table in the documentation."""


@dataclass(frozen=True)
class RuleChange(Generic[K]):
    """A failsafe rule that was raised or cleared in this cycle."""

    rule: FailsafeRule[K]
    began: bool
    cause: str

    def event(self, t: float) -> Event:
        """The event at ``t`` [s] that reports the change; its figures are those of the moment at which the rule was raised."""
        severity = self.rule.severity if self.began else Event.NOTICE
        text = self.rule.raised_text if self.began else self.rule.cleared_text
        return Event(timestamp=stamp(t), severity=severity, text=text, cause=self.cause if self.began else "", source="autopilot")


@dataclass(frozen=True)
class FailsafeOrder(Generic[K]):
    """The action to be taken now, and its cause."""

    action: FailsafeAction
    rule: FailsafeRule[K]


class FailsafeWatch(Generic[K]):
    """Keeps track of the rules that hold. An action is ordered once, when its rule is raised; modes requested later take precedence."""

    def __init__(self, rules: Sequence[FailsafeRule[K]]) -> None:
        self._rules = tuple(rules)
        self._time: dict[str, float] = {}
        """s that a rule that does not hold has been wrong, or one that holds mended."""
        self.holding: dict[str, FailsafeRule[K]] = {}
        self._in_charge = FailsafeAction.WARN
        self._overruled: set[str] = set()

    def overrule(self) -> None:
        """Notes that somebody has requested a mode: rules that already hold order nothing more."""
        self._in_charge = FailsafeAction.WARN
        self._overruled = set(self.holding)

    def in_force(self, known: K) -> FailsafeOrder[K] | None:
        """The last order whose rule still holds, unless somebody has overruled it."""
        held = [FailsafeOrder(rule.action(known), rule) for name, rule in self.holding.items() if name not in self._overruled]
        return max((order for order in held if order.action), key=lambda o: o.action, default=None)

    def step(self, known: K, dt: float) -> tuple[list[RuleChange[K]], FailsafeOrder[K] | None]:
        """One cycle of ``dt`` [s]: the rules that changed, and the resulting order if it goes beyond the one in force."""
        turns = [rule.clear(known) if rule.name in self.holding else rule.trigger(known) for rule in self._rules]
        changes = [
            change for rule, turn in zip(self._rules, turns, strict=True) if (change := self._look(rule, turn, known, dt)) is not None
        ]
        if not any(rule.action(known) for rule in self.holding.values()):
            self._in_charge = FailsafeAction.WARN
        begun = [FailsafeOrder(change.rule.action(known), change.rule) for change in changes if change.began]
        order = max(begun, key=lambda o: o.action, default=None)
        if order is None or order.action <= self._in_charge:
            return changes, None
        self._in_charge = order.action
        return changes, order

    def _look(self, rule: FailsafeRule[K], turns: bool, known: K, dt: float) -> RuleChange[K] | None:
        """turns: what would end a rule that holds, or begin one that does not, is there in this cycle."""
        holds = rule.name in self.holding
        self._time[rule.name] = self._time.get(rule.name, 0.0) + dt if turns else 0.0
        if not turns or self._time[rule.name] < (rule.clear_delay if holds else rule.after(known)):
            return None
        self._time[rule.name] = 0.0
        if holds:
            del self.holding[rule.name]
            self._overruled.discard(rule.name)
        else:
            self.holding[rule.name] = rule
        return RuleChange(rule, not holds, rule.detail(known))
