"""What the autopilot is told of its vehicle."""

from dataclasses import dataclass, field

from schemas.messages import Fence, MissionItem
from uvf.control.servos import SERVOS, Servos
from uvf.estimation.estimators import Instruments
from uvf.guidance.runways import LandingStrip
from uvf.maths.geodesy import LocalTangent


@dataclass(frozen=True)
class AutopilotConfig:
    """What the autopilot is told of its vehicle at the start."""

    name: str
    system_id: int
    tangent: LocalTangent
    instruments: Instruments
    items: list[MissionItem]
    starts_in_air: bool
    ground: float = 0.0  # m, world: height of the ground below the start
    servos: Servos = SERVOS
    strips: tuple[LandingStrip, ...] = ()
    altimeter: str = ""
    """Frame of the range finder that looks down."""
    starts_armed: bool = False
    fence: Fence = field(default_factory=Fence)
    leads: bool = False
    """Others follow it."""
