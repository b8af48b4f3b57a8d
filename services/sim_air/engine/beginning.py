"""How an aircraft begins: in steady flight, level, climbing or turning, or standing on its wheels."""

from dataclasses import dataclass, replace

import numpy as np

from services.sim_air.engine.airframe import Airframe
from services.sim_air.engine.states import InitialState
from services.sim_air.engine.wiring import Controls
from services.sim_air.environment.wind import AirMass
from uvf.models.mission import file as mission_file
from uvf.models.vehicle.air import AirBody
from uvf.models.yaml_data import BadInput

CLEAR = 100.0  # m above the ground, where the trim of an aircraft that stands is looked for


@dataclass(frozen=True)
class FlightStart:
    """How a flight begins. flight: what to fly, or only where to stand; trim_speed [m/s]."""

    flight: InitialState
    standing: bool
    trim_speed: float
    thrown: bool = False


def as_told(begin: mission_file.StartPose, body: AirBody, air: AirMass, ground: float) -> FlightStart:
    """The beginning that a mission's start asks for: no height above the ``ground`` [m, world] means standing, no speed the trim speed."""
    position, standing = np.array((begin.x, begin.y, ground + begin.z)), begin.on_ground or begin.z == 0
    flight = InitialState(position, begin.yaw, begin.speed or body.trim_speed, air.mean(begin.z), begin.climb, begin.turn_rate)
    return FlightStart(flight, standing, body.trim_speed, begin.launch is not None)


def begun(airframe: Airframe, begin: FlightStart) -> tuple[Controls, Controls]:
    """Puts the airframe there; returns its controls then, and those of level flight for when nobody steers. Raises BadInput.

    What is to be thrown is put nowhere before that.
    """
    if begin.thrown:
        return Controls(brake=1.0), _level(airframe, begin)
    if begin.standing:
        level = _level(airframe, begin)
        airframe.stand(begin.flight)
        return Controls(brake=1.0), level
    if begin.flight.climb == begin.flight.turn_rate == 0:
        trim = airframe.start(begin.flight).controls
        return trim, trim
    level = airframe.start(replace(begin.flight, climb=0.0, turn_rate=0.0)).controls
    return airframe.start(begin.flight).controls, level


def _level(airframe: Airframe, begin: FlightStart) -> Controls:
    """Of an aircraft that stands, and may not be able to fly: a glider."""
    above = begin.flight.position + np.array((0.0, 0.0, CLEAR))
    try:
        return airframe.start(replace(begin.flight, position=above, airspeed=begin.trim_speed, climb=0.0, turn_rate=0.0)).controls
    except BadInput:
        return Controls()
