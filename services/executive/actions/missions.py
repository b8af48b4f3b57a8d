"""What a vehicle does by itself once it is told to: the mission of its job, and exploring."""

from schemas.messages import MissionProgress
from services.executive.actions.action import EngagedAction, Failed
from services.executive.situation import TeamSituation

SETTLED = 3.0  # s for which nothing is left to explore, before it is believed: the map still grows
WHOLE = 0.999


class MissionAction(EngagedAction):
    """The mission of the vehicle's job, to its last item."""

    def _carry_out(self, now: TeamSituation) -> bool:
        progress = now.now.progress.get(self.vehicle)
        if progress is None:
            self.reason = f"nothing is heard of {self.vehicle}'s mission"
            return False
        if progress.state == MissionProgress.NO_MISSION:
            raise Failed(f"{self.vehicle} has no mission: give its job one")
        self.reason = f"item {progress.current} of {progress.total}"
        return progress.state == MissionProgress.COMPLETE


class ExploreAction(EngagedAction):
    """Exploring, until every place is known."""

    def __init__(self, vehicle: str) -> None:
        super().__init__(vehicle)
        self._since: float | None = None

    def begin(self, now: TeamSituation) -> None:
        """Begins with arming the vehicle."""
        super().begin(now)
        self._since = None

    def _carry_out(self, now: TeamSituation) -> bool:
        status = now.now.nav.get(self.vehicle)
        if status is None:
            return False
        self.reason = f"{100 * status.explored:.0f} % explored"
        finished = status.job == "explore" and status.explored >= WHOLE
        self._since = (self._since if self._since is not None else now.t) if finished else None
        return self._since is not None and now.t - self._since >= SETTLED
