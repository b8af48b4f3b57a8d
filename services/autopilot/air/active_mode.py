"""The mode in force, the phase that flies it, and what the rest of the autopilot may ask of both."""

from services.autopilot.air.manual_control import ManualControlState
from services.autopilot.air.mode_table import TABLE, FlightMode, Situation, refusal
from services.autopilot.air.modes.airspeed import SpeedOverride
from services.autopilot.air.modes.descent import DescendMode
from services.autopilot.air.modes.follower import FollowMode, FormationLink
from services.autopilot.air.modes.landing import LandingMode
from services.autopilot.air.modes.mission_flight import MissionMode
from services.autopilot.air.modes.paths import OrbitMode
from services.autopilot.air.modes.takeoff import TakeoffMode
from services.autopilot.air.setpoints import FlightContext, FlightPhase
from uvf.estimation.state import Estimate
from uvf.guidance.camera_trigger import CameraTrigger
from uvf.guidance.plan_follower import PlanFollower
from uvf.guidance.route import Circle, Place

ROLLS_OUT = "the aircraft is rolling out after its landing"


class ActiveMode:
    """Reading it changes nothing; ``ModeManager`` is the one that changes it."""

    def __init__(self, mode: FlightMode, navigator: PlanFollower) -> None:
        self.mode = mode
        self.reason = "start"
        self.stopped = ""
        """Who has stopped the aircraft."""
        self.navigator = navigator
        self.home: Place | None = None
        self.rally: tuple[Place, ...] = ()
        """Where Return may lead beside home."""
        self.shutter = CameraTrigger()
        """Triggered by orders; the mission's is the navigator's."""
        self.context = FlightContext()
        self.formation: FormationLink | None = None
        self.has_wheels = True
        """It takes off and lands by itself."""
        self.speed_override = SpeedOverride()
        self._blind = False
        self._climb_to: float | None = None  # m, world; of a take-off that was asked for with a height
        self._stick = ManualControlState()
        self._phase: FlightPhase | None = None

    @property
    def circling(self) -> OrbitMode | None:
        """The circle that is flown until something else is asked for (Hold, Orbit, Return), if one is."""
        return self._phase if isinstance(self._phase, OrbitMode) else None

    @property
    def circle(self) -> Circle | None:
        """The circle that is flown, before a landing too."""
        return self._phase.circle if isinstance(self._phase, OrbitMode | LandingMode | DescendMode) else None

    @property
    def landing(self) -> LandingMode | None:
        """The landing that is being flown."""
        return self._part if isinstance(self._part, LandingMode) else None

    @property
    def _part(self) -> FlightPhase | None:
        return self._phase.part if isinstance(self._phase, MissionMode) else self._phase

    @property
    def is_blind(self) -> bool:
        """Modes that need a position are not flown."""
        return self._blind

    @property
    def is_manual(self) -> bool:
        """It is flown by hand, and a hand is there."""
        return TABLE[self.mode].is_manual and self.context.hand is not None

    @property
    def is_manual_control_lost(self) -> bool:
        """In a mode that is flown by hand nobody does any more."""
        return TABLE[self.mode].is_manual and self._stick.abandoned

    @property
    def goes_down(self) -> bool:
        """It lands, with a position or without one."""
        return self.landing is not None or isinstance(self._phase, DescendMode)

    def is_committed(self, now: Estimate) -> bool:
        """So near to the ground that no other mode should follow: at the begin of a take-off, on the last metres of a landing."""
        return self._settles or (isinstance(self._part, TakeoffMode) and self._part.is_low(now))

    @property
    def _settles(self) -> bool:
        return self.landing is not None and self.landing.committed

    @property
    def station(self) -> float | None:
        """Distance [m] of the aircraft from its slot behind a leader; None in other modes."""
        return self._phase.distance if isinstance(self._phase, FollowMode) else None

    @property
    def source(self) -> str:
        """Whose commands reach the surfaces, or whose setpoints are followed."""
        if TABLE[self.mode].is_manual and self.context.hand is not None:
            return self.context.hand.source
        return (self.mode is FlightMode.OFFBOARD and self.context.setpoint_from) or "autopilot"

    @property
    def _situation(self) -> Situation:
        led = self.formation is not None and self.formation.is_led
        return Situation(
            airborne=self.context.airborne,
            position_known=not self._blind,
            has_mission=bool(self.navigator.items),
            setpoint=self.context.setpoint is not None,
            stopped=self.stopped,
            led=led,
            wheels=self.has_wheels,
        )

    @property
    def _stands(self) -> bool:
        """On the ground with nothing to do: surfaces neutral, motor off, brakes on."""
        moves = TABLE[self.mode].on_ground and (self.context.hand is not None if TABLE[self.mode].is_manual else self.context.armed)
        return not self.context.airborne and not moves and not self.rolls_out

    @property
    def blocked(self) -> str:
        """Why it cannot be sent anywhere; empty if it can."""
        return refusal(FlightMode.ORBIT, self._situation)

    @property
    def rolls_out(self) -> bool:
        """Its wheels carry it after a landing."""
        descends = isinstance(self._phase, DescendMode) and self._phase.rolls
        return descends or (self.landing is not None and self.landing.rolls)

    def _change(self, mode: FlightMode, reason: str) -> None:
        self.speed_override.begin(anew=mode is not self.mode)
        self.mode, self.reason, self._phase, self._climb_to = mode, reason, None, None
        self._stick.take()

    def _refused(self, mode: FlightMode) -> str:
        return refusal(mode, self._situation) or (ROLLS_OUT if self.rolls_out else "")
