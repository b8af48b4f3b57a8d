"""The inner level of control: bank and pitch to the surfaces.

Beard & McLain chapter 6 in its rate form: an outer loop asks for a body rate, a PI with feed-forward gives the surface.
Surface gains hold at the trim airspeed and are scaled with dynamic pressure.
"""

import math

from uvf.control.commands import AttitudeSetpoint, Surfaces
from uvf.control.cycle import FULL_BANK, Cycle, clip
from uvf.control.servos import Servos, SurfaceTrim
from uvf.maths.geodesy import GRAVITY

ROLL_RATE_LIMIT = 1.6  # rad/s
PITCH_RATE_LIMIT = 0.8  # rad/s


class PitchLoop:
    """Pitch to the elevator, with its integrator."""

    def __init__(self, servos: Servos) -> None:
        self._trim = SurfaceTrim(servos.elevator)

    def step(self, cycle: Cycle, asked: float) -> float:
        """Elevator [rad] for a pitch asked for [rad], which is limited first."""
        now, params = cycle.now, cycle.params
        pitch = max(min(asked, cycle.highest_pitch), -params.pitch_limit)
        bank = clip(now.roll, FULL_BANK)
        turning = GRAVITY / cycle.speed * math.sin(bank) * math.tan(bank)  # q of a level coordinated turn
        wanted = (pitch - now.pitch) / params.pitch_time * math.cos(bank)
        carried = min(cycle.load, now.lift / GRAVITY)  # lift that is lost, as the airspeed falls, is to be won back
        rate = max(min(wanted, _pull(cycle, cycle.load_limit - carried)), -_pull(cycle, params.load_max - 1)) + turning
        error = rate - now.q
        balance = params.elev_zero_alpha + params.elev_per_alpha * cycle.alpha
        moving = math.sqrt(cycle.scale) * params.pitch_ff * rate + cycle.scale * params.pitch_p * error
        return self._trim.step(balance - moving, -cycle.scale, params.pitch_i * error, cycle.dt)


class AttitudeLoops:
    """Roll, pitch and yaw loops from an attitude setpoint to surface deflections, with their integrators."""

    def __init__(self, servos: Servos) -> None:
        self._servos = servos
        self._roll = SurfaceTrim(servos.aileron)
        self._pitch = PitchLoop(servos)
        self._slip = SurfaceTrim(servos.rudder)

    def step(self, cycle: Cycle, wanted: AttitudeSetpoint) -> Surfaces:
        """Surface deflections [rad] and throttle [0..1] for one cycle; bank, pitch and throttle asked for are limited first."""
        aileron = self._aileron(cycle, clip(wanted.bank, cycle.bank_limit))
        elevator = self._pitch.step(cycle, wanted.pitch)
        return Surfaces(aileron, elevator, self._rudder(cycle, aileron, wanted.rudder), min(max(wanted.throttle, 0.0), 1.0))

    def _aileron(self, cycle: Cycle, bank: float) -> float:
        now, params = cycle.now, cycle.params
        rate = clip((bank - now.roll) / params.roll_time, ROLL_RATE_LIMIT)
        error = rate - now.p
        moving = math.sqrt(cycle.scale) * params.roll_ff * rate + cycle.scale * params.roll_p * error
        return self._roll.step(moving, cycle.scale, params.roll_i * error, cycle.dt)

    def _rudder(self, cycle: Cycle, aileron: float, given: float | None) -> float:
        """Holds the rate of a coordinated turn, damps what differs from it, and goes with the aileron against its adverse yaw.

        Takes out the side force slowly, unless a rudder is given.
        """
        now, params = cycle.now, cycle.params
        turning = GRAVITY / cycle.speed * math.sin(now.roll) * math.cos(now.pitch)
        damping = cycle.scale * params.yaw_damping * (now.r - turning)
        if given is not None:
            return clip(damping + given, self._servos.rudder.limit)
        ahead = math.sqrt(cycle.scale) * params.rudder_ff * turning + params.rudder_mix * aileron
        return self._slip.step(damping + ahead, cycle.scale, params.slip_i * now.side_force, cycle.dt)


def _pull(cycle: Cycle, load: float) -> float:
    """rad/s of pitch that so much of load factor allows."""
    return min(max(load, 0.0) * GRAVITY / cycle.speed, PITCH_RATE_LIMIT)
