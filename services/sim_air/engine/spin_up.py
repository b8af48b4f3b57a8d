"""Lets the engines of a model turn on until they are steady, while its body is held still."""

from collections.abc import Callable

from services.sim_air.engine.gauges import Gauges
from services.sim_air.engine.initial import Engine

FIRST = 3.0  # s, after which most propellers turn steadily
LONGEST = 24.0  # s
CHECK = 0.5  # s, over which the thrust of a steady one does not change
STEADY = 1e-6  # of the thrust
FUEL_FREEZE = "propulsion/fuel_freeze"
INTEGRATORS = tuple(
    f"simulation/integrator/{kind}" for kind in ("rate/rotational", "rate/translational", "position/rotational", "position/translational")
)


class Hold:
    """Holds the motion of the body while the engine runs on, and releases it.

    The model's own actuators follow at once meanwhile, as while JSBSim trims: with their hysteresis the result would depend on the way.
    """

    def __init__(self, fdm: Engine, burns: bool) -> None:
        """burns: whether it burns its fuel once it is released."""
        self._fdm, self._burns = fdm, burns
        self._integrators = {name: fdm[name] for name in INTEGRATORS}

    def still(self, still: bool) -> None:
        """Holds or releases the body."""
        for name, method in self._integrators.items():
            self._fdm[name] = 0 if still else method
        self._fdm[FUEL_FREEZE] = int(still or not self._burns)
        self._fdm.set_trim_status(still)


class SpinUp:
    """Runs the engines of a held body until they are steady, and remembers how long that takes with this aircraft."""

    def __init__(self, hz: float) -> None:
        """hz: physics steps a second."""
        self._hz = hz
        self._time = FIRST

    def settle(self, fdm: Engine, gauges: Gauges, put: Callable[[float], None]) -> None:
        """Runs until the thrust is steady; put: sets the state, given the time [s] for which it will be held."""
        put(self._time)
        while not self._steady(fdm, gauges):
            self._time *= 2
            put(self._time)

    def _steady(self, fdm: Engine, gauges: Gauges) -> bool:
        """Whether it has become steady, or never will."""
        for _ in range(round((self._time - CHECK) * self._hz)):
            fdm.run()
        before = gauges.propulsive_force
        for _ in range(round(CHECK * self._hz)):
            fdm.run()
        change = abs(gauges.propulsive_force - before)
        return change <= STEADY * max(abs(before), 1.0) or self._time >= LONGEST
