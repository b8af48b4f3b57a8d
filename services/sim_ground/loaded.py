"""What the physics of the ground vehicles keeps of a vehicle, and of a state that can be gone back to."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.sim_ground.motor import WheelMotor
from services.sim_ground.treads import Treads

Floats = NDArray[np.float64]


@dataclass
class LoadedVehicle:
    """A vehicle inside the engine, whose own frame is the centre of mass: position (3,) m and orientation wxyz in base_link."""

    index: int
    wheels: tuple[int, ...]
    """Joints of the driven wheels, those of the left side first."""
    motors: tuple[WheelMotor, ...]
    com_in_base: tuple[Floats, Floats]
    friction: float
    """Coefficient of the wheels."""
    treads: Treads | None
    """Friction of the driven wheels where the engine's own is not for them: those that scrub."""
    soles: frozenset[int]
    """Links with which it stands on a level floor: wheels and castors."""
    grip: tuple[float, float] = (1.0, 1.0)
    """Share of it that the wheels of the left and the right side have now."""

    def by_side(self, sides: tuple[float, float]) -> list[float]:
        """What holds for the left and the right side, wheel by wheel."""
        half = len(self.wheels) // 2
        return [sides[0]] * half + [sides[1]] * half


@dataclass(frozen=True)
class Saved:
    """A state of the engine by its number; the motors' references [rad/s] and the treads' deflections [m] by vehicle."""

    state: int
    references: dict[str, list[float]]
    deflections: dict[str, Floats]
