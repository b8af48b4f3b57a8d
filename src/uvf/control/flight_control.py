"""Control in two levels: a path is held by attitude and throttle, an attitude by the surfaces.

Either level may be asked. Changing from the lower to the upper, or from law to law, what the upper has learnt starts without a bump.
"""

from typing import Protocol

import msgspec

from uvf.control.airship import AirshipAttitude, AirshipPath
from uvf.control.attitude_loops import AttitudeLoops
from uvf.control.commands import AltitudeAirspeedSetpoint, AttitudeSetpoint, Surfaces
from uvf.control.cycle import Cycle
from uvf.control.servos import Servos
from uvf.control.thesis import ThesisAttitude, ThesisPath
from uvf.control.total_energy import EnergyLoops
from uvf.estimation.state import Estimate
from uvf.maths.geodesy import GRAVITY
from uvf.models.vehicle.flight_params import AirParams


class AttitudeLaw(Protocol):
    """Inner control law: from an attitude setpoint to the surfaces."""

    def step(self, cycle: Cycle, wanted: AttitudeSetpoint) -> Surfaces:
        """Surface deflections [rad] and throttle [0..1] that bring the aircraft to the attitude ``wanted``."""
        ...


class PathLaw(Protocol):
    """Outer control law: from height or climb rate, and airspeed, to pitch and throttle."""

    lacking: float
    """Climb rate [m/s] that the last cycle asked for beyond the present one, as far as the turn can have it; a law may always say 0."""

    def begin(self, cycle: Cycle, wanted: AltitudeAirspeedSetpoint, pitch: float, throttle: float) -> None:
        """Sets the integrators so that the first step asks for ``pitch`` [rad] and ``throttle`` [0..1]: a bumpless transfer."""
        ...

    def step(self, cycle: Cycle, wanted: AltitudeAirspeedSetpoint) -> tuple[float, float]:
        """Pitch [rad] and throttle [0..1] for one cycle."""
        ...


class FlightControl:
    """Inner and outer loops of the control law chosen by ``params.law``, with their integrators."""

    def __init__(self, servos: Servos) -> None:
        self._inner: dict[str, AttitudeLaw] = {
            "energy": AttitudeLoops(servos),
            "airship": AirshipAttitude(servos),
            "thesis": ThesisAttitude(servos),
        }
        self._outer: dict[str, PathLaw] = {"energy": EnergyLoops(), "airship": AirshipPath(), "thesis": ThesisPath()}
        self._flown = ""  # the law of the upper level in the last cycle; none when an attitude was held
        self._held: AttitudeSetpoint | None = None

    @property
    def held(self) -> AttitudeSetpoint | None:
        """The attitude setpoint of the last cycle; None before the first."""
        return self._held

    def step(self, now: Estimate, wanted: AltitudeAirspeedSetpoint, params: AirParams, dt: float) -> Surfaces:
        """Surfaces that hold a height or a climb rate, an airspeed and a bank, for one cycle of ``dt`` [s]."""
        cycle, outer = Cycle(now, params, dt), self._outer[params.law]
        if self._held is not None and self._flown != params.law:
            outer.begin(cycle, wanted, self._held.pitch, self._held.throttle)
        self._flown = params.law
        pitch, throttle = outer.step(cycle, wanted)
        self._held = AttitudeSetpoint(wanted.bank, pitch, throttle, wanted.rudder, outer.lacking)
        return self._inner[params.law].step(cycle, self._held)

    def hold(self, now: Estimate, wanted: AttitudeSetpoint, params: AirParams, dt: float) -> Surfaces:
        """Surfaces that hold an attitude with a given throttle by the inner loops alone, for one cycle of ``dt`` [s].

        As firmly as on the final approach: what holds a path leaves the attitude to the gusts as far as they do not move the path.
        """
        self._held, self._flown = wanted, ""
        return self._inner[params.law].step(Cycle(now, on_final(params), dt), wanted)


def on_final(params: AirParams) -> AirParams:
    """The parameters as they are flown on the last metres before touching down; ``altitude_p`` there is that of the flare."""
    roll = {"roll_time": params.final_roll_time, "roll_p": params.final_roll_p, "roll_i": params.final_roll_i}
    pitch = {"pitch_time": params.final_pitch_time, "pitch_p": params.final_pitch_p, "pitch_i": params.final_pitch_i}
    path = {"course_p": params.final_course_p, "k_path": params.final_k_path, "climb_p": params.final_climb_p}
    return msgspec.structs.replace(params, altitude_p=params.flare_p, **roll, **pitch, **path)


def level_trim(params: AirParams) -> Surfaces:
    """Surfaces and throttle of straight level flight at cruise, for an aircraft that senses nothing (Beard & McLain, section 5.3)."""
    alpha = params.alpha_zero_lift + params.alpha_per_load * GRAVITY / params.trim_airspeed**2
    return Surfaces(0.0, params.elev_zero_alpha + params.elev_per_alpha * alpha, 0.0, params.trim_throttle)
