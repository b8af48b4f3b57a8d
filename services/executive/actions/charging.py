"""Batteries that are charged: one vehicle at each charger, the others wait for their turn."""

from collections.abc import Sequence
from math import dist

from schemas.messages import Mode
from services.executive.actions.action import ChangeModeAction, Failed
from services.executive.actions.driving import GoalAction
from services.executive.situation import TeamSituation
from uvf.models.mission.fixtures import ChargerFile
from uvf.models.mission.tasks import ChargeTask

RISES_WITHIN = 20.0  # s after which the charge of who stands on a charger must have risen
RISE = 1e-4
"""Of the full pack: a rise."""


class Chargers:
    """Who has which charger."""

    def __init__(self, chargers: Sequence[ChargerFile]) -> None:
        self._chargers = chargers
        self._held: dict[str, ChargerFile] = {}

    def take(self, vehicle: str, here: tuple[float, float]) -> ChargerFile | None:
        """The nearest free charger, which is the vehicle's from now on; None while all are taken."""
        free = [charger for charger in self._chargers if charger not in self._held.values()]
        if not free:
            return None
        self._held[vehicle] = min(free, key=lambda charger: dist((charger.x, charger.y), here))
        return self._held[vehicle]

    def leave(self, vehicle: str) -> None:
        """The vehicle needs none any more."""
        self._held.pop(vehicle, None)


class ChargeAction:
    """A ground vehicle drives to a charger when its battery is low, and stands there until it is charged."""

    def __init__(self, vehicle: str, wanted: ChargeTask, chargers: Chargers) -> None:
        self.vehicle = vehicle
        self.reason = ""
        self._wanted, self._chargers = wanted, chargers
        self._goal: GoalAction | None = None
        self._hold: ChangeModeAction | None = None
        self._best = 0.0
        self._risen_at = 0.0

    def begin(self, now: TeamSituation) -> None:
        """Begins with looking at the charge."""
        self.reason, self._goal, self._hold = "", None, None

    def step(self, now: TeamSituation) -> bool:
        """Whether it is charged. Raises Failed where the charger cannot be reached, or does not charge."""
        status, place = now.now.status.get(self.vehicle), now.place(self.vehicle)
        if status is None or place is None:
            self.reason = f"nothing is heard of {self.vehicle}"
            return False
        if self._hold is not None:
            return self._charge(now, status.battery_remaining)
        if self._goal is not None:
            self._drive(now, self._goal)
            return False
        if not 0.0 <= status.battery_remaining < self._wanted.below:  # below 0: it has none
            return True
        charger = self._chargers.take(self.vehicle, place[:2])
        if charger is None:
            self.reason = f"{self.vehicle} waits for a charger"
            return False
        self._goal = GoalAction(self.vehicle, (charger.x, charger.y), None)
        self._goal.begin(now)
        return False

    def stop(self, now: TeamSituation) -> None:
        """Lets the charger go."""
        self._chargers.leave(self.vehicle)
        for part in (self._goal, self._hold):
            if part is not None:
                part.stop(now)

    def _drive(self, now: TeamSituation, goal: GoalAction) -> None:
        there = goal.step(now)
        self.reason = f"{self.vehicle} drives to a charger: {goal.reason}"
        if there:
            self._hold = ChangeModeAction(self.vehicle, Mode.MODE_HOLD)
            self._hold.begin(now)
            self._best, self._risen_at = 0.0, now.t

    def _charge(self, now: TeamSituation, charge: float) -> bool:
        assert self._hold is not None
        self._hold.step(now)
        self.reason = f"{self.vehicle} is charged: {100 * charge:.0f} %"
        if charge >= self._wanted.up_to:
            self._chargers.leave(self.vehicle)
            return True
        if charge > self._best + RISE:
            self._best, self._risen_at = charge, now.t
        if now.t - self._risen_at > RISES_WITHIN:
            raise Failed(f"{self.vehicle} is at a charger, but its charge does not rise above {100 * charge:.0f} %")
        return False
