"""Which measurement corrects the filter when, and what happens to one that is refused."""

import math

import numpy as np

from uvf.estimation.ekf import observations
from uvf.estimation.ekf.alignment import attitude, heading
from uvf.estimation.ekf.datasheet import Datasheet
from uvf.estimation.ekf.delay import Delay
from uvf.estimation.ekf.filter import Filter, Observation
from uvf.estimation.ekf.gates import Every, Gate
from uvf.estimation.ekf.gusts import GustEstimate
from uvf.estimation.ekf.states import (
    BARO,
    DRIFT,
    IRON,
    MAGNETIC,
    POSITION,
    TILT,
    VELOCITY,
    WIND,
    YAW,
    Floats,
)
from uvf.estimation.sensor_inputs import GnssFix, InertialSample, Pressures
from uvf.estimation.state import Ratios
from uvf.maths import atmosphere

LEAST_POSITION, LEAST_SPEED = 0.1, 0.03  # m, m/s: no satellite fix is believed to be better
SEVERAL = 0.1  # s between measurements whose errors last longer than a sample
SLIP = 0.02  # rad of sideslip in coordinated flight
SLIP_TIME = 1.0  # s that it lasts
STANDING = 0.05  # m/s
UNKNOWN_BARO = 30.0  # m
UNKNOWN_IRON = 10.0  # uT
MEETING = 0.06  # rad of heading, below which the triangle tells the wind
LOST_YAW = 0.5  # rad, from where on a heading is set, not corrected
SET_YAW, SET_YAW_BY_COURSE = 0.1, 0.4  # rad
SUPPOSED_SPEED, SUPPOSED_CLIMB = 5.0, 3.0  # m/s, of what is supposed in place of a measurement, ten times a second
AHEAD = 5.0  # m/s, over ground, from where on the nose is about ahead


class Aiding:
    """Corrects ``filter`` by the sensors; the times ``t`` [s] of its calls are those of the newest IMU sample."""

    def __init__(self, filter_: Filter, sheet: Datasheet, earth: Floats) -> None:
        """earth: (3,) magnetic field, NED, in units of the filter; zero = there is none to go by."""
        self.filter = filter_
        self._sheet = sheet
        self._earth = earth
        self.delay = Delay()
        self.gusts = GustEstimate()
        self._position, self._velocity = Gate(3.0), Gate(3.0)
        self._depth, self._height = Gate(3.0), Gate(5.0)
        self._airspeed, self._slip, self._field = Gate(10.0), Gate(10.0), Gate(10.0)
        self._field_due, self._slip_due, self._rest_due, self._supposed_due = (Every(SEVERAL) for _ in range(4))
        self._read: tuple[float, float, float] | None = None
        self._baro_known = False
        self._wind_met, self._heard = False, False

    @property
    def ratios(self) -> Ratios:
        """Test ratios of the newest measurements."""
        height = max(self._depth.ratio, self._height.ratio)
        return Ratios(self._position.ratio, self._velocity.ratio, height, self._airspeed.ratio, self._slip.ratio, self._field.ratio)

    def fix(self, fix: GnssFix, acceleration: Floats, t: float, lag: float) -> None:
        """Corrects by a satellite fix, valid ``lag`` [s] before ``t`` [s]; acceleration: (3,) [m/s^2], NED."""
        sheet, state = self._sheet, self.filter.state
        v, p = self.delay.at(t - lag)
        sigma = _without(fix.position_sigma, sheet.drift)
        speed = np.array((fix.v_north, fix.v_east, -fix.v_up))
        place = np.array((fix.north, fix.east, -fix.height))
        seen = observations.velocity(speed - v, state, acceleration, lag, max(fix.speed_sigma, LEAST_SPEED))
        lost = self._velocity.exhausted(self._apply(seen), SEVERAL * 2)
        off = place - p - state.x[DRIFT]
        lost = self._position.exhausted(self._apply(observations.place(off[:2], lag, sigma)), SEVERAL * 2) or lost
        deep = observations.depth(float(off[2]), lag, _without(fix.height_sigma, sheet.height_drift))
        if self._depth.exhausted(self._apply(deep), SEVERAL * 2) or lost:
            self._begin_at(place + lag * speed, speed, fix, t)

    def _begin_at(self, place: Floats, speed: Floats, fix: GnssFix, t: float) -> None:
        """Satellites have contradicted the state for long: it is theirs from now on."""
        x = self.filter.state.x
        x[POSITION], x[VELOCITY], x[DRIFT] = place, speed, 0.0
        self.filter.forget(POSITION, np.array((fix.position_sigma, fix.position_sigma, fix.height_sigma)))
        self.filter.forget(VELOCITY, max(fix.speed_sigma, 0.3))
        self._baro_known = False
        self.delay.clear()
        self.delay.keep(t, x)  # the next pressure may come before the next IMU sample

    def height(self, pressures: Pressures, t: float, lag: float) -> None:
        """Corrects by the barometric altitude of pressures taken ``lag`` [s] before ``t`` [s].

        The first one, and one after long refusal, sets the barometer's offset.
        """
        altitude = atmosphere.altitude(pressures.static)
        _, p = self.delay.at(t - lag)
        if not self._baro_known:
            self.filter.state.x[BARO] = altitude + p[2]
            self.filter.forget(BARO, UNKNOWN_BARO)
            self._baro_known = True
        seen = observations.height(altitude + float(p[2]) - float(self.filter.state.x[BARO]), lag, self._sheet.static_noise)
        self._baro_known = not self._height.exhausted(self._apply(seen), 0.02)

    def meet_wind(self, speed: float) -> bool:
        """Sets the wind by the wind triangle once heading and tilt are known; whether it has been set.

        Before, the filter would be linear about a wind far from the true one. speed: airspeed [m/s].
        """
        filter_, state = self.filter, self.filter.state
        if self._wind_met or (filter_.sigma(TILT) > MEETING and self._heard):
            return self._wind_met
        ahead = state.rotation[:, 0]
        level = math.sqrt(max(speed**2 - float(state.x[5]) ** 2, 0.0)) / math.hypot(ahead[0], ahead[1])
        state.x[WIND] = state.x[3:5] - level * ahead[:2]
        filter_.forget(WIND, speed * max(filter_.sigma(YAW), MEETING))
        self._wind_met = True
        return True

    def airspeed(self, pressures: Pressures, density: float, dt: float) -> None:
        """Corrects by the differential pressure, ``dt`` [s] after the last; density: [kg/m^3].

        In flight only, where the flow comes from ahead.
        """
        seen = observations.pitot(self.filter.state, pressures.differential, density, self._sheet.pitot_noise**2)
        if self._airspeed.exhausted(self._apply(seen), dt):
            self._lose_wind()

    def slip(self, t: float) -> None:
        """Corrects by zero sideslip, as in coordinated flight, at ``t`` [s].

        What is left of it lasts, and counts as the few independent samples that there are.
        """
        if not self._slip_due.due(t):
            return
        state = self.filter.state
        sigma = SLIP * float(np.linalg.norm(state.through_air)) * math.sqrt(2 * SLIP_TIME / SEVERAL)
        if self._slip.exhausted(self._apply(observations.slip(state, 0.0, sigma)), SEVERAL):
            self._lose_wind()
        self.gusts.learn(state.x[WIND], state.through_air, SEVERAL)

    def _lose_wind(self) -> None:
        self._wind_met = False

    def field(self, sample: InertialSample, t: float) -> None:
        """Corrects by the magnetic field of a sample at ``t`` [s].

        A magnetometer that is slower than the gyroscopes repeats itself: the same reading counts only once.
        """
        if not (any(sample.field) and self._earth.any()) or not self._field_due.due(t):
            return
        if sample.field == self._read:
            self._field_due = Every(SEVERAL)
            return
        self._read, self._heard = sample.field, True
        read = np.array(sample.field) / MAGNETIC
        if self.filter.sigma(YAW) > LOST_YAW:
            roll, pitch, _ = self.filter.state.attitude.euler()
            self._set_yaw(heading(read, self._earth, roll, pitch), SET_YAW)
        if self._field.exhausted(self._apply(observations.field(self.filter.state, read, self._earth, self._sheet.mag_noise)), SEVERAL):
            self.filter.forget(IRON, UNKNOWN_IRON)

    def course(self) -> None:
        """Sets the yaw to the course once the aircraft moves, where nothing else tells the heading."""
        vn, ve, _ = self.filter.state.x[VELOCITY].tolist()
        if self.filter.sigma(YAW) > LOST_YAW and math.hypot(vn, ve) > AHEAD:
            self._set_yaw(math.atan2(ve, vn), SET_YAW_BY_COURSE)

    def _set_yaw(self, yaw: float, sigma: float) -> None:
        roll, pitch, _ = self.filter.state.attitude.euler()
        self.filter.state.turn_to(attitude(roll, pitch, yaw))
        self.filter.forget(YAW, sigma)

    def rest(self, rates: Floats, t: float) -> None:
        """Corrects by standing on the ground at ``t`` [s]: no velocity, and the gyroscopes' rates (3,) [rad/s], FRD, are their bias."""
        if self._rest_due.due(t):
            self._apply(observations.rest(self.filter.state, STANDING))
            self._apply(observations.no_turning(self.filter.state, rates, self._sheet.gyro_noise))

    def suppose(self, trim_airspeed: float, t: float) -> None:
        """Corrects by level flight at about ``trim_airspeed`` [m/s] at ``t`` [s], where there are neither pressures nor satellites."""
        if self._supposed_due.due(t):
            self._apply(observations.airspeed(self.filter.state, trim_airspeed, SUPPOSED_SPEED))
            self._apply(observations.climb(self.filter.state, 0.0, SUPPOSED_CLIMB))

    def _apply(self, seen: Observation) -> float:
        before = self.filter.state.x.copy()
        ratio = self.filter.update(seen)
        self.delay.correct(before, self.filter.state.x)
        return ratio


def _without(sigma: float, drift: float) -> float:
    """m, of the part of a fix's error that changes from fix to fix."""
    return max(math.sqrt(max(sigma**2 - drift**2, 0.0)), LEAST_POSITION)
