"""Altitude and climb rate: barometer and vertical acceleration, the barometer's offset learnt from satellite fixes.

Complementary filter of third order with a triple pole (height, climb, acceleration bias).
"""

POLE = 1.0  # rad/s
FIXES_AVERAGED = 300


class Vertical:
    """Started at the height [m] of the first fix and the barometer's reading of then [m]."""

    def __init__(self, height: float, baro: float, climb: float) -> None:
        self.height = height
        self.climb = climb
        self._bias = 0.0
        self._offset = height - baro
        self._fixes = 1

    def step(self, baro: float, acceleration: float, dt: float) -> None:
        """Barometric altitude [m] and upward acceleration without gravity [m/s^2]."""
        error = baro + self._offset - self.height
        self._bias += POLE**3 * error * dt
        self.height += (self.climb + 3 * POLE * error) * dt
        self.climb += (acceleration + self._bias + 3 * POLE**2 * error) * dt

    def correct_offset(self, height: float, baro: float) -> None:
        """A running mean over the fixes, then a slow average."""
        self._fixes = min(self._fixes + 1, FIXES_AVERAGED)
        change = (height - baro - self._offset) / self._fixes
        self._offset += change
        self.height += change
