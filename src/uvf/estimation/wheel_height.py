"""How high the wheels are over a strip and how fast they sink: the estimate, corrected by a range finder that looks down."""

from uvf.estimation.state import Estimate
from uvf.models.vehicle.flight_params import AirParams

BELOW, WITHIN = 20.0, 150.0  # m of height and distance: from here on the range finder sees the strip's level
POLE = 1.5  # rad/s
MOST_DRIFT = 0.5  # m/s


class WheelHeight:
    """Observer with a double pole that learns by how much the estimated height is off, and how fast that changes."""

    def __init__(self, ground: float) -> None:
        """ground: m, world, of the strip."""
        self._ground = ground
        self._off = 0.0  # m
        self._drift = 0.0  # m/s
        self.height = 0.0
        """m, of the wheels over the strip."""
        self.climb = 0.0
        """m/s."""

    def step(self, now: Estimate, seen: float | None, distance: float, params: AirParams, dt: float) -> None:
        """Takes one cycle of ``dt`` [s].

        seen: [m] from the wheels down to the ground by the range finder, None without an echo; distance: [m] before the aiming point.
        """
        estimated = now.height - params.gear_height - self._ground
        if seen is not None and distance < WITHIN and seen < BELOW:
            error = seen - estimated - self._off
            self._off += (self._drift + 2 * POLE * error) * dt
            self._drift = min(max(self._drift + POLE**2 * error * dt, -MOST_DRIFT), MOST_DRIFT)
        self.height = estimated + self._off
        self.climb = now.climb + self._drift

    def touched(self, now: Estimate, params: AirParams) -> None:
        """The wheels are on the strip now, whatever was estimated."""
        self._off, self._drift = params.gear_height + self._ground - now.height, 0.0

    def over_touch(self, now: Estimate, params: AirParams) -> float:
        """Estimated height [m] of the wheels over where they touched."""
        return now.height - params.gear_height - self._ground + self._off
