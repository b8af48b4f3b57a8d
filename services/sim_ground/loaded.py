"""What the physics of the ground vehicles keeps of a vehicle, and of a state that can be gone back to."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.sim_ground.motor import WheelMotor

Floats = NDArray[np.float64]


@dataclass
class LoadedVehicle:
    """A vehicle inside the engine, whose own frame is the centre of mass: position (3,) m and orientation wxyz in base_link."""

    index: int
    wheels: tuple[int, int]
    motors: tuple[WheelMotor, WheelMotor]
    com_in_base: tuple[Floats, Floats]
    up_in_com: tuple[float, float, float]
    friction: float
    """Coefficient of the wheels."""
    soles: frozenset[int]
    """Links with which it stands on a level floor: wheels and castors."""
    grip: tuple[float, float] = (1.0, 1.0)
    """Share of it that the left and the right wheel have now."""


@dataclass(frozen=True)
class Saved:
    """A state of the engine by its number, and the motors' references [rad/s] by vehicle."""

    state: int
    references: dict[str, list[float]]
