"""Mode Offboard: what somebody outside asks for, as an attitude, a course with altitude and airspeed, or a path."""

import math
from collections.abc import Iterator, Mapping

from schemas.messages import FlightSetpoint
from services.autopilot.air.setpoints import FlightContext, FlightPhase, PathSetpoint, Setpoint
from services.autopilot.multiplexing import OFFBOARD, Multiplexer
from uvf.control.commands import AttitudeSetpoint
from uvf.control.cycle import clip
from uvf.estimation.state import Estimate
from uvf.guidance.vector_field import PathReference, line_reference, orbit_reference
from uvf.models.vehicle.flight_params import AirParams
from uvf.runtime.messages.convert import seconds

OLDEST = 0.5  # s
CLOCK_TOLERANCE = 0.02  # s, one tick
STEEPEST = 10.0  # climb over level distance, of a line; a steeper one leads nowhere
SHORTEST = 1e-3  # level part of a line's direction


def fresh(t: float, message: FlightSetpoint | None) -> FlightSetpoint | None:
    """The setpoint that counts at ``t`` [s]; None when it is old, empty, no path, or a number of it is not finite."""
    if message is None or not -CLOCK_TOLERANCE <= t - seconds(message.timestamp) <= OLDEST:
        return None
    return message if all(map(math.isfinite, _numbers(message))) and _is_whole(message) else None


def _is_whole(m: FlightSetpoint) -> bool:
    if m.HasField("line"):
        d = m.line.direction
        return abs(d.z) <= STEEPEST * math.hypot(d.x, d.y) and math.hypot(d.x, d.y) > SHORTEST
    if m.HasField("circle"):
        return m.circle.radius != 0
    return m.HasField("attitude") or m.HasField("course")


def _numbers(m: FlightSetpoint) -> Iterator[float]:
    a, c, o, r = m.attitude, m.course, m.line, m.circle
    yield from (a.bank, a.pitch, a.throttle, c.course, c.altitude, c.airspeed, o.airspeed, r.radius, r.airspeed)
    for v in (o.origin, o.direction, r.centre):
        yield from (v.x, v.y, v.z)


class SetpointSources(Multiplexer):
    """Of all senders, by their keys."""

    def __init__(self) -> None:
        super().__init__("setpoints", OFFBOARD)

    def choose(self, t: float, said: Mapping[str, FlightSetpoint | None]) -> FlightSetpoint | None:
        """The one that is followed at ``t`` [s]."""
        counted = {source: m for source, message in said.items() if (m := fresh(t, message)) is not None}
        return counted.get(self.pick(counted))


class OffboardMode(FlightPhase):
    """``step`` is called while there is a setpoint."""

    def __init__(self, context: FlightContext) -> None:
        self._senses = context

    def step(self, now: Estimate, params: AirParams, dt: float) -> Setpoint:
        """Setpoint of this cycle of ``dt`` [s]: what the holder asks for, within the aircraft's limits."""
        message = self._senses.setpoint
        assert message is not None, "the table ends this mode without a setpoint"
        if message.HasField("attitude"):
            a = message.attitude
            pitch, throttle = clip(a.pitch, params.pitch_limit), min(max(a.throttle, 0.0), 1.0)
            return Setpoint(AttitudeSetpoint(clip(a.bank, params.bank_limit), pitch, throttle))
        if message.HasField("course"):
            c = message.course
            aim = PathReference(0.0, c.course, 0.0, params.k_path, params.chi_inf)
            return Setpoint(PathSetpoint(aim, c.altitude, 0.0, c.airspeed or params.trim_airspeed))
        return _line(message, now, params) if message.HasField("line") else _circle(message, now, params)


def _line(message: FlightSetpoint, now: Estimate, params: AirParams) -> Setpoint:
    line = message.line
    origin, d = line.origin, line.direction
    level = math.hypot(d.x, d.y)
    along = (d.y / level, d.x / level)
    aim = line_reference(along, (origin.y, origin.x), (now.north, now.east), params)
    flown = (now.north - origin.y) * along[0] + (now.east - origin.x) * along[1]
    slope = d.z / level
    return Setpoint(PathSetpoint(aim, origin.z + slope * flown, slope * now.ground_speed, line.airspeed or params.trim_airspeed))


def _circle(message: FlightSetpoint, now: Estimate, params: AirParams) -> Setpoint:
    circle = message.circle
    aim = orbit_reference((circle.centre.y, circle.centre.x), circle.radius, (now.north, now.east), params)
    return Setpoint(PathSetpoint(aim, circle.centre.z, 0.0, circle.airspeed or params.trim_airspeed))
