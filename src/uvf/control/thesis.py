"""The control laws of the thesis (see the bibliography) as a preset to compare with: its loops, gains and names (``law: thesis``).

Successive loop closure as in ROSplane and Beard & McLain chapter 6: PD on roll and pitch, PI on altitude and airspeed, PI on the
side slip, and phases by altitude. Its surfaces go from -1 to 1, here from stop to stop; its positive elevator pitches up. Trim is the
aircraft's own. Its angle of side slip, which no sensor tells, is taken from the side force.
"""

from dataclasses import dataclass

from uvf.control.commands import AltitudeAirspeedSetpoint, AttitudeSetpoint, Surfaces
from uvf.control.cycle import Cycle, clip
from uvf.control.servos import Servos
from uvf.maths.geodesy import GRAVITY

HOLD_ZONE = 10.0  # m above and below the height asked for; beyond it climbs or descends
PITCH_LIMIT = 0.35  # rad, asked for
SIDE_SHARE = 0.17  # slope of the side force in the side slip over that of the lift in the angle of attack
LEAD = 2.0  # s, that a held climb rate's height is ahead


@dataclass(frozen=True)
class Gains:
    """The thesis' default gains, for surfaces and throttle in parts of their travel (-1..1), rad, m and s."""

    course_kp: float = 0.7329
    roll_kp: float = 1.17
    roll_kd: float = -0.13
    pitch_kp: float = 1.0
    pitch_kd: float = -0.17
    as_pitch_kp: float = -0.0713
    as_pitch_kd: float = -0.0635
    as_thr_kp: float = 3.2
    as_thr_ki: float = 1.0
    alt_kp: float = 0.045
    alt_ki: float = 0.01
    beta_kp: float = -0.1164
    beta_ki: float = -0.0037111
    chi_inf: float = 1.0472
    k_path: float = 0.025
    k_orbit: float = 4.0


GAINS = Gains()


def preset(trim_airspeed: float) -> dict[str, float | str]:
    """Autopilot parameters for the thesis' gains at ``trim_airspeed`` [m/s]; its course loop commands bank, ours turn rate."""
    follower = {"chi_inf": GAINS.chi_inf, "k_path": GAINS.k_path, "k_orbit": GAINS.k_orbit, "course_i": 0.0, "lead_time": 0.0}
    return {"law": "thesis", "course_p": GAINS.course_kp * GRAVITY / trim_airspeed, **follower}


class PiController:
    """PI controller with anti-windup: its integral gives way to the limits of its output."""

    def __init__(self, kp: float, ki: float) -> None:
        self._kp, self._ki = kp, ki
        self.integral = 0.0

    def step(self, error: float, trim: float, reach: tuple[float, float], dt: float) -> float:
        """Output for ``error``: ``trim`` plus proportional and integral parts, limited to ``reach`` (lowest, highest).

        ``dt`` in [s]; trim and reach are in the output's unit, the gains convert from the error's.
        """
        self.integral += error * dt
        asked = trim + self._kp * error + self._ki * self.integral
        given = min(max(asked, reach[0]), reach[1])
        if asked != given and self._ki:
            self.integral += (given - asked) / self._ki
            limit = max(abs(reach[0]), abs(reach[1])) / abs(self._ki)
            self.integral = clip(self.integral, limit)
        return given


class ThesisAttitude:
    """The thesis' inner loops: PD on roll and pitch, PI on sideslip."""

    def __init__(self, servos: Servos) -> None:
        self._servos = servos
        self._slip = PiController(GAINS.beta_kp, GAINS.beta_ki)

    def step(self, cycle: Cycle, wanted: AttitudeSetpoint) -> Surfaces:
        """Surface deflections [rad] and throttle [0..1] for one cycle."""
        now, params, servos = cycle.now, cycle.params, self._servos
        bank = clip(wanted.bank, params.bank_limit)
        roll = clip(GAINS.roll_kp * (bank - now.roll) + GAINS.roll_kd * now.p, 1.0)
        pitch = GAINS.pitch_kp * (clip(wanted.pitch, PITCH_LIMIT) - now.pitch) + GAINS.pitch_kd * now.q
        balance = params.elev_zero_alpha + params.elev_per_alpha * _cruise_alpha(cycle)
        elevator = clip(balance - servos.elevator.limit * pitch, servos.elevator.limit)
        slip = -now.side_force * params.alpha_per_load / (SIDE_SHARE * cycle.eas**2)
        rudder = self._slip.step(slip, 0.0, (-1.0, 1.0), cycle.dt) if wanted.rudder is None else wanted.rudder / servos.rudder.limit
        throttle = min(max(wanted.throttle, 0.0), 1.0)
        return Surfaces(servos.aileron.limit * roll, elevator, servos.rudder.limit * clip(rudder, 1.0), throttle)


class ThesisPath:
    """The thesis' outer loops: altitude and airspeed by the phase of flight (climb, descend, hold)."""

    lacking = 0.0

    def __init__(self) -> None:
        self._altitude = PiController(GAINS.alt_kp, GAINS.alt_ki)
        self._airspeed = PiController(GAINS.as_thr_kp, GAINS.as_thr_ki)
        self._before: float | None = None  # m/s

    def begin(self, cycle: Cycle, wanted: AltitudeAirspeedSetpoint, pitch: float, throttle: float) -> None:
        """Sets the integrals so that the first step in the hold zone asks for ``pitch`` [rad] and ``throttle`` [0..1]."""
        higher, faster = self._errors(cycle, wanted)
        self._altitude.integral = (pitch - _cruise_alpha(cycle) - GAINS.alt_kp * higher) / GAINS.alt_ki
        self._airspeed.integral = (throttle - cycle.params.trim_throttle - GAINS.as_thr_kp * faster) / GAINS.as_thr_ki

    def step(self, cycle: Cycle, wanted: AltitudeAirspeedSetpoint) -> tuple[float, float]:
        """Pitch [rad] and throttle [0..1] for one cycle."""
        higher, faster = self._errors(cycle, wanted)
        gained = 0.0 if self._before is None else (cycle.now.airspeed - self._before) / cycle.dt
        self._before = cycle.now.airspeed
        if abs(higher) > HOLD_ZONE:
            pitch, throttle = GAINS.as_pitch_kp * faster + GAINS.as_pitch_kd * clip(gained, GRAVITY), float(higher > 0)
        else:
            pitch = self._altitude.step(higher, _cruise_alpha(cycle), (-PITCH_LIMIT, PITCH_LIMIT), cycle.dt)
            throttle = self._airspeed.step(faster, cycle.params.trim_throttle, (0.0, 1.0), cycle.dt)
        return clip(pitch, PITCH_LIMIT), throttle if wanted.throttle is None else wanted.throttle

    @staticmethod
    def _errors(cycle: Cycle, wanted: AltitudeAirspeedSetpoint) -> tuple[float, float]:
        """m of height and m/s of airspeed that are wanting."""
        higher = wanted.climb * LEAD if wanted.height is None else wanted.height - cycle.now.height
        return higher, min(max(wanted.airspeed, cycle.params.min_airspeed), cycle.params.max_airspeed) - cycle.now.airspeed


def _cruise_alpha(cycle: Cycle) -> float:
    """rad, of level flight at the trim airspeed."""
    params = cycle.params
    return params.alpha_zero_lift + params.alpha_per_load * GRAVITY / params.trim_airspeed**2
