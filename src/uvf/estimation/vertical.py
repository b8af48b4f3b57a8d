"""Altitude and climb rate: barometer and vertical acceleration, the barometer's offset learnt from satellite fixes.

Complementary filter of third order with a triple pole (height, climb, acceleration bias). Without a barometer the fixes alone
hold height and climb.
"""

POLE = 1.0  # rad/s
FIXES_AVERAGED = 300
FIX_WEIGHT = 0.3  # of a fix's height and climb, without a barometer


class Vertical:
    """Height [m, above the world's origin] and climb rate [m/s], started by those of the first fix."""

    def __init__(self, height: float, climb: float) -> None:
        self.height = height
        self.climb = climb
        self._bias = 0.0
        self._offset: float | None = None
        self._fixes = 1

    def step(self, baro: float | None, acceleration: float, dt: float) -> None:
        """Propagates over ``dt`` [s]: barometric altitude [m], if there is one, and upward acceleration without gravity [m/s^2]."""
        error = 0.0 if baro is None else baro + self._known_offset(baro) - self.height
        self._bias += POLE**3 * error * dt
        self.height += (self.climb + 3 * POLE * error) * dt
        self.climb += (acceleration + self._bias + 3 * POLE**2 * error) * dt

    def rest(self) -> None:
        """Holds the height while there are neither barometer nor fixes, for an acceleration alone leads anywhere."""
        self.climb = 0.0

    def correct(self, height: float, climb: float) -> None:
        """Corrects by height [m] and climb [m/s] of a fix while there is no barometer."""
        self.height += FIX_WEIGHT * (height - self.height)
        self.climb += FIX_WEIGHT * (climb - self.climb)

    def correct_offset(self, height: float, baro: float) -> None:
        """Learns the barometer's offset from a fix's ``height`` [m] and ``baro`` [m]: a running mean, later a slow average."""
        self._fixes = min(self._fixes + 1, FIXES_AVERAGED)
        change = (height - baro - self._known_offset(baro)) / self._fixes
        self._offset = self._known_offset(baro) + change
        self.height += change

    def _known_offset(self, baro: float) -> float:
        """m; the first barometric altitude is taken to be that of the height known then."""
        if self._offset is None:
            self._offset = self.height - baro
        return self._offset
