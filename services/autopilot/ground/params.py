"""Parameters of the autopilot of a ground vehicle."""

from typing import Annotated, Literal

from msgspec import Meta

from uvf.runtime.service import Params

Choice = Literal["warn", "hold", "return", "off"]


class GroundAutopilotParams(Params, frozen=True):
    acceptance_radius: Annotated[float, Meta(gt=0)] = 0.25  # m, of waypoints that name none
    link_timeout: Annotated[float, Meta(ge=1, le=300)] = 5.0  # s of silence of all ground stations, after which it holds
    stuck_time: Annotated[float, Meta(ge=0.5, le=60)] = 4.0  # s that wheels are held fast, or turn in vain, until it counts as stuck
    tilt_max: Annotated[float, Meta(ge=0.1, le=1.5)] = 0.6  # rad from upright that no ramp has
    scan_timeout: Annotated[float, Meta(ge=0.3, le=60)] = 1.0  # s without a new scan, after which nothing drives by itself
    map_timeout: Annotated[float, Meta(ge=1, le=300)] = 5.0  # s without a word of the mapping, the same
    battery_low: Annotated[float, Meta(ge=0, le=0.9)] = 0.2  # charge that is low
    battery_critical: Annotated[float, Meta(ge=0, le=0.9)] = 0.07  # charge that is critical
    low_action: Choice = "return"
    critical_action: Choice = "off"
