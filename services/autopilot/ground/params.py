"""Parameters of the autopilot of a ground vehicle."""

from typing import Annotated, Literal

from msgspec import Meta

from uvf.models.params import Params


def _meta(low: float, high: float, unit: str, about: str) -> Meta:
    return Meta(ge=low, le=high, description=about, extra_json_schema={"unit": unit})


Choice = Literal["warn", "hold", "return", "off"]


class GroundAutopilotParams(Params, frozen=True):
    """Names have at most 16 characters, the length of a MAVLink parameter; the radius has a shorter one there."""

    acceptance_radius: Annotated[float, _meta(0.01, 10, "m", "of waypoints that name none")] = 0.25
    link_timeout: Annotated[float, _meta(1, 300, "s", "silence of all ground stations until the link is lost")] = 5.0
    link_action: Annotated[Choice, Meta(description="when the link is lost")] = "hold"
    stick_timeout: Annotated[float, _meta(0.2, 10, "s", "that a command by hand counts; then it stands")] = 0.5
    stick_action: Annotated[
        Literal["wait", "hold", "return", "off"],
        Meta(description="when manual control is lost; wait: it stands until it is back"),
    ] = "wait"
    fence_action: Annotated[Choice, Meta(description="when it has stopped before the fence")] = "warn"
    max_distance: Annotated[float, _meta(0, 100_000, "m", "fence about home; 0: there is none")] = 0.0
    stuck_time: Annotated[float, _meta(0.5, 60, "s", "wheels held fast, or turning in vain, until it counts as stuck")] = 4.0
    tilt_max: Annotated[float, _meta(0.1, 1.5, "rad", "from upright, that no ramp has")] = 0.6
    scan_timeout: Annotated[float, _meta(0.3, 60, "s", "without a new scan, after which nothing drives by itself")] = 1.0
    map_timeout: Annotated[float, _meta(1, 300, "s", "without a word of the mapping, the same")] = 5.0
    battery_low: Annotated[float, _meta(0, 0.9, "", "charge that is low")] = 0.2
    battery_critical: Annotated[float, _meta(0, 0.9, "", "charge that is critical")] = 0.07
    low_action: Annotated[Choice, Meta(description="when the battery is low")] = "return"
    critical_action: Annotated[Choice, Meta(description="when the battery is critical; off: disarmed where it stands")] = "off"
    emergency_charge: Annotated[float, _meta(0, 0.9, "", "charge that is an emergency")] = 0.05
    emergency_action: Annotated[Choice, Meta(description="when it is")] = "off"
