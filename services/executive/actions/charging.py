"""Batteries that are charged: one vehicle at each charger, the others wait for their turn."""

from collections.abc import Sequence
from math import dist

from schemas.messages import Mode
from services.executive.actions.action import ChangeModeAction, Failed, first_refusal
from services.executive.actions.driving import GoalAction
from services.executive.situation import TeamSituation
from uvf.models.mission.fixtures import ChargerFile
from uvf.models.mission.tasks import ChargeTask

Point = tuple[float, float]

ROOM = 0.4  # m about a charger, within which somebody stands in the way
RISES_WITHIN = 20.0  # s after which the charge of who stands on a charger must have risen
RISE = 1e-4
"""Of the full pack: a rise."""


class Chargers:
    """Who has which charger."""

    def __init__(self, chargers: Sequence[ChargerFile]) -> None:
        self._chargers = chargers
        self._held: dict[str, ChargerFile] = {}

    def take(self, vehicle: str, here: Point, others: Sequence[Point]) -> ChargerFile | None:
        """The nearest free charger, which is the vehicle's from now on; None while all are taken, or others stand on them."""
        free = [
            charger
            for charger in self._chargers
            if charger not in self._held.values() and all(dist((charger.x, charger.y), other) > charger.radius + ROOM for other in others)
        ]
        if not free:
            return None
        self._held[vehicle] = min(free, key=lambda charger: dist((charger.x, charger.y), here))
        return self._held[vehicle]

    def resume(self, vehicle: str, here: Point) -> bool:
        """Whether the vehicle stands on a charger that nobody has; it is the vehicle's from now on."""
        on = next((c for c in self._chargers if dist((c.x, c.y), here) <= c.radius and c not in self._held.values()), None)
        if on is not None:
            self._held[vehicle] = on
        return on is not None

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
        self._pause: ChangeModeAction | None = None
        self._best = 0.0
        self._risen_at = 0.0

    def begin(self, now: TeamSituation) -> None:
        """Begins with looking at the charge."""
        self.reason, self._goal, self._hold, self._pause = "", None, None, None

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
        charge = status.battery_remaining
        if 0.0 <= charge < self._wanted.up_to and self._chargers.resume(self.vehicle, place[:2]):
            self._stand(now)  # it was being charged when this began anew
            return False
        if not 0.0 <= charge < self._wanted.below:  # below 0: it has none
            return True
        driving = [name for name in now.members if name != self.vehicle and not now.flies(name)]
        others = [at[:2] for name in driving if (at := now.place(name)) is not None]
        charger = self._chargers.take(self.vehicle, place[:2], others)
        if charger is None:
            self._wait(now)
            return False
        self._goal = GoalAction(self.vehicle, (charger.x, charger.y), None)
        self._goal.begin(now)
        return False

    @property
    def refusal(self) -> str:
        """Why it does not drive to a charger, or stand there."""
        return first_refusal(part for part in (self._goal, self._hold, self._pause) if part is not None)

    def stop(self, now: TeamSituation) -> None:
        """Lets the charger go."""
        self._chargers.leave(self.vehicle)
        for part in (self._goal, self._hold, self._pause):
            if part is not None:
                part.stop(now)

    def _drive(self, now: TeamSituation, goal: GoalAction) -> None:
        there = goal.step(now)
        self.reason = f"{self.vehicle} drives to a charger: {goal.reason}"
        if there:
            self._stand(now)

    def _stand(self, now: TeamSituation) -> None:
        self._hold = self._holding(now)
        self._best, self._risen_at = 0.0, now.t

    def _wait(self, now: TeamSituation) -> None:
        """With a low battery it stands until there is a charger."""
        self.reason = f"{self.vehicle} waits for a charger that is free"
        if self._pause is None:
            self._pause = self._holding(now)
        self._pause.step(now)

    def _holding(self, now: TeamSituation) -> ChangeModeAction:
        action = ChangeModeAction(self.vehicle, Mode.MODE_HOLD)
        action.begin(now)
        return action

    def _charge(self, now: TeamSituation, charge: float) -> bool:
        assert self._hold is not None
        self._hold.step(now)
        self.reason = f"{self.vehicle} is being charged: {100 * charge:.0f} %"
        if charge >= self._wanted.up_to:
            self._chargers.leave(self.vehicle)
            return True
        if charge > self._best + RISE:
            self._best, self._risen_at = charge, now.t
        if now.t - self._risen_at > RISES_WITHIN:
            raise Failed(f"{self.vehicle} is at a charger, but its charge does not rise above {100 * charge:.0f} %")
        return False
