"""THE TABLE of the failsafes of an aircraft: causes, conditions, actions, words. docs/reference/failsafes.md shows it."""

from collections.abc import Callable
from dataclasses import dataclass
from math import inf

from schemas.messages import Event
from services.autopilot.failsafes import ACTIONS, Action, Rule
from uvf.models.vehicle.flight_params import AirParams

GNSS_LOST = 2.0  # s without a fix
GNSS_HOLD = 5.0  # s without a fix, after which the aircraft holds
PITCH_SHARE = 0.7  # of attitude_max
CALMER = 0.85  # of a limit, where what was beyond it counts as back
RECHARGED = 0.03  # of charge, beyond a limit


@dataclass(frozen=True, slots=True)
class Known:
    """What the rules look at."""

    params: AirParams
    airborne: bool = True
    silence: float = 0.0  # s since a ground station was heard; 0 while none ever was
    let_go: bool = False  # a mode is flown by hand, and by nobody any more
    unfixed: float = 0.0  # s since the last fix
    sigma: float = 0.0  # m
    lost_for: float = 0.0  # s without a position that modes rely on, while nobody flies by hand
    has_air_data: bool = True
    pitot_gap: float = 0.0  # m/s, measured less expected airspeed, while the pitot pressure is not believed
    charge: float = 1.0  # 0..1
    spare: float = inf  # of charge, when home is reached
    fence: float = inf  # m, left of what is kept from the fence; negative: it has to turn away now
    breached: bool = False  # the fence
    fence_action: Action = Action.WARN
    stop: str = ""  # surface at its stop
    stopped_for: float = 0.0  # s
    roll: float = 0.0  # rad
    pitch: float = 0.0  # rad
    wind: float = 0.0  # m/s


def _tilt(k: Known) -> float:
    return max(abs(k.roll), abs(k.pitch) / PITCH_SHARE)


def _chosen(name: str) -> Callable[[Known], Action]:
    return lambda k: ACTIONS[getattr(k.params, name)]


AIR_RULES: tuple[Rule[Known], ...] = (
    Rule(
        "link",
        wrong=lambda k: k.airborne and k.silence > k.params.link_timeout,
        mended=lambda k: k.silence <= k.params.link_timeout,
        begins="ground station lost",
        ends="ground station back",
        figures=lambda k: f"silent for {k.silence:.0f} s",
        action=_chosen("link_action"),
        parameters=("link_timeout", "link_action"),
    ),
    Rule(
        "sticks",
        wrong=lambda k: k.airborne and k.let_go,
        mended=lambda k: not k.let_go,
        begins="manual control lost",
        ends="manual control back, or another mode",
        figures=lambda k: f"no command for {k.params.stick_timeout:g} s",
        action=_chosen("stick_action"),
        parameters=("stick_timeout", "stick_action"),
    ),
    Rule(
        "gnss",
        wrong=lambda k: k.unfixed > GNSS_LOST,
        mended=lambda k: k.unfixed <= GNSS_LOST,
        begins="GNSS lost: dead reckoning",
        ends="GNSS back",
        figures=lambda k: f"no fix for {k.unfixed:.1f} s",
        severity=Event.CRITICAL,
        does="flies on by dead reckoning; after 5 s Hold, and modes that need a position are refused until it is back",
    ),
    Rule(
        "estimator",
        wrong=lambda k: k.sigma > k.params.sigma_max,
        mended=lambda k: k.sigma < CALMER * k.params.sigma_max,
        begins="position is not relied on",
        ends="position is relied on again",
        figures=lambda k: f"known to {k.sigma:.0f} m only",
        action=lambda k: Action.HOLD,
        after=lambda k: 1.0,
        clears=1.0,
        severity=Event.CRITICAL,
        parameters=("sigma_max",),
    ),
    Rule(
        "position",
        wrong=lambda k: k.airborne and k.lost_for > k.params.gnss_time,
        mended=lambda k: k.lost_for == 0.0,
        begins="without a position for long",
        ends="with a position again",
        figures=lambda k: f"dead reckoning for {k.lost_for:.0f} s, good to {k.sigma:.0f} m",
        action=_chosen("gnss_action"),
        severity=Event.CRITICAL,
        parameters=("gnss_time", "gnss_action"),
        does="comes down where it is, into the wind; Hold as soon as the position is back",
    ),
    Rule(
        "air_data",
        wrong=lambda k: not k.has_air_data,
        mended=lambda k: k.has_air_data,
        begins="air data lost: airspeed and height from GNSS, else throttle and pitch at trim",
        ends="air data back",
        figures=lambda k: "silent, frozen or no numbers",
        severity=Event.CRITICAL,
        does="airspeed from ground speed less wind, height from GNSS",
    ),
    Rule(
        "airspeed",
        wrong=lambda k: k.pitot_gap != 0.0,
        mended=lambda k: k.pitot_gap == 0.0,
        begins="airspeed sensor failed: airspeed from ground speed and wind",
        ends="airspeed sensor back",
        figures=lambda k: f"reads {abs(k.pitot_gap):.0f} m/s too {'much' if k.pitot_gap > 0 else 'little'}",
        severity=Event.CRITICAL,
        parameters=("airspeed_gap",),
        does="airspeed from ground speed less the wind of before, until the sensor agrees with it for 5 s",
    ),
    Rule(
        "battery_low",
        wrong=lambda k: k.charge < k.params.battery_low or k.spare < k.params.battery_critical,
        mended=lambda k: k.charge > k.params.battery_low + RECHARGED and k.spare > k.params.battery_critical + RECHARGED,
        begins="battery low",
        ends="battery no longer low",
        figures=lambda k: f"{100 * k.charge:.0f} % left" + (f", {100 * k.spare:.0f} % at home" if k.spare < inf else ""),
        action=_chosen("low_action"),
        after=lambda k: 3.0,
        clears=3.0,
        parameters=("battery_low", "battery_critical", "low_action"),
    ),
    Rule(
        "battery_critical",
        wrong=lambda k: k.charge < k.params.battery_critical,
        mended=lambda k: k.charge > k.params.battery_critical + RECHARGED,
        begins="battery critical",
        ends="battery no longer critical",
        figures=lambda k: f"{100 * k.charge:.0f} % left",
        action=_chosen("critical_action"),
        after=lambda k: 3.0,
        clears=3.0,
        severity=Event.CRITICAL,
        parameters=("battery_critical", "critical_action"),
    ),
    Rule(
        "battery_emergency",
        wrong=lambda k: k.charge < k.params.emergency_charge,
        mended=lambda k: k.charge > k.params.emergency_charge + RECHARGED,
        begins="battery emergency",
        ends="battery emergency over",
        figures=lambda k: f"{100 * k.charge:.0f} % left",
        action=_chosen("emergency_action"),
        after=lambda k: 3.0,
        clears=3.0,
        severity=Event.CRITICAL,
        parameters=("emergency_charge", "emergency_action"),
    ),
    Rule(
        "fence",
        wrong=lambda k: k.airborne and k.fence < 0,
        mended=lambda k: k.fence > 0,
        begins="fence ahead: turned away",
        ends="clear of the fence",
        figures=lambda k: f"{max(-k.fence, 0.0):.0f} m nearer than it may come, were it turned now",
        action=lambda k: k.fence_action,
        clears=2.0,
        parameters=("max_distance", "max_height", "fence_margin", "fence_height", "fence_action"),
        does="it is turned round in time, whatever the mode",
    ),
    Rule(
        "breach",
        wrong=lambda k: k.airborne and k.breached,
        mended=lambda k: not k.breached,
        begins="outside of the fence",
        ends="inside of the fence",
        figures=lambda k: "it is not where it may be",
        action=lambda k: k.fence_action,
        clears=1.0,
        severity=Event.CRITICAL,
        parameters=("fence_action",),
        does="it is turned back in",
    ),
    Rule(
        "saturation",
        wrong=lambda k: k.stopped_for > k.params.saturation_time,
        mended=lambda k: k.stopped_for == 0.0,
        begins="surface at its stop: it banks and climbs less",
        ends="surfaces free again",
        figures=lambda k: f"{k.stop} for {k.stopped_for:.0f} s",
        clears=5.0,
        parameters=("saturation_time",),
        does="half the bank and half the climb",
    ),
    Rule(
        "attitude",
        wrong=lambda k: k.airborne and _tilt(k) > k.params.attitude_max,
        mended=lambda k: _tilt(k) < CALMER * k.params.attitude_max,
        begins="attitude beyond limits",
        ends="attitude within limits",
        figures=lambda k: f"roll {k.roll:.1f} rad, pitch {k.pitch:.1f} rad",
        action=_chosen("attitude_action"),
        after=lambda k: 0.5,
        clears=1.0,
        severity=Event.CRITICAL,
        parameters=("attitude_max", "attitude_action"),
    ),
    Rule(
        "wind",
        wrong=lambda k: k.airborne and k.wind > k.params.wind_max * k.params.trim_airspeed,
        mended=lambda k: k.wind < CALMER * k.params.wind_max * k.params.trim_airspeed,
        begins="wind too strong",
        ends="wind has slackened",
        figures=lambda k: f"{k.wind:.0f} m/s",
        action=_chosen("wind_action"),
        after=lambda k: 10.0,
        clears=30.0,
        parameters=("wind_max", "wind_action"),
    ),
)
