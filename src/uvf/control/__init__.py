"""Flight and drive control: attitude and total energy loops, actuator limits, gain design, teleoperation."""

from typing import TYPE_CHECKING

from uvf.lazy import lazily

if TYPE_CHECKING:
    from uvf.control.attitude_loops import AttitudeLoops as AttitudeLoops
    from uvf.control.commands import Surfaces as Surfaces
    from uvf.control.cycle import Cycle as Cycle
    from uvf.control.flight_control import FlightControl as FlightControl
    from uvf.control.total_energy import EnergyLoops as EnergyLoops

OFFERED = {
    "FlightControl": "uvf.control.flight_control:FlightControl",
    "AttitudeLoops": "uvf.control.attitude_loops:AttitudeLoops",
    "EnergyLoops": "uvf.control.total_energy:EnergyLoops",
    "Surfaces": "uvf.control.commands:Surfaces",
    "Cycle": "uvf.control.cycle:Cycle",
}
__all__ = list(OFFERED)
__getattr__, __dir__ = lazily(__name__, OFFERED)
