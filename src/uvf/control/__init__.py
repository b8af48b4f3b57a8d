"""Flight and drive control: attitude and total energy loops, actuator limits, gain design, teleoperation."""

from typing import TYPE_CHECKING

from uvf.lazy import lazily

if TYPE_CHECKING:
    from uvf.control.attitude_loops import AttitudeLoops as AttitudeLoops
    from uvf.control.commands import AltitudeAirspeedSetpoint as AltitudeAirspeedSetpoint
    from uvf.control.commands import AttitudeSetpoint as AttitudeSetpoint
    from uvf.control.commands import Surfaces as Surfaces
    from uvf.control.cycle import Cycle as Cycle
    from uvf.control.flight_control import FlightControl as FlightControl
    from uvf.control.servos import Servos as Servos
    from uvf.control.total_energy import EnergyLoops as EnergyLoops

OFFERED = {
    "FlightControl": "uvf.control.flight_control:FlightControl",
    "AttitudeLoops": "uvf.control.attitude_loops:AttitudeLoops",
    "EnergyLoops": "uvf.control.total_energy:EnergyLoops",
    "AltitudeAirspeedSetpoint": "uvf.control.commands:AltitudeAirspeedSetpoint",
    "AttitudeSetpoint": "uvf.control.commands:AttitudeSetpoint",
    "Servos": "uvf.control.servos:Servos",
    "Surfaces": "uvf.control.commands:Surfaces",
    "Cycle": "uvf.control.cycle:Cycle",
}
__all__ = list(OFFERED)
__getattr__, __dir__ = lazily(__name__, OFFERED)
