"""All loops of an aircraft at several airspeeds: their margins, and how they stand when the aircraft is not what its model says."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from uvf.control.design import lateral_loops, longitudinal_loops
from uvf.control.design.flight_condition import ActuatorDelays, FlightCondition, scaled
from uvf.control.design.margins import Margins, margins
from uvf.control.design.signal_flow import Floats, SignalFlow
from uvf.control.flight_control import on_final
from uvf.models.vehicle.flight_params import AirParams

OMEGA: Floats = np.geomspace(0.004, 1000.0, 700)  # rad/s
LATERAL = (("v", ("v",)), ("p", ("v", "p", "r", "delta_a", "delta_r")), ("r", ("v", "p", "r", "delta_a", "delta_r")))
LONGITUDINAL = (("u", ("u", "w", "delta_t")), ("w", ("u", "w", "delta_e")), ("q", ("u", "w", "q", "delta_e")))
"""Derivatives that come from forces of the air and the engine, each state with by what."""
SPREAD, LAG_SPREAD = 0.3, 0.5  # of a derivative; of a lag
CORNERS = 16
FINAL_UP_TO = 1.005  # of the trim speed: how fast the final approach is flown at most


@dataclass(frozen=True)
class Loop:
    """A loop at one airspeed [m/s], opened where ``lateral_loops`` and ``longitudinal_loops`` say; stable: all of them together."""

    name: str
    airspeed: float
    margins: Margins
    stable: bool


@dataclass(frozen=True)
class AircraftLoops:
    """What the loops hold: at several airspeeds, slow to fast."""

    conditions: Sequence[FlightCondition]
    delays: ActuatorDelays
    powered: bool = True

    def with_lags(self, factor: float) -> "AircraftLoops":
        """With all lags of servos and engine times ``factor``."""
        return replace(self, delays=self.delays.slower(factor))

    def loops(self, params: AirParams) -> list[Loop]:
        """Every loop at every airspeed."""
        return [loop for flight in self.conditions for loop in loops(flight, self.delays, params, self.powered)]

    def spread(self, seed: int = 1) -> list[tuple[FlightCondition, ActuatorDelays]]:
        """Corners of what the aircraft may be: each derivative +-30 %, all lags +-50 %, drawn at random by ``seed``."""
        rng = np.random.default_rng(seed)
        found = []
        for k in range(CORNERS):
            delays = self.delays.slower(1 + LAG_SPREAD * (-1) ** k)
            found += [(_another(flight, rng), delays) for flight in self.conditions]
        return found

    def worst(self, params: AirParams, seed: int = 1) -> list[Loop]:
        """Every loop of every aircraft of ``spread``."""
        return [loop for flight, delays in self.spread(seed) for loop in loops(flight, delays, params, self.powered)]


def loops(flight: FlightCondition, delays: ActuatorDelays, params: AirParams, powered: bool = True) -> Iterator[Loop]:
    """Every loop at one airspeed; without an engine pitch holds the airspeed, on the final approach, too."""
    yield from _of(lateral_loops.lateral_flow(OMEGA, flight, delays, params), lateral_loops.loops_of(flight), flight)
    if powered:
        yield from _of(longitudinal_loops.longitudinal_flow(OMEGA, flight, delays, params), longitudinal_loops.LOOPS, flight)
        yield from _of(longitudinal_loops.gliding_flow(OMEGA, flight, delays, params), longitudinal_loops.AT_FULL_THROTTLE, flight)
    else:
        yield from _of(longitudinal_loops.gliding_flow(OMEGA, flight, delays, params), longitudinal_loops.GLIDING, flight)
    final = on_final(params)
    yield from _of(lateral_loops.attitude_flow(OMEGA, flight, delays, final), lateral_loops.ATTITUDE, flight)
    yield from _of(longitudinal_loops.attitude_flow(OMEGA, flight, delays, final), longitudinal_loops.ATTITUDE, flight)
    if flight.airspeed < FINAL_UP_TO * params.trim_airspeed:
        yield from _of(lateral_loops.lateral_flow(OMEGA, flight, delays, final), lateral_loops.ON_FINAL, flight)
        if powered:
            yield from _of(longitudinal_loops.longitudinal_flow(OMEGA, flight, delays, final), longitudinal_loops.ON_FINAL, flight)


def _of(flow: SignalFlow, opened: dict[str, str], flight: FlightCondition) -> Iterator[Loop]:
    stable = flow.unstable == 0
    for name, at in opened.items():
        yield Loop(name, flight.airspeed, margins(flow.omega, flow.loop(at)), stable)


def _another(flight: FlightCondition, rng: np.random.Generator) -> FlightCondition:
    """The same flight of an aircraft whose derivatives are off, each to one end of the spread."""

    def off(derivatives: Sequence[tuple[str, Sequence[str]]]) -> dict[tuple[str, str], float]:
        return {(state, by): 1 + SPREAD * float(rng.choice((-1.0, 1.0))) for state, sources in derivatives for by in sources}

    return replace(flight, lateral=scaled(flight.lateral, off(LATERAL)), longitudinal=scaled(flight.longitudinal, off(LONGITUDINAL)))
