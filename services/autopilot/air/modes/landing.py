"""Landing: down a circle, along the glide slope into the wind, flare, decrab, roll-out; or round again.

Heights are those of the wheels over the strip. The path of the flare is laid over the ground: from the slope a parabola leads to the
sink rate of touching down a little before where the wheels are meant to touch, whatever the wind.
"""

import math
from collections.abc import Callable
from dataclasses import replace
from enum import Enum, auto

from services.autopilot.air.setpoints import FlightContext, FlightPhase, PathSetpoint, Setpoint
from uvf.control.commands import AttitudeSetpoint
from uvf.control.cycle import Cycle, clip
from uvf.control.ground_roll import Gyros, held, rolling, rudder_along
from uvf.control.total_energy import climb_at
from uvf.estimation.state import Estimate
from uvf.estimation.wheel_height import WheelHeight
from uvf.guidance.approach import Approach
from uvf.guidance.route import Circle, Place
from uvf.guidance.runways import Runway
from uvf.guidance.vector_field import line_reference
from uvf.maths.atmosphere import STRIP_ROUGHNESS, logarithmic, power
from uvf.maths.filters import RunningMean
from uvf.maths.geodesy import GRAVITY
from uvf.models.vehicle.flight_params import AirParams

FINAL_TIME = 25.0  # s at the lowest airspeed: the length of the final approach
ON_CIRCLE = 5.0  # m of height, with which it may be left
MOST_TAILWIND = 1.5  # m/s, with which it lands
WIND_TIME, WIND_KNOWN = 60.0, 10.0  # s, of the mean wind by which the lane is chosen, and that the first estimate counts for
GROUND_WIND, SHEAR = 10.0, 1 / 7  # m, at which a wind at the ground is given; exponent
EASED = 0.9  # of crosswind_max, from which on it lands that has waited for less
ALIGNED = 0.3  # rad, of the course on leaving the circle
GUST_SHARE, GUST_MOST = 0.4, 0.2  # of the wind, of min_airspeed: what is added to it on the approach
COMMITTED = 12.0  # m: below it, without satellites, it is landed by dead reckoning
GATE = 10.0, 2.0  # m of height, between which the approach has to be a stable one
SHEAR_AHEAD = 0.5  # s, in which pitch and throttle make up for airspeed that is lost
TOO_HIGH, TOO_FAST = 3.0, 7.0  # m, m/s
FLARE_TIME = 3.0  # s
LEAD = 0.5  # s, by which the sink asked for is ahead of the path: the climb follows that much later
EARLY, GUSTY = 0.4, 8.0  # s, by which the path ends before the point to touch at in that much wind [m/s]: lifted by gusts it floats on
TOUCH_SINK = 0.4  # m/s
TOUCH_SPEED, SLOWS_BELOW = 0.96, 3.0  # of min_airspeed; m
DECRAB_BELOW = 0.7  # m
CRAB_LEFT = 0.1  # rad, that the wheels take
LOW, LOW_BANK, TOUCH_BANK = 3.0, 0.17, 0.06  # m, rad: the wing tips come near to the ground
MOST_SINK, SINK_PER_M = 0.6, 0.4  # m/s, 1/s: to come down onto the path of the flare, by the height
NOSE_UP_BELOW, NOSE_GIVES = 1.0, 0.04  # m, rad
LATE_PER_M, MOST_LATE = 0.04, 0.4  # 1/s, m/s
LIFTS_BELOW = 8.0  # m; from here on the flaps make lift at once
LIFT_P, LIFT_A = 4.0, 2.0  # 1/s, per climb rate that is wanting; per lift that is not felt
TOUCHED, STUCK, STILL = 0.12, 0.15, 0.2  # m; m/s less sink than asked for; m/s
FEELS_BELOW = 0.7  # m; without a range finder it goes on sinking from here on, wherever the ground is
IDLES_BELOW = 0.5  # m
BOUNCED, FLIES = 0.3, 0.75  # m over the ground, of min_airspeed: it has bounced, or a gust has lifted it, and it flares once more
LOOSE = 0.5  # of min_airspeed, below which surfaces hold no attitude
TOUCH_TIME, STUCK_TIME = 0.08, 0.5  # s
LOWERS = 1.0  # s after touching, in which the nose comes down: let go of at once, it falls, and a bounce ends on it
BRAKES_AFTER, BRAKE = 0.8, 0.6  # s
STOPPED, STANDS = 0.7, 1.5  # m/s, s


class LandingStage(Enum):
    """Stages of a landing, in the order in which they are flown; AROUND leads back to the first."""

    CIRCLE = auto()
    FINAL = auto()
    ROLL = auto()
    AROUND = auto()


class LandingMode(FlightPhase):
    """On a lane, which is chosen again as long as the wind is found out on the circle. ``around`` asks for another approach."""

    def __init__(
        self,
        now: Estimate,
        choose: Callable[[Estimate], Runway],
        context: FlightContext,
        params: AirParams,
        approach: Approach | None = None,
    ) -> None:
        self.lane = choose(now)
        self._approach = approach
        self._choose = choose
        self.told = ""
        """What is new: why it goes around or waits, until it has been read."""
        self._waits = False
        self._senses = context
        self._length = FINAL_TIME * params.min_airspeed if approach is None else approach.length
        self._wheels = WheelHeight(self.lane.aim.height)
        self._since = 0.0
        self._gyros, self._touched_at = Gyros(now), 0.0
        slow = now.airspeed < 0.6 * params.min_airspeed  # started anew while it rolls out
        self._wind = [RunningMean(WIND_TIME, wind, WIND_KNOWN) for wind in (now.wind_north, now.wind_east)]
        self._stage = LandingStage.ROLL if slow else LandingStage.CIRCLE
        self._circle = self._new_circle(now, params)
        self._still = 0.0
        self._low = False

    @property
    def circle(self) -> Circle | None:
        """The circle that is flown before the approach; None on it."""
        return self._circle if self._stage is LandingStage.CIRCLE else None

    @property
    def rolls(self) -> bool:
        """The wheels carry it: nothing but the end of the landing can follow."""
        return self._stage is LandingStage.ROLL

    @property
    def committed(self) -> bool:
        """Too near to the ground to be turned away without a position."""
        return self._stage is LandingStage.ROLL or (self._stage is LandingStage.FINAL and self._low)

    def around(self, why: str) -> None:
        """Goes around; ``why`` is told."""
        if not self.rolls:
            self.told = f"go-around: {why}"
            self._to(LandingStage.AROUND)

    def step(self, now: Estimate, params: AirParams, dt: float) -> Setpoint:
        """Setpoint of this cycle of ``dt`` [s], from the circle over the approach and the flare to the end of the roll."""
        self._since += dt
        for mean, wind in zip(self._wind, (now.wind_north, now.wind_east), strict=True):
            mean.step(wind, dt)
        if self._stage is LandingStage.CIRCLE:
            return self._descend(now, params)
        if self._stage is LandingStage.FINAL:
            return self._final(now, params, dt)
        return self._roll(now, params, dt) if self._stage is LandingStage.ROLL else self._go_around(now, params)

    def _to(self, stage: LandingStage) -> None:
        self._stage, self._since, self._still = stage, 0.0, 0.0

    def _new_circle(self, now: Estimate, params: AirParams) -> Circle:
        """Round into the beginning of the final approach: the mission's, or one beside the lane on the aircraft's side."""
        _, right = self.lane.locate(now)
        laid = self._approach
        radius = laid.radius if laid is not None and laid.radius else math.copysign(params.hold_radius, right)
        north, east = self.lane.before(self._length, radius)
        own = self.lane.aim.height + params.gear_height + self._slope(params) * self._length
        return Circle(Place(north, east, laid.height if laid is not None else own), radius)

    def _slope(self, params: AirParams) -> float:
        """As steep as a mission's approach has to be; one that is flatter is flown level until the slope is met."""
        own = math.tan(params.glide_slope)
        return own if self._approach is None else max(own, self._approach.slope)

    def _path(self, distance: float, ground_speed: float, params: AirParams) -> tuple[float, float, bool]:
        """As ``flare``, but nowhere above the height at which a mission's approach begins."""
        height, slope, flares = flare(distance, ground_speed, self._slope(params))
        top = math.inf if self._approach is None else self._approach.height - self.lane.aim.height - params.gear_height
        return (height, slope, flares) if height < top else (top, 0.0, False)

    def _descend(self, now: Estimate, params: AirParams) -> Setpoint:
        north, east = (mean.value for mean in self._wind)
        mean = replace(now, wind_north=north, wind_east=east)  # for the lane, which turbulence would turn this way and that
        if self.lane.tailwind(mean) > MOST_TAILWIND and (other := self._choose(mean)) != self.lane:
            self.lane = other
            self._circle = self._new_circle(now, params)
        circle = self._circle
        distance, right = self.lane.locate(now)
        lead = abs(distance - self._length) < 0.4 * abs(circle.radius) and abs(right) < 0.2 * abs(circle.radius)
        at_exit = lead and abs(self.lane.off(now.course)) < ALIGNED and abs(now.height - circle.centre.height) < ON_CIRCLE
        if at_exit and not self._is_windy(now, params):
            self._to(LandingStage.FINAL)
        near = now.height < circle.centre.height + 2 * ON_CIRCLE and circle.is_captured(now)  # slow, it could not turn in
        airspeed = self._airspeed(now, params) if near else params.trim_airspeed
        return Setpoint(PathSetpoint(circle.aim(now, params), circle.centre.height, 0.0, airspeed), params.land_flap if near else 0.0)

    def _is_windy(self, now: Estimate, params: AirParams) -> bool:
        """Whether it stays on the circle, because more wind blows across the lane than it may be landed in.

        Near the ground there is less of it than on the circle: by a power of the height, as over open country.
        """
        height = max(now.height - self.lane.aim.height, GROUND_WIND)
        across = abs(self.lane.crosswind(now)) / power(height, SHEAR, GROUND_WIND)
        windy = not self._senses.must_land and across > params.crosswind_max * (EASED if self._waits else 1.0)
        if windy and not self._waits:
            self.told = f"it waits on the circle: {across:.1f} m/s of crosswind, crosswind_max is {params.crosswind_max:g} m/s"
        elif self._waits and not windy:
            self.told = f"it lands: {across:.1f} m/s of crosswind"
        self._waits = windy
        return windy

    def _final(self, now: Estimate, params: AirParams, dt: float) -> Setpoint:
        distance, right = self.lane.locate(now)
        wheels = self._wheels
        wheels.step(now, self._senses.clearance, distance, params, dt)
        self._low = wheels.height < COMMITTED
        ahead = distance - EARLY * min(math.hypot(now.wind_north, now.wind_east) / GUSTY, 1.0) * now.ground_speed
        wanted, _, flares = self._path(ahead, now.ground_speed, params)
        _, slope, _ = self._path(ahead - LEAD * now.ground_speed, now.ground_speed, params)
        fast, lost = self._airspeed(now, params), self._shear(now, params) if flares else 0.0
        if why := self._unstable(now, wheels.height, wheels.height - wanted, right, fast):
            self.around(why)
        climb = -slope * now.ground_speed + (params.flare_p if flares else params.altitude_p) * (wanted - wheels.height)
        if flares:
            climb = max(climb, -MOST_SINK - late(distance) - SINK_PER_M * max(wheels.height, 0.0))
            if self._senses.clearance is None and wheels.height < FEELS_BELOW:
                climb = min(climb, -TOUCH_SINK)
        climb += now.climb - wheels.climb  # as the estimate has it
        if flares and self._has_touched(now, climb, dt):
            self._gyros, self._touched_at = Gyros(now), max(now.pitch, nose_up(now, params))
            wheels.touched(now, params)
            self._to(LandingStage.ROLL)
        raised = climb + higher_by(now, lost, params)  # of flaps and throttle, too: by pitch alone it overshoots, and balloons
        lift = self._lift(now, raised) if wheels.height < LIFTS_BELOW else 0.0
        return Setpoint(self._down(now, params, distance, raised, fast + lost), params.land_flap, lift=lift, firm=True)

    def _down(self, now: Estimate, params: AirParams, distance: float, climb: float, airspeed: float) -> PathSetpoint:
        """Along the lane; near the ground wings about level, then the nose along the strip and the throttle closing."""
        height = self._wheels.height
        aim = line_reference(self.lane.along, self.lane.before(0.0), (now.north, now.east), params)
        rudder = self._decrab(now) if height < DECRAB_BELOW else None
        throttle = touch_throttle(now, params, climb, airspeed, height) if height < IDLES_BELOW else None
        bank = TOUCH_BANK + (LOW_BANK - TOUCH_BANK) * max(height, 0.0) / LOW if height < LOW else None
        faster = 0.0 if params.gear == "tail_wheel" else late(distance)  # its propeller is near to the ground
        lowest = nose_up(now, params, faster) if height < NOSE_UP_BELOW else -math.inf
        return PathSetpoint(aim, None, climb, airspeed, bank, throttle, rudder, lowest)

    def _lift(self, now: Estimate, climb: float) -> float:
        """m/s^2 that are wanting: by the climb, and by the lift that is felt, which tells of a gust before it has moved anything."""
        return LIFT_P * (climb - now.climb) + LIFT_A * (GRAVITY - self._senses.specific_force_up)

    def _shear(self, now: Estimate, params: AirParams) -> float:
        """m/s of headwind that it will have sunk out of before pitch and throttle have answered, no more than gusts are allowed for."""
        height = max(self._wheels.height, 0.0) + params.gear_height
        below = max(height - max(-now.climb, TOUCH_SINK) * SHEAR_AHEAD, params.gear_height)
        here, there = (logarithmic(h, STRIP_ROUGHNESS, GROUND_WIND) for h in (height, below))
        if here <= 0:
            return 0.0
        return min(max(-self.lane.tailwind(now), 0.0) * (1 - there / here), GUST_MOST * params.min_airspeed)

    def _airspeed(self, now: Estimate, params: AirParams) -> float:
        wind = math.hypot(now.wind_north, now.wind_east)
        return params.min_airspeed + min(GUST_SHARE * wind, GUST_MOST * params.min_airspeed)

    def _unstable(self, now: Estimate, height: float, above: float, right: float, airspeed: float) -> str:
        """Why this approach is given up; empty while it is good."""
        distance, _ = self.lane.locate(now)
        if -distance > self.lane.rest / 2:
            return "half of the strip passed without touching"
        if not GATE[1] < height < GATE[0]:
            return ""
        if abs(above) > TOO_HIGH:
            return f"{abs(above):.1f} m too {'high' if above > 0 else 'low'}"
        if abs(right) > self.lane.width / 2:
            return f"{abs(right):.1f} m aside"
        return f"{now.airspeed - airspeed:.1f} m/s too fast" if now.airspeed > airspeed + TOO_FAST else ""

    def _decrab(self, now: Estimate) -> float:
        """rad of rudder that turns the nose along the strip but for what the wheels take."""
        off = self.lane.off(now.yaw)
        return rudder_along(now, self.lane.course + clip(off, CRAB_LEFT), 0.0)

    def _has_touched(self, now: Estimate, climb: float, dt: float) -> bool:
        """Seen by the range finder; or it neither sinks, although it should, nor moves up and down with the air."""
        seen, stuck = self._senses.clearance, now.climb > climb + STUCK and abs(now.climb) < STILL
        near, limit = (seen < TOUCHED, TOUCH_TIME) if seen is not None else (stuck, STUCK_TIME)
        self._still = self._still + dt if near else 0.0
        return self._still > limit

    def _roll(self, now: Estimate, params: AirParams, dt: float) -> Setpoint:
        _, right = self.lane.locate(now)
        level = self._gyros.step(now, dt)
        stands = now.ground_speed < STOPPED or not self._senses.airborne
        self._still = self._still + dt if stands else 0.0
        if self._still > STANDS:
            self.ended, self.disarms = "landed", True
        rudder = rudder_along(level, self.lane.course, right)
        lifted = self._senses.clearance
        lifted = self._wheels.over_touch(now, params) if lifted is None else lifted
        if lifted > BOUNCED and now.airspeed > FLIES * params.min_airspeed:
            self._to(LandingStage.FINAL)
        if params.gear != "tail_wheel" and self._since < LOWERS and now.airspeed > LOOSE * params.min_airspeed:
            nose = AttitudeSetpoint(0.0, self._touched_at * (1 - self._since / LOWERS), 0.0, rudder)
            return Setpoint(held(now, level, nose), firm=True)
        return Setpoint(rolling(level, params, rudder, 0.0, BRAKE if self._since > BRAKES_AFTER else 0.0))

    def _go_around(self, now: Estimate, params: AirParams) -> Setpoint:
        circle = self._circle.centre.height
        if now.height > circle - ON_CIRCLE:
            self._circle = self._new_circle(now, params)
            self._to(LandingStage.CIRCLE)
        aim = line_reference(self.lane.along, self.lane.before(0.0), (now.north, now.east), params)
        low = now.height < self.lane.aim.height + LOW
        return Setpoint(
            PathSetpoint(aim, None, climb_at(now, params), params.trim_airspeed, bank_limit=LOW_BANK if low else None, throttle=1.0)
        )


def flare(distance: float, ground_speed: float, slope: float) -> tuple[float, float, bool]:
    """Height [m] and slope of the path ``distance`` [m] before the point to touch at, and whether it has left the straight one."""
    speed = max(ground_speed, 5.0)
    touching = min(TOUCH_SINK / speed, slope)
    begins = FLARE_TIME * speed
    bend = (slope - touching) / (2 * begins)
    if distance > begins:
        return touching * begins + bend * begins**2 + slope * (distance - begins), slope, False
    on = max(distance, 0.0)
    return touching * distance + bend * on**2, touching + 2 * bend * on, True


def late(distance: float) -> float:
    """m/s of sink beyond the usual, when gusts have carried it on, ``distance`` [m] before the point to touch at, or negative: behind."""
    return min(LATE_PER_M * max(-distance, 0.0), MOST_LATE)


def nose_up(now: Estimate, params: AirParams, faster: float = 0.0) -> float:
    """Pitch [rad] below which the nose is not lowered over the strip, so that no wheel in front of the main ones touches first.

    It is that of a little more sink than when it touches, and of as much more as is asked for: ``faster`` [m/s]. A tail wheel leaves the
    propeller little room: with one it is level at least (CS 23.925 has a clearance in the level attitude).
    """
    cycle = Cycle(now, params, 0.0)
    lowest = cycle.alpha_with(1.0) - params.flap_alpha * params.land_flap - (TOUCH_SINK + faster) / cycle.speed - NOSE_GIVES
    return max(lowest, 0.0) if params.gear == "tail_wheel" else lowest


def higher_by(now: Estimate, lost: float, params: AirParams) -> float:
    """Climb rate [m/s] besides, by which pitch makes up for the lift that goes with ``lost`` airspeed [m/s], on final."""
    cycle = Cycle(now, params, 0.0)
    slower = max(1 - lost / cycle.speed, 0.5)
    return params.alpha_per_load * GRAVITY / cycle.eas**2 * (slower**-2 - 1) * cycle.speed / (1 + params.final_climb_p)


def touch_throttle(now: Estimate, params: AirParams, climb: float, airspeed: float, height: float) -> float:
    """Throttle, 0 to 1, from ``airspeed`` [m/s] of the approach to that of touching down, below the lowest one that the loops hold."""
    touching = TOUCH_SPEED * airspeed
    airspeed = touching + (airspeed - touching) * min(max(height / SLOWS_BELOW, 0.0), 1.0)
    ahead = params.trim_throttle + params.throttle_speed * (airspeed - params.trim_airspeed)
    faster = now.airspeed / GRAVITY * params.airspeed_p * (airspeed - now.airspeed)
    return min(max(ahead + params.throttle_climb * (climb + faster), 0.0), 1.0)
