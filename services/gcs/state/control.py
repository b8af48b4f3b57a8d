"""Who controls which vehicle: one operator each, who hands it over when another one asks, or is taken for gone."""

from collections.abc import Set
from dataclasses import dataclass, field

ANSWER_WITHIN = 10.0  # s, wall: who does not answer a request gives control away


def called(operator: str) -> str:
    """What an operator is called in the log: the first letters of the browser's token."""
    return f"operator {operator[:4]}" if operator else "an unknown operator"


@dataclass
class ControlBook:
    """The controlling operator of each vehicle, and who asks for control. Operators are named by their tokens."""

    holders: dict[str, str] = field(default_factory=dict)
    asking: dict[str, tuple[str, float]] = field(default_factory=dict)
    """Vehicle -> (who asks, since when [s, wall])."""

    def reason_against(self, vehicle: str, operator: str, present: Set[str]) -> str:
        """Why the operator may not command the vehicle; "" if they may. present: operators whose pages are connected and alive."""
        holder = self.holders.get(vehicle, "")
        if not holder or holder == operator or holder not in present:
            return ""
        return f"{called(holder)} controls {vehicle}: ask for control first"

    def take(self, vehicle: str, operator: str) -> bool:
        """Gives control to the operator; returns whether it was anybody else's, or nobody's."""
        before = self.holders.get(vehicle)
        self.holders[vehicle] = operator
        if vehicle in self.asking and self.asking[vehicle][0] == operator:
            del self.asking[vehicle]
        return before != operator

    def ask(self, t: float, vehicle: str, operator: str) -> None:
        """Notes at ``t`` [s, wall] that the operator asks for control; who asks first is asked about first."""
        self.asking.setdefault(vehicle, (operator, t))

    def keep(self, vehicle: str) -> None:
        """The holder keeps control: the request is over."""
        self.asking.pop(vehicle, None)

    def due(self, t: float, present: Set[str]) -> list[tuple[str, str]]:
        """(vehicle, operator) of the requests that succeed at ``t`` [s, wall]: not answered in time, or the holder has gone.

        Requests of operators that have gone are dropped.
        """
        self.asking = {vehicle: asked for vehicle, asked in self.asking.items() if asked[0] in present}
        return [
            (vehicle, operator)
            for vehicle, (operator, since) in self.asking.items()
            if t - since >= ANSWER_WITHIN or self.holders.get(vehicle, "") not in present
        ]
