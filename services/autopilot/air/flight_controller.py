"""Carries out what a mode wants: steering along paths and both levels of control, with what they have learnt."""

from dataclasses import replace

import msgspec

from services.autopilot.air.fence_guard import FenceGuard, kept
from services.autopilot.air.setpoints import PathSetpoint, Setpoint
from uvf.control.commands import AltitudeAirspeedSetpoint, AttitudeSetpoint, Surfaces
from uvf.control.cycle import Cycle, clip
from uvf.control.flight_control import FlightControl, on_final
from uvf.control.servos import Servos
from uvf.estimation.state import Estimate
from uvf.guidance.vector_field import LateralGuidance
from uvf.models.vehicle.flight_params import AirParams

FLAP_RATE = 0.1  # rad/s, slow enough for the loops to follow


class FlightController:
    """Holds on to its integrators from mode to mode."""

    def __init__(self, servos: Servos, fence: FenceGuard | None = None) -> None:
        self._fence = fence or FenceGuard()
        self._servos = servos
        self._control = FlightControl(servos)
        self._steering = LateralGuidance()
        self._flap = 0.0
        self.attitude: AttitudeSetpoint | None = None
        """That is held; None while the surfaces are moved by hand."""
        self.airspeed: float | None = None
        """m/s, that is held; None while an attitude or surfaces are asked for."""

    def step(self, now: Estimate, wish: Setpoint, params: AirParams, dt: float) -> Surfaces:
        """Surfaces [rad; throttle and brake 0 to 1] that carry out ``wish`` in this cycle of ``dt`` [s]."""
        asked = wish.asked
        self.attitude = self.airspeed = None
        if isinstance(asked, Surfaces):
            self._flap = asked.flap
            return asked
        if wish.firm:
            params = on_final(params)
        self._flap += min(max(wish.flap - self._flap, -FLAP_RATE * dt), FLAP_RATE * dt)
        flap = self._lifting(wish.lift, now, params, dt)
        if self._flap > 0:
            params = msgspec.structs.replace(params, alpha_zero_lift=params.alpha_zero_lift - params.flap_alpha * self._flap)
        surfaces = self._fly(now, asked, params, dt)
        self.attitude = self._control.held
        self.airspeed = None if isinstance(asked, AttitudeSetpoint) else asked.airspeed
        return replace(surfaces, flap=flap, brake=wish.brake)

    def _lifting(self, lift: float, now: Estimate, params: AirParams, dt: float) -> float:
        """rad of flap that makes so much lift [m/s^2] beside what it makes already."""
        if params.flap_alpha == 0 or lift == 0:
            return self._flap
        moved = lift * params.alpha_per_load / (params.flap_alpha * Cycle(now, params, dt).eas ** 2)
        return min(max(self._flap + moved, 0.0), max(self._servos.flap.limit, self._flap))

    def _fly(
        self, now: Estimate, asked: PathSetpoint | AltitudeAirspeedSetpoint | AttitudeSetpoint, params: AirParams, dt: float
    ) -> Surfaces:
        if isinstance(asked, AttitudeSetpoint):
            return self._control.hold(now, asked, params, dt)
        if isinstance(asked, PathSetpoint):
            bank = self._steering.bank(asked.aim, now, params, dt)
            bank = bank if asked.bank_limit is None else clip(bank, asked.bank_limit)
            asked = AltitudeAirspeedSetpoint(
                bank, asked.height, asked.climb, asked.airspeed, asked.throttle, asked.rudder, asked.lowest_pitch
            )
        asked = kept(asked, self._fence, now, params)
        if asked.height is not None and not now.height_known:
            asked = replace(asked, height=now.height)
        return self._control.step(now, asked, params, dt)
