"""A vehicle's battery: charge, voltage under load, and what its voltage leaves of the throttle."""

import math

import numpy as np

from uvf.models.vehicle.air import BatteryPack

RELAXATION = 1.0  # s, behind which the voltage follows the current
MOST_LOST = 0.5  # of the open-circuit voltage: there a pack gives the most it can


class Charge:
    """Charge and voltage of a battery by Thevenin's model: an open-circuit voltage behind a resistance and a first-order lag.

    The open-circuit voltage falls in a straight line with the charge. A current-limited start of the motor is not modelled; the lag
    keeps its first milliseconds, when it still stands, from pulling the voltage down.
    """

    def __init__(self, pack: BatteryPack, charged: float = 1.0) -> None:
        """charged: energy at first, from 0 to 1 of the full pack [-]."""
        self._pack = pack
        self._left = charged * pack.energy  # J, at the open-circuit voltage
        self._sag = 0.0  # V
        self.current = 0.0  # A

    def draw(self, motor_power: float, dt: float, charger: float = 0.0) -> None:
        """Draws the electric ``motor_power`` [W], and that of the avionics, for ``dt`` [s], less what a ``charger`` [W] gives.

        A charger gives no more than is drawn once the pack is full. A current into the pack is negative.
        """
        power = motor_power + self._pack.avionics - charger
        self.current = max(power, 0.0) / self.voltage if self.remaining >= 1.0 else power / self.voltage
        self._left = min(max(self._left - self.open_circuit * self.current * dt, 0.0), self._pack.energy)
        self._sag += (self._pack.resistance * self.current - self._sag) * -math.expm1(-dt / RELAXATION)

    @property
    def remaining(self) -> float:
        """Energy that is left, from 0 to 1 of the full pack [-]."""
        return self._left / self._pack.energy

    @property
    def open_circuit(self) -> float:
        """Open-circuit voltage [V]."""
        return self._pack.empty + (self._pack.full - self._pack.empty) * self.remaining

    @property
    def voltage(self) -> float:
        """Terminal voltage [V]."""
        return self.open_circuit - max(min(self._sag, MOST_LOST * self.open_circuit), -MOST_LOST * self.open_circuit)

    def throttle(self, wanted: float) -> float:
        """Throttle, 0 to 1 [-], that the motors get of ``wanted`` [-]: their voltage is at most the battery's; 0 when it is empty."""
        if self.remaining == 0:
            return 0.0
        return wanted if self._pack.rated is None else min(wanted, self.voltage / self._pack.rated)


def lasts(pack: BatteryPack, power: float) -> float:
    """Time [s] from full to empty at a steady electric ``power`` [W], avionics included: the integral of V / (E P) over the energy."""
    cells = np.linspace(pack.empty, pack.full, 201)  # V, E
    terminals = cells / 2 + np.sqrt(np.maximum(cells**2 / 4 - pack.resistance * power, 0.0))
    return float(pack.energy / power * np.mean(terminals / cells))
