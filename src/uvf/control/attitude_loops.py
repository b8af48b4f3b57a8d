"""The inner level of control: bank and pitch to the surfaces.

Beard & McLain chapter 6 in its rate form: an outer loop asks for a body rate, a PI with feed-forward gives the surface.
Surface gains hold at the trim airspeed and are scaled with dynamic pressure.
"""

import math

from uvf.control.commands import AttitudeSetpoint, Surfaces
from uvf.control.cycle import FULL_BANK, LEAST, Cycle, clip
from uvf.control.servos import Servos, SurfaceTrim
from uvf.maths.geodesy import GRAVITY

ROLL_RATE_LIMIT = 1.6  # rad/s
PITCH_RATE_LIMIT = 0.8  # rad/s
STEEPEST_BANK = 1.05  # rad, up to which pitch answers as quickly as with level wings
UP_TIME = 1.0  # s, in which climb that is lacking is won back: before a turn, that gets its lift
TURN_SHARE, LEAST_BANK = (0.3, 0.95), 0.25  # of the elevator's way that a turn may take; rad that it may always be banked
LEARNT = 3.0  # s, over which it is learnt how much elevator is needed
GIVES, TAKES, AT_STOP = 0.12, 0.1, 0.98  # 1/s: that share falls while the elevator is at its stop, and rises again


class PitchLoop:
    """Pitch to the elevator, with its integrator."""

    def __init__(self, servos: Servos) -> None:
        self._trim, self._limit = SurfaceTrim(servos.elevator), -servos.elevator.lowest
        self._alpha: float | None = None
        self._beside = 0.0  # rad of elevator that level flight and turns take beside what the parameters say, as it has been lately
        self._share = TURN_SHARE[1]

    def bank_limit(self, cycle: Cycle) -> float:
        """Bank [rad] of the level turn that the elevator balances with a share of its way, by what it has learnt.

        From a + b n + c (n - 1 / n) = share, solved for the load factor n: what level flight takes, the angle of attack and the damping.
        """
        params = cycle.params
        level = params.elev_zero_alpha + params.elev_per_alpha * params.alpha_zero_lift + self._beside
        spare = self._share * self._limit + level
        by_load = -params.elev_per_alpha * params.alpha_per_load * GRAVITY / cycle.eas**2
        damping = math.sqrt(cycle.scale) * params.pitch_ff * GRAVITY / cycle.speed
        load = (spare + math.sqrt(spare**2 + 4 * (by_load + damping) * damping)) / (2 * max(by_load + damping, LEAST))
        return max(math.acos(min(1 / max(load, 1.0), 1.0)), LEAST_BANK)

    def step(self, cycle: Cycle, asked: float, rolling: float) -> float:
        """Elevator [rad] for a pitch asked for [rad], within limits that are held firmly, however gently pitch moves between them.

        rolling: roll rate that is asked for [rad/s].
        """
        now, params = cycle.now, cycle.params
        lowest, highest = ((limit - now.pitch) / params.final_pitch_time for limit in (-params.pitch_limit, cycle.highest_pitch))
        nose = max(min((asked - now.pitch) / params.pitch_time, highest), lowest)  # rad/s
        bank = clip(now.roll, FULL_BANK)
        turning = _turning(cycle, bank, rolling)
        upright = max(math.cos(bank), math.cos(STEEPEST_BANK))
        wanted = nose * math.cos(bank) / upright**2  # of q only cos(bank) raises the nose
        carried = min(cycle.load, now.lift / GRAVITY)  # lift that is lost, as the airspeed falls, is to be won back
        rate = max(min(wanted, _pull(cycle, cycle.load_limit - carried)), -_pull(cycle, params.load_max - 1)) + turning
        error = rate - now.q
        balance = params.elev_zero_alpha + params.elev_per_alpha * self._alpha_of(cycle, math.cos(bank) + cycle.speed * rate / GRAVITY)
        moving = math.sqrt(cycle.scale) * params.pitch_ff * rate + cycle.scale * params.pitch_p * error
        elevator = self._trim.step(balance - moving, -cycle.scale, params.pitch_i * error, cycle.dt)
        self._beside += (elevator - self._balancing(cycle) - self._beside) * min(cycle.dt / LEARNT, 1.0)
        spent = elevator < -AT_STOP * self._limit
        self._share = min(max(self._share + (-GIVES if spent else TAKES) * cycle.dt, TURN_SHARE[0]), TURN_SHARE[1])
        return elevator

    @staticmethod
    def _balancing(cycle: Cycle) -> float:
        """Elevator [rad] that balances lift and pitch rate of now, by the parameters."""
        params = cycle.params
        damped = math.sqrt(cycle.scale) * params.pitch_ff * cycle.now.q
        return params.elev_zero_alpha + params.elev_per_alpha * cycle.alpha_felt - damped

    def _alpha_of(self, cycle: Cycle, load: float) -> float:
        """Angle of attack [rad] of a load factor that is asked for, which comes as lift turns the path: V / L_alpha later."""
        asked = cycle.alpha_with(load)
        before = asked if self._alpha is None else self._alpha
        self._alpha = before + (asked - before) * min(cycle.dt / cycle.lift_time, 1.0)
        return self._alpha


class AttitudeLoops:
    """Roll, pitch and yaw loops from an attitude setpoint to surface deflections, with their integrators."""

    def __init__(self, servos: Servos) -> None:
        self._servos = servos
        self._roll = SurfaceTrim(servos.aileron)
        self._pitch = PitchLoop(servos)
        self._slip = SurfaceTrim(servos.rudder)
        self._steered = 0.0

    def step(self, cycle: Cycle, wanted: AttitudeSetpoint) -> Surfaces:
        """Surface deflections [rad] and throttle [0..1] for one cycle; bank, pitch and throttle asked for are limited first."""
        lifted = cycle.bank_with(max(wanted.lacking, 0.0) / UP_TIME)
        turning = GRAVITY / cycle.speed * math.sin(cycle.now.roll) * math.cos(cycle.now.pitch)
        bank = clip(wanted.bank, min(lifted, self._pitch.bank_limit(cycle)))
        rate = clip((bank - cycle.now.roll) / cycle.params.roll_time, ROLL_RATE_LIMIT)
        aileron = self._aileron(cycle, rate, turning)
        elevator = self._pitch.step(cycle, wanted.pitch, rate)
        return Surfaces(aileron, elevator, self._rudder(cycle, aileron, turning, wanted.rudder), min(max(wanted.throttle, 0.0), 1.0))

    def _aileron(self, cycle: Cycle, rate: float, turning: float) -> float:
        """rate: of roll, asked for [rad/s]; turning: r [rad/s] of a coordinated turn with the bank of now."""
        params, error = cycle.params, rate - cycle.now.p
        moving = math.sqrt(cycle.scale) * (params.roll_ff * rate + params.aileron_turn * turning) + cycle.scale * params.roll_p * error
        return self._roll.step(moving, cycle.scale, params.roll_i * error, cycle.dt)

    def _rudder(self, cycle: Cycle, aileron: float, turning: float, given: float | None) -> float:
        """Holds the rate of a coordinated turn, damps what differs from it, and goes with the aileron against the yaw of a roll.

        Takes out slowly the side force of slipping, unless a rudder is given: what is felt less the force of the rudder itself, which is
        the larger one of a slender aircraft, and of the other sign.
        """
        now, params = cycle.now, cycle.params
        damping = cycle.scale * params.yaw_damping * (now.r - turning)
        if given is not None:
            return self._servos.rudder.within(damping + given)
        held = math.sqrt(cycle.scale) * turning
        ahead = params.rudder_turn * held + params.rudder_mix * (aileron - params.aileron_turn * held)
        slipping = now.side_force - params.rudder_force / cycle.scale * self._steered
        self._steered = self._slip.step(damping + ahead, cycle.scale, params.slip_i * slipping, cycle.dt)
        return self._steered


def _turning(cycle: Cycle, bank: float, rolling: float) -> float:
    """q [rad/s] of a level coordinated turn with this bank [rad], which changes at ``rolling`` [rad/s].

    The path turns as the lift does, which follows the nose by ``lift_time``: the nose leads by what the turn changes within that time,
    up to the bank to which loads are compensated.
    """
    level = GRAVITY / cycle.speed * math.sin(bank)
    change = level * (1 + 1 / math.cos(bank) ** 2) * rolling if abs(bank) < FULL_BANK else 0.0
    return level * math.tan(bank) + clip(cycle.lift_time * change, PITCH_RATE_LIMIT)


def _pull(cycle: Cycle, load: float) -> float:
    """rad/s of pitch that so much of load factor allows."""
    return min(max(load, 0.0) * GRAVITY / cycle.speed, PITCH_RATE_LIMIT)
