"""What is sent to a vehicle's actuators when its autopilot has failed too often to be tried again."""

from schemas.messages import Kind, Mode, SurfaceCommand, VehicleStatus, WheelCommand
from uvf.runtime.messages.convert import stamp
from uvf.runtime.messages.outputs import OutputMessages

SPIRAL = 0.1  # rad of rudder: with the motor off it comes down in a wide turn instead of gliding out of sight


def standing(t: float, reason: str) -> OutputMessages:
    """Outputs at ``t`` [s] that stop the wheels of a ground vehicle."""
    return {"wheels": WheelCommand(timestamp=stamp(t)), "status": _status(t, Kind.KIND_GROUND, reason)}


def coming_down(t: float, reason: str) -> OutputMessages:
    """Outputs at ``t`` [s] for an aircraft that nothing controls: motor off, ``SPIRAL`` [rad] of rudder; on the ground it brakes."""
    down = SurfaceCommand(timestamp=stamp(t), rudder=SPIRAL, brake=1.0)
    return {"surfaces": down, "status": _status(t, Kind.KIND_FIXED_WING, reason)}


def _status(t: float, kind: Kind, reason: str) -> VehicleStatus:
    landed = kind == Kind.KIND_GROUND
    return VehicleStatus(timestamp=stamp(t), kind=kind, mode=Mode.MODE_HOLD, landed=landed, reason=reason, failsafes=[reason])
