"""Why a vehicle does not get to its goal, and what is tried against it: typed causes, and the recoveries of move_base in their order."""

from dataclasses import dataclass
from enum import Enum


class Failure(Enum):
    """Cause, as Nav2's error codes tell them apart; the value is for people."""

    NONE = ""
    NO_MAP = "there is no map to plan on yet"
    START_OCCUPIED = "the vehicle stands in an obstacle of its map"
    START_OUTSIDE_MAP = "the vehicle is outside its map: its pose or the map is wrong"
    GOAL_OCCUPIED = "the goal lies in an obstacle"
    GOAL_OUTSIDE_MAP = "the goal lies outside the map"
    GOAL_TOO_FAR = "the goal is too far to plan"
    NO_VALID_PATH = "no way leads to the goal"
    NO_VALID_CONTROL = "every velocity leads into an obstacle"
    BLOCKED = "an obstacle stands in the way and does not leave"
    FAILED_TO_MAKE_PROGRESS = "the vehicle does not move although it should"
    OSCILLATING = "the vehicle moves without getting nearer to the goal"
    TIMED_OUT = "the time for the goal is over"
    CANCELLED = "cancelled"


class Recovery(Enum):
    """What is tried, named as in move_base and Nav2; the value is for people."""

    CONSERVATIVE_RESET = "forgetting obstacles farther than 3 m"
    AGGRESSIVE_RESET = "forgetting all obstacles that are not near"
    CLEARING_ROTATION = "turning round to look"
    BACK_UP = "backing up"
    WAIT = "waiting"


@dataclass(frozen=True)
class Attempt:
    """A recovery with how much of it: radius [m] kept by a reset, angle [rad], distance [m] or time [s]."""

    recovery: Recovery
    amount: float


def recoveries(failure: Failure, circumscribed_radius: float, turning_radius: float = 0.0) -> tuple[Attempt, ...]:
    """What to try against a failure, in this order, before the goal is given up; ``circumscribed_radius`` [m] of the footprint.

    turning_radius [m]: of the tightest circle; who cannot turn on the spot backs up instead.

    The order is move_base's: conservative reset, clearing rotation, aggressive reset, clearing rotation; then backing up and waiting. What
    cannot help is left out: no rotation against a goal in an obstacle, no reset where something moves in the way.
    """
    conservative, aggressive = Attempt(Recovery.CONSERVATIVE_RESET, 3.0), Attempt(Recovery.AGGRESSIVE_RESET, 4.0 * circumscribed_radius)
    back_up = Attempt(Recovery.BACK_UP, max(0.3, turning_radius))
    rotation = Attempt(Recovery.CLEARING_ROTATION, 6.28) if turning_radius == 0.0 else back_up
    wait, long_wait = Attempt(Recovery.WAIT, 4.0), Attempt(Recovery.WAIT, 8.0)
    by_failure = {
        Failure.START_OCCUPIED: (aggressive, back_up, rotation),
        Failure.GOAL_OCCUPIED: (conservative, long_wait),
        Failure.NO_VALID_PATH: (conservative, rotation, aggressive, rotation, wait),
        Failure.NO_VALID_CONTROL: (conservative, back_up, rotation, aggressive, back_up, wait),
        Failure.BLOCKED: (long_wait, conservative, rotation, long_wait, aggressive, wait),
        Failure.FAILED_TO_MAKE_PROGRESS: (conservative, rotation, aggressive, back_up, wait),
        Failure.OSCILLATING: (conservative, rotation, aggressive, back_up),
    }
    return by_failure.get(failure, ())
