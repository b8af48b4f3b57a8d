"""Mode Mission: take-off, legs and circles, landing, one item after the other."""

from services.autopilot.air.mode_table import FlightMode
from services.autopilot.air.modes.field import Airfield
from services.autopilot.air.modes.paths import PathMode
from services.autopilot.air.setpoints import FlightContext, FlightPhase, Setpoint
from uvf.estimation.state import Estimate
from uvf.guidance.flight_plan import OFF_PATH, ItemKind
from uvf.guidance.plan_follower import PlanFollower
from uvf.guidance.route import Place
from uvf.models.vehicle.flight_params import AirParams


class MissionMode(FlightPhase):
    """From the ground a take-off comes first, whether the mission has one or not."""

    def __init__(self, navigator: PlanFollower, field: Airfield, home: Place, context: FlightContext) -> None:
        self.becomes: FlightMode | None = None
        self.part: FlightPhase | None = None
        self._navigator, self._field, self._home, self._senses = navigator, field, home, context
        self._starts = not context.airborne
        self._index: int | None = None

    def step(self, now: Estimate, params: AirParams, dt: float) -> Setpoint:
        """Setpoint of the part that is flown in this cycle of ``dt`` [s]; ``look`` comes first."""
        assert self.part is not None
        return self.part.step(now, params, dt)

    def look(self, now: Estimate, params: AirParams) -> None:
        """Which part is flown; ``ended`` when there is none left."""
        if self.part is not None and self.part.ended:
            self._leave(self.part, now, params)
        elif (self._kind in OFF_PATH) if isinstance(self.part, PathMode) else self._navigator.index != self._index:
            self.part = None
        if self.ended:
            return
        if self._navigator.returns_home:
            self.ended, self.becomes = "mission: return", FlightMode.RETURN
        elif self._navigator.finished:
            self.ended = "mission complete"
        else:
            self.part, self._index = self.part or self._begun(now, params), self._navigator.index

    def _leave(self, part: FlightPhase, now: Estimate, params: AirParams) -> None:
        self.part = None
        if part.disarms and self._kind is not ItemKind.LAND:
            self.ended, self.disarms = part.ended, True  # a take-off that was rejected
            return
        self._starts = False
        if self._kind in (ItemKind.TAKEOFF, ItemKind.LAND):
            self._navigator.pass_item()
        if part.disarms:
            self.ended, self.disarms = "mission complete" if self._navigator.finished else part.ended, True

    @property
    def _kind(self) -> ItemKind | None:
        target = self._navigator.target
        return target.kind if target is not None else None

    def _begun(self, now: Estimate, params: AirParams) -> FlightPhase:
        target = self._navigator.target
        lowest = self._home.height + params.takeoff_alt
        if target is not None and target.kind is ItemKind.TAKEOFF:
            return self._field.take_off(now, target.place.height or lowest, self._senses)
        if self._starts:
            return self._field.take_off(now, lowest, self._senses)
        if target is not None and target.kind is ItemKind.LAND:
            return self._field.landing_at(now, target.place, self._senses, params, self._navigator.approach(params))
        return PathMode(self._navigator)
