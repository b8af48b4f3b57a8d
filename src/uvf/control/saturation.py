"""Surfaces at their stops: how long, and what is asked for then."""

import msgspec

from uvf.control.commands import Surfaces
from uvf.control.servos import Servos
from uvf.models.vehicle.flight_params import AirParams

AT_STOP = 0.98  # of the way
SHARE = 0.5  # of bank and climb that is still asked for


class Saturation:
    """A surface counts as free again after as long away from its stop as it was at it."""

    def __init__(self, servos: Servos) -> None:
        self._stops = {name: getattr(servos, name).limit for name in ("aileron", "elevator", "rudder")}
        self._times = dict.fromkeys(self._stops, 0.0)

    def step(self, surfaces: Surfaces, dt: float) -> None:
        for name, time in self._times.items():
            stopped = abs(getattr(surfaces, name)) >= AT_STOP * self._stops[name]
            self._times[name] = time + dt if stopped else max(time - dt, 0.0)

    @property
    def worst(self) -> tuple[str, float]:
        """The surface and its time at the stop [s]."""
        return max(self._times.items(), key=lambda item: item[1])


def eased(params: AirParams) -> AirParams:
    """Less bank, less climb and descent."""
    return msgspec.structs.replace(
        params,
        bank_limit=SHARE * params.bank_limit,
        turn_bank=SHARE * params.turn_bank,
        climb_max=SHARE * params.climb_max,
        sink_max=SHARE * params.sink_max,
    )
