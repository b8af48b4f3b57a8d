"""Surfaces at their stops: how long, and what is asked for then."""

import msgspec

from uvf.control.commands import Surfaces
from uvf.control.servos import Servos
from uvf.models.vehicle.flight_params import AirParams

AT_STOP = 0.98  # of the way
SHARE = 0.5  # of bank and climb that is still asked for


class Saturation:
    """How long each surface has been at its stop; it counts as free again after as long away from the stop as it was at it."""

    def __init__(self, servos: Servos) -> None:
        self._servos = servos
        self._times = dict.fromkeys(("aileron", "elevator", "rudder"), 0.0)

    def step(self, surfaces: Surfaces, dt: float) -> None:
        """Takes the commanded surfaces [rad] of one cycle of ``dt`` [s]."""
        for name, time in self._times.items():
            stopped = abs(getattr(self._servos, name).share(getattr(surfaces, name))) >= AT_STOP
            self._times[name] = time + dt if stopped else max(time - dt, 0.0)

    @property
    def worst(self) -> tuple[str, float]:
        """The surface that has been at its stop for longest, and its time there [s]."""
        return max(self._times.items(), key=lambda item: item[1])


def eased(params: AirParams) -> AirParams:
    """Parameters with half the bank of corners to come, climb and descent: what is planned with after a surface has been at its stop.

    Corners that have begun are flown as they were planned: the loops bank only as far as the elevator can carry.
    """
    return msgspec.structs.replace(
        params,
        turn_bank=SHARE * params.turn_bank,
        climb_max=SHARE * params.climb_max,
        sink_max=SHARE * params.sink_max,
    )
