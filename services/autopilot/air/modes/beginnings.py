"""THE TABLE of how the modes begin: which part flies each of them, made from what is known when it begins."""

from collections.abc import Callable
from dataclasses import dataclass

from services.autopilot.air.mode_table import FlightMode
from services.autopilot.air.modes.field import Airfield
from services.autopilot.air.modes.follower import FollowMode, FormationLink
from services.autopilot.air.modes.mission_flight import MissionMode
from services.autopilot.air.modes.offboard import OffboardMode
from services.autopilot.air.modes.paths import OWN, OrbitMode
from services.autopilot.air.modes.return_mode import ReturnMode, lowest_over
from services.autopilot.air.modes.stick_modes import STICK_MODES
from services.autopilot.air.setpoints import FlightContext, FlightPhase
from uvf.estimation.state import Estimate
from uvf.guidance.plan_follower import PlanFollower
from uvf.guidance.route import Circle, Place
from uvf.models.vehicle.flight_params import AirParams


@dataclass(frozen=True)
class ModeContext:
    """What a mode may begin with."""

    now: Estimate
    params: AirParams
    home: Place
    navigator: PlanFollower
    field: Airfield
    context: FlightContext
    height: float
    """m, that has been held."""
    climb_to: float | None
    """m, world; of a take-off that was asked for with a height."""
    return_point: Place | None
    rally: tuple[Place, ...]
    formation: FormationLink | None


def begin(mode: FlightMode, known: ModeContext) -> FlightPhase:
    """The mode from its beginning; one that cannot begin, or needs no more, circles."""
    row = BEGINNINGS.get(mode)
    phase = row(known) if row is not None else None
    return phase or OrbitMode(Circle.ahead(known.now, max(known.height, known.params.min_altitude), known.params.hold_radius), OWN)


def _mission(k: ModeContext) -> FlightPhase:
    return MissionMode(k.navigator, k.field, k.home, k.context)


def _takeoff(k: ModeContext) -> FlightPhase:
    usual = k.home.height + k.params.takeoff_alt
    return k.field.take_off(k.now, usual if k.climb_to is None else k.climb_to, k.context)


def _land(k: ModeContext) -> FlightPhase:
    return k.field.landing(k.now, k.home, k.context, k.params)


def _follow(k: ModeContext) -> FlightPhase | None:
    return FollowMode(k.formation) if k.formation is not None else None


def _offboard(k: ModeContext) -> FlightPhase:
    return OffboardMode(k.context)


def _return(k: ModeContext) -> FlightPhase | None:
    to = k.return_point
    return ReturnMode(to, lowest_over(to, k.rally), k.home.height, k.height) if to is not None else None


def _manual(mode: FlightMode) -> Callable[[ModeContext], FlightPhase | None]:
    return lambda k: STICK_MODES[mode](k.context) if k.context.hand is not None else None


BEGINNINGS: dict[FlightMode, Callable[[ModeContext], FlightPhase | None]] = {
    FlightMode.MISSION: _mission,
    FlightMode.TAKEOFF: _takeoff,
    FlightMode.LAND: _land,
    FlightMode.FOLLOW: _follow,
    FlightMode.OFFBOARD: _offboard,
    FlightMode.RETURN: _return,
    **{mode: _manual(mode) for mode in STICK_MODES},
}
