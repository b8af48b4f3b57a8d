"""Parameters of the failsafes of an aircraft."""

from typing import Annotated, Literal

from msgspec import Meta

from uvf.models.params import Params


def _meta(low: float, high: float, unit: str, about: str) -> Meta:
    return Meta(ge=low, le=high, description=about, extra_json_schema={"unit": unit})


Choice = Literal["warn", "hold", "return", "land"]


class FailsafeParams(Params, frozen=True):
    """Names have at most 16 characters, the length of a MAVLink parameter."""

    link_timeout: Annotated[float, _meta(1, 300, "s", "silence of all ground stations until the link is lost")] = 5.0
    link_action: Annotated[Choice, Meta(description="when the link is lost")] = "return"
    stick_timeout: Annotated[float, _meta(0.2, 10, "s", "that a command by hand counts")] = 0.5
    stick_action: Annotated[
        Literal["wait", "hold", "return", "land"],
        Meta(description="when manual control is lost; wait: it circles until it is back"),
    ] = "hold"
    sigma_max: Annotated[float, _meta(1, 1000, "m", "uncertainty of the position from which it is not relied on")] = 50.0
    gnss_time: Annotated[float, _meta(10, 3600, "s", "circled by dead reckoning without a position until gnss_action")] = 120.0
    gnss_action: Annotated[Choice, Meta(description="then; land: down where it is, without a position")] = "land"
    airspeed_gap: Annotated[float, _meta(0.1, 1, "", "of trim_airspeed: measured against ground speed less wind")] = 0.25
    battery_low: Annotated[float, _meta(0, 0.9, "", "charge that is low")] = 0.15
    battery_critical: Annotated[float, _meta(0, 0.9, "", "critical charge, and the reserve that the flight home must leave")] = 0.07
    low_action: Annotated[Choice, Meta(description="when the battery is low, or only just takes it home")] = "return"
    critical_action: Annotated[Choice, Meta(description="when the battery is critical")] = "land"
    emergency_charge: Annotated[float, _meta(0, 0.9, "", "charge that is an emergency")] = 0.05
    emergency_action: Annotated[Choice, Meta(description="when it is")] = "land"
    fence_action: Annotated[
        Literal["plan", "warn", "hold", "return", "land"],
        Meta(description="at the fence; plan: what the fence itself says"),
    ] = "plan"
    max_distance: Annotated[float, _meta(0, 100_000, "m", "fence about home; 0: there is none")] = 0.0
    max_height: Annotated[float, _meta(0, 20_000, "m", "ceiling above home; 0: there is none")] = 0.0
    fence_margin: Annotated[float, _meta(0, 500, "m", "kept from the fence by turning away in time")] = 8.0
    fence_height: Annotated[float, _meta(0, 200, "m", "kept from the fence's floor and ceiling")] = 5.0
    wind_max: Annotated[float, _meta(0.1, 1.5, "", "of trim_airspeed: wind in which it does not stay out")] = 0.7
    wind_action: Annotated[Choice, Meta(description="when the wind is too strong")] = "return"
    attitude_max: Annotated[float, _meta(0.8, 3.2, "rad", "bank, and 0.7 of it in pitch, that nobody wants")] = 1.3
    attitude_action: Annotated[Choice, Meta(description="when the attitude is beyond it, by hand too")] = "hold"
    saturation_time: Annotated[float, _meta(0.5, 60, "s", "a surface at its stop until less is asked for")] = 2.0
