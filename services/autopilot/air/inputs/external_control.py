"""Who steers from outside: by hand, or by setpoints in mode Offboard; of each kind one sender at a time."""

from collections.abc import Mapping

from schemas.messages import FlightSetpoint, SurfaceCommand
from services.autopilot.air.active_mode import ActiveMode
from services.autopilot.air.manual_control import ManualSources
from services.autopilot.air.mode_table import FlightMode
from services.autopilot.air.modes.offboard import SetpointSources
from services.autopilot.air.setpoints import FlightContext, ManualCommand

Surfaces = Mapping[str, SurfaceCommand | None]
Wanted = Mapping[str, FlightSetpoint | None]


class ExternalControl:
    """What is asked by hand and by setpoints, and who is listened to."""

    def __init__(self) -> None:
        self._hands, self._setpoints = ManualSources(), SetpointSources()
        self._hand: ManualCommand | None = None
        self._setpoint: FlightSetpoint | None = None

    def hear(self, t: float, hands: Surfaces, setpoints: Wanted, stick_timeout: float) -> None:
        """By the sources of the keys; stick_timeout: how long a command by hand counts [s]."""
        self._hand = self._hands.choose(t, hands, stick_timeout)
        self._setpoint = self._setpoints.choose(t, setpoints)

    def tell(self, context: FlightContext) -> FlightContext:
        """The same, with what is asked now."""
        context.hand, context.setpoint = self._hand, self._setpoint
        context.setpoint_from, context.setpoints_wait = self._setpoints.holder, self._setpoints.waiting
        return context

    def followed(self, active: ActiveMode) -> str:
        """Whose setpoints are flown; "" in other modes than Offboard."""
        return self._setpoints.holder if active.mode is FlightMode.OFFBOARD else ""

    def news(self, t: float, active: ActiveMode) -> list[tuple[str, str]]:
        """Hand-overs at ``t`` [s], in the modes in which they matter: what and why."""
        if active.mode is FlightMode.OFFBOARD:
            return self._setpoints.news(t)
        return self._hands.news(t) if active.is_manual else []
