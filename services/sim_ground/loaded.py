"""What the physics of the ground vehicles keeps of a vehicle, and of a state that can be gone back to."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite

import numpy as np
from numpy.typing import NDArray

from services.sim_ground.joints import JointDrives, Springs
from services.sim_ground.motor import WheelMotor
from services.sim_ground.steering import SteeringGear
from services.sim_ground.treads import Treads

Floats = NDArray[np.float64]


@dataclass
class LoadedVehicle:
    """A vehicle inside the engine, whose own frame is the centre of mass: position (3,) m and orientation wxyz in base_link."""

    index: int
    on_left: tuple[bool, ...]
    channels: tuple[int, ...]
    """Of each driven wheel, as its drive has them."""
    wheels: tuple[int, ...]
    """Joints of the driven wheels, in the order of the drive."""
    motors: tuple[WheelMotor, ...]
    com_in_base: tuple[Floats, Floats]
    friction: float
    """Coefficient of the wheels."""
    treads: Treads | None
    """Friction of the driven wheels where the engine's own is not for them: those that scrub."""
    soles: frozenset[int]
    """Links with which it stands on a level floor: wheels and castors."""
    steering: SteeringGear | None = None
    drives: JointDrives | None = None
    springs: Springs | None = None
    grip: tuple[float, float] = (1.0, 1.0)
    """Share of it that the wheels of the left and the right side have now."""

    @property
    def other_joints(self) -> tuple[int, ...]:
        """Those that are moved on command, then those on springs."""
        return (*(self.drives.joints if self.drives else ()), *(self.springs.joints if self.springs else ()))

    def by_wheel(self, speeds: Sequence[float]) -> list[float]:
        """Speeds of the drive's channels [rad/s] wheel by wheel; 0 where there are not as many as it has, or one is no number."""
        are_right = len(speeds) == max(self.channels) + 1 and all(map(isfinite, speeds))
        return [speeds[channel] if are_right else 0.0 for channel in self.channels]


@dataclass(frozen=True)
class Saved:
    """A state of the engine by its number; by vehicle the motors' references [rad/s], the treads' deflections [m], the steering [rad].

    joints: where their drives hold them [rad or m].
    """

    state: int
    references: dict[str, list[float]]
    deflections: dict[str, Floats]
    steering: dict[str, float]
    joints: dict[str, list[float]]
