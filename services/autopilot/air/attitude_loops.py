"""The inner level of control: bank and pitch to the surfaces.

Beard & McLain chapter 6 in its rate form: an outer loop asks for a body rate, a PI with feed-forward gives the surface.
Surface gains hold at the trim airspeed and are scaled with dynamic pressure.
"""

import math

from services.autopilot.air.commands import Attitude, Surfaces
from services.autopilot.air.cycle import FULL_BANK, Cycle, clip
from uvf.maths.filters import Integral
from uvf.maths.geodesy import GRAVITY

ROLL_RATE_LIMIT = 1.6  # rad/s
PITCH_RATE_LIMIT = 0.8  # rad/s
SURFACE_LIMIT = 0.5  # rad
TRIM_LIMIT = 0.2  # rad, of an integrator on a surface


class AttitudeLoops:
    """Roll, pitch and yaw with their integrators."""

    def __init__(self) -> None:
        self._roll = Integral(TRIM_LIMIT)
        self._pitch = Integral(TRIM_LIMIT)
        self._slip = Integral(TRIM_LIMIT)

    def step(self, cycle: Cycle, wanted: Attitude) -> Surfaces:
        params = cycle.params
        aileron = self._aileron(cycle, clip(wanted.bank, params.bank_limit))
        elevator = self._elevator(cycle, clip(wanted.pitch, params.pitch_limit))
        return Surfaces(aileron, elevator, self._rudder(cycle, wanted.rudder), min(max(wanted.throttle, 0.0), 1.0))

    def _aileron(self, cycle: Cycle, bank: float) -> float:
        now, params = cycle.now, cycle.params
        rate = clip((bank - now.roll) / params.roll_time, ROLL_RATE_LIMIT)
        error = rate - now.p
        trim = self._roll.step(params.roll_i * error, cycle.dt)
        return clip(math.sqrt(cycle.scale) * params.roll_ff * rate + cycle.scale * (params.roll_p * error + trim), SURFACE_LIMIT)

    def _elevator(self, cycle: Cycle, pitch: float) -> float:
        now, params = cycle.now, cycle.params
        bank = clip(now.roll, FULL_BANK)
        turning = GRAVITY / cycle.speed * math.sin(bank) * math.tan(bank)  # q of a level coordinated turn
        rate = clip((pitch - now.pitch) / params.pitch_time * math.cos(bank), PITCH_RATE_LIMIT) + turning
        error = rate - now.q
        trim = self._pitch.step(params.pitch_i * error, cycle.dt)
        balance = params.elev_zero_alpha + params.elev_per_alpha * cycle.alpha
        moving = math.sqrt(cycle.scale) * params.pitch_ff * rate + cycle.scale * (params.pitch_p * error + trim)
        return clip(balance - moving, SURFACE_LIMIT)

    def _rudder(self, cycle: Cycle, given: float | None) -> float:
        """Damps yaw against the rate of a coordinated turn; takes out the side force slowly, unless a rudder is given."""
        now, params = cycle.now, cycle.params
        turning = GRAVITY / cycle.speed * math.sin(now.roll) * math.cos(now.pitch)
        damping = cycle.scale * params.yaw_damping * (now.r - turning)
        if given is None:
            given = cycle.scale * self._slip.step(params.slip_i * now.side_force, cycle.dt)
        return clip(damping + given, SURFACE_LIMIT)
