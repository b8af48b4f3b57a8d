"""Models of instruments: errors after IEEE Std 952, sampling, losses, lidar scans in motion."""

from typing import TYPE_CHECKING

from uvf.lazy import lazily

if TYPE_CHECKING:
    from uvf.sensors.allan import allan_deviation as allan_deviation
    from uvf.sensors.errors import Channel as Channel
    from uvf.sensors.errors import Errors as Errors
    from uvf.sensors.instruments import InertialUnit as InertialUnit
    from uvf.sensors.instruments import Receiver as Receiver
    from uvf.sensors.sampling import DelayLine as DelayLine

OFFERED = {
    "Errors": "uvf.sensors.errors:Errors",
    "Channel": "uvf.sensors.errors:Channel",
    "InertialUnit": "uvf.sensors.instruments:InertialUnit",
    "Receiver": "uvf.sensors.instruments:Receiver",
    "allan_deviation": "uvf.sensors.allan:allan_deviation",
    "DelayLine": "uvf.sensors.sampling:DelayLine",
}
__all__ = list(OFFERED)
__getattr__, __dir__ = lazily(__name__, OFFERED)
