"""What ground stations want to know beside the state: what is steered at, and how good the estimate is."""

from schemas.messages import EstimateQuality, Targets, Vector3
from services.autopilot.air.mode_manager import ModeManager
from services.autopilot.air.mode_table import FlightMode
from services.autopilot.air.setpoints import ControlOutput
from uvf.estimation.state import Estimate
from uvf.guidance.flight_plan import OFF_PATH
from uvf.runtime.messages.convert import stamp


def targets(t: float, mode_manager: ModeManager, flown: ControlOutput) -> Targets:
    """Nothing that is not held now: by hand no place, with the surfaces in hand no attitude either."""
    message = Targets(timestamp=stamp(t), airspeed=flown.airspeed)
    if flown.airspeed is not None:
        message.altitude = flown.level.height
    if flown.attitude is not None:
        message.bank, message.pitch = flown.attitude.bank, flown.attitude.pitch
    item = mode_manager.navigator.target if mode_manager.mode is FlightMode.MISSION else None
    if item is not None and mode_manager.circle is None:
        message.place.CopyFrom(Vector3(x=item.place.east, y=item.place.north, z=item.place.height))
        message.radius = 0.0 if item.flies_through or item.kind in OFF_PATH else item.radius
    elif mode_manager.circle is not None:
        centre = mode_manager.circle.centre
        message.place.CopyFrom(Vector3(x=centre.east, y=centre.north, z=centre.height))
        message.radius = mode_manager.circle.radius
    return message


def quality(t: float, now: Estimate) -> EstimateQuality:
    fits = now.ratios
    return EstimateQuality(
        timestamp=stamp(t),
        position_known=now.position_known,
        height_known=now.height_known,
        airspeed_known=now.airspeed_known,
        position_sigma=now.position_sigma,
        height_sigma=now.height_sigma,
        tilt_sigma=now.tilt_sigma,
        yaw_sigma=now.yaw_sigma,
        wind_sigma=now.wind_sigma,
        position_ratio=fits.position,
        velocity_ratio=fits.velocity,
        height_ratio=fits.height,
        airspeed_ratio=fits.airspeed,
        slip_ratio=fits.slip,
        field_ratio=fits.field,
    )
