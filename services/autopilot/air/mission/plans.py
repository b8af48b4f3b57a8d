"""Mission, fence and rally points in force: replaced on request, told of when they have changed."""

from schemas.messages import Fence, Mission, MissionItem, RallyPoints
from services.autopilot.air.failsafes.monitor import FailsafeMonitor, VehicleCondition
from services.autopilot.air.inputs import intake
from services.autopilot.air.interface import Outputs
from services.autopilot.air.mode_manager import ModeManager
from services.autopilot.air.modes import return_mode
from services.autopilot.air.status.event_log import EventLog
from uvf.guidance.fence_plan import mission_fault
from uvf.guidance.flyable import advice
from uvf.guidance.route import Place
from uvf.models.vehicle.flight_params import AirParams
from uvf.runtime.messages.convert import stamp
from uvf.runtime.messages.plans.plan_items import place_of, plan_items


class ActivePlans:
    """Requests give the reason of a refusal, empty when accepted."""

    def __init__(self, items: list[MissionItem], mode_manager: ModeManager, safety: FailsafeMonitor, journal: EventLog) -> None:
        self.mission = intake.with_id(items)
        self.rally = RallyPoints()
        self._mode_manager, self._safety, self._journal = mode_manager, safety, journal
        self._news = {"plan", "bounds", "rally"}
        """Outputs that are to be told."""

    def set_mission(self, mission: Mission, params: AirParams) -> str:
        """Replaces the mission."""
        try:
            items = plan_items(mission.items)
        except ValueError as error:
            return str(error)
        refusal = mission_fault(items, self._mode_manager.fence.fencing, params) or self._mode_manager.load(items, params)
        if not refusal:
            self.mission = intake.with_id(mission.items)
            self._journal.new_mission(advice(self._mode_manager.navigator.items, params))
            self._news.add("plan")
        return refusal

    def set_fence(self, fence: Fence, seen: VehicleCondition | None, params: AirParams) -> str:
        """Replaces the fence. seen: None before the first estimate."""
        refusal = self._safety.set_fence(fence, seen, params)
        if not refusal:
            self._news.add("bounds")
        return refusal

    def set_rally(self, rally: RallyPoints, params: AirParams) -> str:
        """Replaces the rally points."""
        places = [place_of(point) for point in rally.points]
        refusal = return_mode.fault(places, self._mode_manager.home or Place(0.0, 0.0, 0.0), self._mode_manager.fence.fencing, params)
        if not refusal:
            self.rally, self._mode_manager.rally = rally, tuple(places)
            self._news.add("rally")
        return refusal

    def tell(self, t: float, out: Outputs) -> None:
        """Puts what has changed since the last call into ``out``, stamped ``t`` [s]."""
        news, self._news = self._news, set()
        if "plan" in news:
            self.mission.timestamp.CopyFrom(stamp(t))
            out.plan = self.mission
        if "bounds" in news:
            self._safety.fence.timestamp.CopyFrom(stamp(t))
            out.bounds = self._safety.fence
        if "rally" in news:
            self.rally.timestamp.CopyFrom(stamp(t))
            out.rally = self.rally
