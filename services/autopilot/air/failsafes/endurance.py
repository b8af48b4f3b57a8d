"""How much of the battery is left, and how much of it the way home takes."""

import math

from schemas.messages import Battery
from uvf.estimation.state import Estimate
from uvf.guidance.route import Place
from uvf.models.vehicle.flight_params import AirParams

USE_TIME = 60.0  # s, behind which the rate of use follows
LEARNT = 30.0  # s of use before the rate counts
MORE = 1.3  # than reckoned: climbs, gusts, the circle at home
SLOWEST = 0.5  # m/s made good; less is no way home


class Endurance:
    """Charge as the battery tells it, and its rate of use."""

    def __init__(self) -> None:
        self.charge = 1.0  # 0..1; full while nothing is known
        self.shown = (-1.0, 0.0)
        """Charge 0..1 (negative: unknown) and voltage [V], as told."""
        self._rate = 0.0  # 1/s
        self._seen: tuple[float, float] | None = None
        self._used = 0.0  # s

    def take(self, t: float, battery: Battery | None) -> None:
        """The newest message at ``t`` [s]; an unknown charge (negative) is none."""
        self.shown = (battery.remaining, battery.voltage) if battery is not None else (-1.0, 0.0)
        if battery is None or not battery.remaining >= 0 or (self._seen is not None and t - self._seen[0] < 1.0):
            return
        if self._seen is not None:
            dt, used = t - self._seen[0], self._seen[1] - battery.remaining
            self._used = self._used + dt if used > 0 else 0.0
            self._rate += min(dt / min(USE_TIME, max(self._used, dt)), 1.0) * (max(used, 0.0) / dt - self._rate)
        self.charge, self._seen = battery.remaining, (t, battery.remaining)

    def spare(self, now: Estimate, home: Place | None, params: AirParams) -> float:
        """0..1, of charge at home, flown there straight from here; inf while the rate of use is not known."""
        if home is None or self._used < LEARNT:
            return math.inf
        return self.charge - MORE * self._rate * seconds_home(now, home, params)


def seconds_home(now: Estimate, home: Place, params: AirParams) -> float:
    """Time [s] home at trim airspeed against the wind of now; inf where that is too strong."""
    north, east = home.north - now.north, home.east - now.east
    distance = math.hypot(north, east)
    if distance < 1.0:
        return 0.0
    along = (now.wind_north * north + now.wind_east * east) / distance
    across = (now.wind_east * north - now.wind_north * east) / distance
    if abs(across) >= params.trim_airspeed:
        return math.inf
    made_good = math.sqrt(params.trim_airspeed**2 - across**2) + along
    return distance / made_good if made_good > SLOWEST else math.inf
