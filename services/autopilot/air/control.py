"""Control in two levels: a path is held by attitude and throttle, an attitude by the surfaces.

Either level may be asked. Changing from the lower to the upper, the upper's integrators start without a bump.
"""

from services.autopilot.air.attitude_loops import AttitudeLoops
from services.autopilot.air.commands import Attitude, Surfaces, Wanted
from services.autopilot.air.cycle import Cycle
from services.autopilot.air.params import AirParams
from services.autopilot.air.path_loops import PathLoops
from services.autopilot.air.state import Estimate


class Control:
    """Both levels and what they have learnt."""

    def __init__(self) -> None:
        self._attitude = AttitudeLoops()
        self._path = PathLoops()
        self._held: Attitude | None = None

    def step(self, now: Estimate, wanted: Wanted, params: AirParams, dt: float) -> Surfaces:
        """Holds a height or a climb rate, and an airspeed."""
        cycle = Cycle(now, params, dt)
        if self._held is not None:
            self._path.begin(cycle, wanted, self._held.pitch, self._held.throttle)
            self._held = None
        pitch, throttle = self._path.step(cycle, wanted)
        throttle = throttle if wanted.throttle is None else wanted.throttle
        return self._attitude.step(cycle, Attitude(wanted.bank, pitch, throttle, wanted.rudder))

    def hold(self, now: Estimate, wanted: Attitude, params: AirParams, dt: float) -> Surfaces:
        """Holds an attitude with a given throttle: the lower level alone."""
        self._held = wanted
        return self._attitude.step(Cycle(now, params, dt), wanted)
