"""THE TABLE of the failsafes of an aircraft: causes, conditions, actions, words. docs/reference/failsafes.md shows it."""

from collections.abc import Callable
from dataclasses import dataclass
from math import inf

from schemas.messages import Event
from services.autopilot.failsafes import ACTIONS, FailsafeAction, FailsafeRule
from uvf.models.vehicle.flight_params import AirParams

GNSS_LOST = 2.0  # s without a fix
GNSS_HOLD = 5.0  # s without a fix, after which the aircraft holds
PITCH_SHARE = 0.7  # of attitude_max
CALMER = 0.85  # of a limit, where what was beyond it counts as back
RECHARGED = 0.03  # of charge, beyond a limit


@dataclass(frozen=True, slots=True)
class FailsafeInputs:
    """What the rules look at."""

    params: AirParams
    airborne: bool = True
    silence: float = 0.0  # s since a ground station was heard; 0 while none ever was
    stick_released: bool = False  # a mode is flown by hand, and by nobody any more
    gnss_age: float = 0.0  # s since the last fix
    sigma: float = 0.0  # m
    lost_for: float = 0.0  # s without a position that modes rely on, while nobody flies by hand
    has_air_data: bool = True
    pitot_gap: float = 0.0  # m/s, measured less expected airspeed, while the pitot pressure is not believed
    charge: float = 1.0  # 0..1
    spare: float = inf  # of charge, when home is reached
    fence: float = inf  # m, left of what is kept from the fence; negative: it has to turn away now
    breached: bool = False  # the fence
    fence_action: FailsafeAction = FailsafeAction.WARN
    stop: str = ""  # surface at its stop
    stopped_for: float = 0.0  # s
    roll: float = 0.0  # rad
    pitch: float = 0.0  # rad
    lands: bool = False  # it is landing already
    wind: float = 0.0  # m/s


def _tilt(k: FailsafeInputs) -> float:
    return max(abs(k.roll), abs(k.pitch) / PITCH_SHARE)


def _chosen(name: str) -> Callable[[FailsafeInputs], FailsafeAction]:
    return lambda k: ACTIONS[getattr(k.params, name)]


AIR_RULES: tuple[FailsafeRule[FailsafeInputs], ...] = (
    FailsafeRule(
        "link",
        trigger=lambda k: k.airborne and k.silence > k.params.link_timeout,
        clear=lambda k: k.silence <= k.params.link_timeout,
        raised_text="ground station lost",
        cleared_text="ground station back",
        detail=lambda k: f"silent for {k.silence:.0f} s",
        action=_chosen("link_action"),
        parameters=("link_timeout", "link_action"),
    ),
    FailsafeRule(
        "sticks",
        trigger=lambda k: k.airborne and k.stick_released,
        clear=lambda k: not k.stick_released,
        raised_text="manual control lost",
        cleared_text="manual control back, or another mode",
        detail=lambda k: f"no command for {k.params.stick_timeout:g} s",
        action=_chosen("stick_action"),
        parameters=("stick_timeout", "stick_action"),
    ),
    FailsafeRule(
        "gnss",
        trigger=lambda k: k.gnss_age > GNSS_LOST,
        clear=lambda k: k.gnss_age <= GNSS_LOST,
        raised_text="GNSS lost: dead reckoning",
        cleared_text="GNSS back",
        detail=lambda k: f"no fix for {k.gnss_age:.1f} s",
        severity=Event.CRITICAL,
        does="flies on by dead reckoning; after 5 s Hold, and modes that need a position are refused until it is back",
    ),
    FailsafeRule(
        "estimator",
        trigger=lambda k: k.sigma > k.params.sigma_max,
        clear=lambda k: k.sigma < CALMER * k.params.sigma_max,
        raised_text="position is not relied on",
        cleared_text="position is relied on again",
        detail=lambda k: f"known to {k.sigma:.0f} m only",
        action=lambda k: FailsafeAction.HOLD,
        after=lambda k: 1.0,
        clear_delay=1.0,
        severity=Event.CRITICAL,
        parameters=("sigma_max",),
    ),
    FailsafeRule(
        "position",
        trigger=lambda k: k.airborne and k.lost_for > k.params.gnss_time,
        clear=lambda k: k.lost_for == 0.0,
        raised_text="without a position for long",
        cleared_text="with a position again",
        detail=lambda k: f"dead reckoning for {k.lost_for:.0f} s, good to {k.sigma:.0f} m",
        action=_chosen("gnss_action"),
        severity=Event.CRITICAL,
        parameters=("gnss_time", "gnss_action"),
        does="comes down where it is, into the wind; Hold as soon as the position is back",
    ),
    FailsafeRule(
        "air_data",
        trigger=lambda k: not k.has_air_data,
        clear=lambda k: k.has_air_data,
        raised_text="air data lost: airspeed and height from GNSS, else throttle and pitch at trim",
        cleared_text="air data back",
        detail=lambda k: "silent, frozen or no numbers",
        severity=Event.CRITICAL,
        does="airspeed from ground speed less wind, height from GNSS",
    ),
    FailsafeRule(
        "airspeed",
        trigger=lambda k: k.pitot_gap != 0.0,
        clear=lambda k: k.pitot_gap == 0.0,
        raised_text="airspeed sensor failed: airspeed from ground speed and wind",
        cleared_text="airspeed sensor back",
        detail=lambda k: f"reads {abs(k.pitot_gap):.0f} m/s too {'much' if k.pitot_gap > 0 else 'little'}",
        severity=Event.CRITICAL,
        parameters=("airspeed_gap",),
        does="airspeed from ground speed less the wind of before, until the sensor agrees with it for 5 s",
    ),
    FailsafeRule(
        "battery_low",
        trigger=lambda k: k.charge < k.params.battery_low or k.spare < k.params.battery_critical,
        clear=lambda k: k.charge > k.params.battery_low + RECHARGED and k.spare > k.params.battery_critical + RECHARGED,
        raised_text="battery low",
        cleared_text="battery no longer low",
        detail=lambda k: f"{100 * k.charge:.0f} % left" + (f", {100 * k.spare:.0f} % at home" if k.spare < inf else ""),
        action=_chosen("low_action"),
        after=lambda k: 3.0,
        clear_delay=3.0,
        parameters=("battery_low", "battery_critical", "low_action"),
    ),
    FailsafeRule(
        "battery_critical",
        trigger=lambda k: k.charge < k.params.battery_critical,
        clear=lambda k: k.charge > k.params.battery_critical + RECHARGED,
        raised_text="battery critical",
        cleared_text="battery no longer critical",
        detail=lambda k: f"{100 * k.charge:.0f} % left",
        action=_chosen("critical_action"),
        after=lambda k: 3.0,
        clear_delay=3.0,
        severity=Event.CRITICAL,
        parameters=("battery_critical", "critical_action"),
    ),
    FailsafeRule(
        "battery_emergency",
        trigger=lambda k: k.charge < k.params.emergency_charge,
        clear=lambda k: k.charge > k.params.emergency_charge + RECHARGED,
        raised_text="battery emergency",
        cleared_text="battery emergency over",
        detail=lambda k: f"{100 * k.charge:.0f} % left",
        action=_chosen("emergency_action"),
        after=lambda k: 3.0,
        clear_delay=3.0,
        severity=Event.CRITICAL,
        parameters=("emergency_charge", "emergency_action"),
    ),
    FailsafeRule(
        "fence",
        trigger=lambda k: k.airborne and k.fence < 0,
        clear=lambda k: k.fence > 0,
        raised_text="fence ahead: turned away",
        cleared_text="clear of the fence",
        detail=lambda k: f"{max(-k.fence, 0.0):.0f} m nearer than it may come, were it turned now",
        action=lambda k: k.fence_action,
        clear_delay=2.0,
        parameters=("max_distance", "max_height", "fence_margin", "fence_height", "fence_action"),
        does="it is turned round in time, whatever the mode",
    ),
    FailsafeRule(
        "breach",
        trigger=lambda k: k.airborne and k.breached,
        clear=lambda k: not k.breached,
        raised_text="outside of the fence",
        cleared_text="inside of the fence",
        detail=lambda k: "it is not where it may be",
        action=lambda k: k.fence_action,
        clear_delay=1.0,
        severity=Event.CRITICAL,
        parameters=("fence_action",),
        does="it is turned back in",
    ),
    FailsafeRule(
        "saturation",
        trigger=lambda k: k.stopped_for > k.params.saturation_time,
        clear=lambda k: k.stopped_for == 0.0,
        raised_text="surface at its stop: it banks and climbs less",
        cleared_text="surfaces free again",
        detail=lambda k: f"{k.stop} for {k.stopped_for:.0f} s",
        clear_delay=5.0,
        parameters=("saturation_time",),
        does="half the bank of the corners to come, half the climb and the descent",
    ),
    FailsafeRule(
        "attitude",
        trigger=lambda k: k.airborne and _tilt(k) > k.params.attitude_max,
        clear=lambda k: _tilt(k) < CALMER * k.params.attitude_max,
        raised_text="attitude beyond limits",
        cleared_text="attitude within limits",
        detail=lambda k: f"roll {k.roll:.1f} rad, pitch {k.pitch:.1f} rad",
        action=_chosen("attitude_action"),
        after=lambda k: 0.5,
        clear_delay=1.0,
        severity=Event.CRITICAL,
        parameters=("attitude_max", "attitude_action"),
    ),
    FailsafeRule(
        "wind",
        trigger=lambda k: k.airborne and k.wind > k.params.wind_max * k.params.trim_airspeed,
        clear=lambda k: k.wind < CALMER * k.params.wind_max * k.params.trim_airspeed,
        raised_text="wind too strong",
        cleared_text="wind has slackened",
        detail=lambda k: f"{k.wind:.0f} m/s",
        action=lambda k: FailsafeAction.WARN if k.lands else ACTIONS[k.params.wind_action],
        after=lambda k: 10.0,
        clear_delay=30.0,
        parameters=("wind_max", "wind_action"),
    ),
)
