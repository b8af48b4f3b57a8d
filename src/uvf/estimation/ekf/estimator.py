"""The whole error-state filter as an estimator: starts it, keeps its time, hands over what guidance and control need."""

import math

import numpy as np

from uvf.estimation.ekf.aiding import Aiding
from uvf.estimation.ekf.air import SLOWEST, AirData
from uvf.estimation.ekf.alignment import attitude, heading, levelled, points
from uvf.estimation.ekf.datasheet import Datasheet
from uvf.estimation.ekf.filter import Filter
from uvf.estimation.ekf.handover import Handover
from uvf.estimation.ekf.inertial import FALL, Mechanisation, process_noise, transition
from uvf.estimation.ekf.standstill import Standstill
from uvf.estimation.ekf.states import (
    ACCEL_BIAS,
    DOWN,
    DRIFT,
    GYRO_BIAS,
    IRON,
    MAGNETIC,
    PITOT,
    POSITION,
    SIZE,
    TILT,
    VELOCITY,
    WIND,
    YAW,
    FilterState,
    Floats,
    NominalAttitude,
)
from uvf.estimation.sensor_inputs import GnssFix, InertialSample, Sensed, Triple
from uvf.estimation.state import Estimate
from uvf.maths.filters import LowPass
from uvf.maths.geodesy import GRAVITY
from uvf.models.vehicle.flight_params import AirParams

GYRO_TIME, FORCE_TIME = 0.02, 0.15  # s
RECKONING_AFTER = 1.0  # s without a fix
FLIES = 0.8  # of min_airspeed
STANDS = 3.0  # m/s over ground, of the first fix: below, the accelerometers feel gravity alone
LEVEL_SIGMA, FLYING_SIGMA, LEFT_SIGMA = 0.03, 0.3, 0.3  # rad, of the first roll and pitch
NORTH_SIGMA = 0.1  # rad, of a yaw by the magnetometer
NO_YAW = 1.8  # rad
WIND_SIGMA = 0.3  # of the trim airspeed, per axis
GAP = 0.25  # s without the IMU, from where on what it would have said is unknown
UNFELT_TURN, UNFELT_ACCELERATION = 0.5, 5.0  # rad/s, m/s^2


class FullEstimator:
    """Error-state Kalman filter of an aircraft, started by the first fix and the first IMU sample.

    Without fixes it reckons on by inertia, held by airspeed, sideslip, compass and barometer; sigmas grow. Without pressures the
    airspeed is the ground velocity less the wind and the height that of the fixes; without both, level flight at trim is supposed.
    """

    def __init__(self, earth: Triple, sheet: Datasheet) -> None:
        """earth: the magnetic field [T, NED]; zero where a compass does not point."""
        self._earth = np.array(earth) / MAGNETIC
        self._sheet = sheet
        self._gyros = [LowPass(GYRO_TIME) for _ in range(3)]
        self._side, self._lift = LowPass(FORCE_TIME), LowPass(FORCE_TIME)
        self._air = AirData(sheet.pitot_noise)
        self._standstill = Standstill()
        self._handover = Handover()
        self._aiding: Aiding | None = None
        self._gained = process_noise(sheet, 1 / sheet.imu_hz)
        self._left: tuple[float, float, float] | None = None
        self._t = 0.0  # s
        self._sampled = 0.0  # s, when the newest IMU sample was taken
        self._speed = 0.0  # m/s over ground, of the newest fix
        self._acceleration: Floats = np.zeros(3)  # m/s^2, NED
        self._height = 0.0  # m, the last one known
        self.gnss_age = 0.0
        """s since the last fix."""

    def begin_at(self, roll: float, pitch: float, yaw: float) -> None:
        """Attitude [rad, NED to FRD] to start from, where another estimator has left it."""
        self._left = roll, pitch, yaw

    @property
    def started(self) -> bool:
        """Whether the filter has been started by a first fix."""
        return self._aiding is not None

    @property
    def density(self) -> float:
        """Air density [kg/m^3]."""
        return self._air.density

    @property
    def gyro_bias(self) -> Floats:
        """Bias (3,) [rad/s] of the gyroscopes, FRD, as known now; zero before the start."""
        return self._aiding.filter.state.x[GYRO_BIAS].copy() if self._aiding is not None else np.zeros(3)

    def step(self, sensed: Sensed, params: AirParams, dt: float) -> Estimate:
        """The estimate after one cycle, ``dt`` [s] after the last. Raises AssertionError if the first cycle has no fix."""
        self._t += dt
        fix, gnss_age = sensed.fix, self.gnss_age + dt
        self.gnss_age = 0.0 if fix is not None else gnss_age
        self._air.take(sensed.pressures, self._t, dt)
        aiding = self._aiding
        if aiding is None:
            assert fix is not None, "the first cycle needs a fix"
            aiding = self._aiding = self._start(sensed.samples, fix, params)
        self._feel(aiding, sensed.samples)
        self._correct(aiding, sensed, params, dt)
        if fix is not None:
            self._speed = math.hypot(fix.v_north, fix.v_east)
            self._take_fix(aiding, fix, gnss_age)
        return self._estimate(aiding, params, dt)

    # beginning

    def _start(self, samples: list[InertialSample], fix: GnssFix, params: AirParams) -> Aiding:
        first = samples[-1] if samples else InertialSample((0.0, 0.0, 0.0), (0.0, 0.0, -float(FALL[2])), (0.0, 0.0, 0.0))
        lies, tilt, yaw = self._first_attitude(first, fix)
        state, sheet = FilterState(lies), self._sheet
        state.x[POSITION] = fix.north + fix.age * fix.v_north, fix.east + fix.age * fix.v_east, -fix.height - fix.age * fix.v_up
        state.x[VELOCITY] = fix.v_north, fix.v_east, -fix.v_up
        sigma = np.zeros(SIZE)
        sigma[TILT] = tilt, tilt, yaw
        sigma[VELOCITY] = max(fix.speed_sigma, 0.3)
        sigma[POSITION] = fix.position_sigma, fix.position_sigma, fix.height_sigma
        sigma[GYRO_BIAS], sigma[ACCEL_BIAS], sigma[IRON] = sheet.gyro_bias, sheet.accel_bias, sheet.iron
        sigma[WIND], sigma[PITOT] = WIND_SIGMA * params.trim_airspeed, sheet.pitot_bias
        sigma[DRIFT] = sheet.drift, sheet.drift, sheet.height_drift
        self._sampled = self._t - first.age - 1 / sheet.imu_hz * len(samples)
        self._mechanisation = Mechanisation(np.array(first.rates), np.array(first.force))
        aiding = Aiding(Filter(state, sigma), sheet, self._earth)
        aiding.delay.keep(self._sampled, state.x)
        return aiding

    def _first_attitude(self, sample: InertialSample, fix: GnssFix) -> tuple[NominalAttitude, float, float]:
        """And the sigmas of tilt and yaw [rad]."""
        speed = math.hypot(fix.v_north, fix.v_east)
        if self._left is not None:
            (roll, pitch, yaw), tilt = self._left, LEFT_SIGMA
        else:
            (roll, pitch), yaw, tilt = levelled(np.array(sample.force)), None, LEVEL_SIGMA if speed < STANDS else FLYING_SIGMA
        if any(sample.field) and points(self._earth):  # of now: in a turn the yaw that was left is long over
            return attitude(roll, pitch, heading(np.array(sample.field), self._earth, roll, pitch)), tilt, max(NORTH_SIGMA, tilt)
        if yaw is not None:
            return attitude(roll, pitch, yaw), tilt, LEFT_SIGMA
        return attitude(roll, pitch, math.atan2(fix.v_east, fix.v_north)), tilt, NO_YAW

    # each cycle

    def _feel(self, aiding: Aiding, samples: list[InertialSample]) -> None:
        """The IMU's samples since the last cycle."""
        if not samples:
            return
        state, begun = aiding.filter.state, self._sampled
        for sample in samples:
            dt = self._t - sample.age - self._sampled
            if dt <= 0.0:
                continue
            if dt > GAP:
                self._bridge(aiding, dt)
                begun = self._sampled
                continue
            self._sampled += dt
            rates, force = np.array(sample.rates), np.array(sample.force)
            self._acceleration = self._mechanisation.step(state, rates, force, dt)
            for low_pass, rate in zip(self._gyros, sample.rates, strict=True):
                low_pass.step(rate, dt)
            self._side.step(sample.force[1], dt)
            self._lift.step(-sample.force[2], dt)
            self._standstill.step(rates - state.x[GYRO_BIAS], force, self._fastest(aiding), dt)
        passed = self._sampled - begun
        if passed > 0.0:
            f = transition(state, self._acceleration, self._sheet.drift_time, passed)
            aiding.filter.predict(f, self._gain(aiding, passed) + self._mechanisation.take_missed())
            aiding.delay.keep(self._sampled, state.x)

    def _fastest(self, aiding: Aiding) -> float:
        """m/s: of the state, of the newest fix if that is not long ago."""
        known = float(np.linalg.norm(aiding.filter.state.x[VELOCITY]))
        return max(known, self._speed) if self.gnss_age < RECKONING_AFTER else known

    def _gain(self, aiding: Aiding, dt: float) -> Floats:
        """(25,) variance of ``dt`` [s]."""
        gained = self._gained * dt
        gained[WIND] = aiding.gusts.walk**2 * dt
        return gained

    def _bridge(self, aiding: Aiding, gap: float) -> None:
        """The IMU was silent: it flew on straight, within what an aircraft may do meanwhile."""
        filter_, x = aiding.filter, aiding.filter.state.x
        x[POSITION] += gap * x[VELOCITY]
        turned = min(UNFELT_TURN * gap, 1.0)
        gained = np.zeros(SIZE)
        gained[TILT], gained[VELOCITY] = turned**2, (UNFELT_ACCELERATION * gap) ** 2
        gained[POSITION] = (0.5 * UNFELT_ACCELERATION * gap * gap) ** 2
        filter_.predict(transition(filter_.state, np.zeros(3), self._sheet.drift_time, gap), gained + self._gain(aiding, gap))
        self._sampled += gap
        aiding.delay.clear()
        aiding.delay.keep(self._sampled, x)

    def _correct(self, aiding: Aiding, sensed: Sensed, params: AirParams, dt: float) -> None:
        """By all sensors but the satellites."""
        air, t = self._air, self._sampled
        pressures = air.pressures
        flies = self._flies(aiding, params) and aiding.meet_wind(self._airspeed(aiding, params))
        if sensed.samples:
            if self._standstill.stands:
                aiding.rest(np.array(sensed.samples[-1].rates), t)
            aiding.field(sensed.samples[-1], t)
        aiding.course()
        if pressures is not None and air.fresh:
            aiding.height(pressures, t, max(pressures.age - (self._t - t), 0.0))
            if flies:
                aiding.airspeed(pressures, air.density, dt)
        if flies:
            aiding.slip(t)
            if pressures is None and self.gnss_age > RECKONING_AFTER:
                aiding.suppose(params.trim_airspeed, t)

    def _flies(self, aiding: Aiding, params: AirParams) -> bool:
        if self._standstill.stands:
            return False
        if self._air.pressures is None:
            return self._through_air(aiding) > FLIES * params.min_airspeed
        return self._air.airspeed(float(aiding.filter.state.x[PITOT])) > FLIES * params.min_airspeed

    @staticmethod
    def _through_air(aiding: Aiding) -> float:
        return float(np.linalg.norm(aiding.filter.state.through_air))

    def _take_fix(self, aiding: Aiding, fix: GnssFix, gnss_age: float) -> None:
        x = aiding.filter.state.x
        before = x[POSITION].copy()
        aiding.fix(fix, self._acceleration, self._sampled, max(fix.age - (self._t - self._sampled), 0.0))
        self._handover.take(before - x[POSITION], gnss_age)

    # handing over

    def _estimate(self, aiding: Aiding, params: AirParams, dt: float) -> Estimate:
        filter_, x = aiding.filter, aiding.filter.state.x
        age = self._t - self._sampled
        velocity = x[VELOCITY] + age * self._acceleration
        vn, ve, vd = velocity.tolist()
        north, east, down = (x[POSITION] + age * velocity + self._handover.step(dt)).tolist()
        bias = x[GYRO_BIAS].tolist()
        p, q, r = ((g.value or 0.0) - b for g, b in zip(self._gyros, bias, strict=True))
        roll, pitch, yaw = self._ahead(aiding, (p, q, r), age)
        is_fixed = self.gnss_age < RECKONING_AFTER
        height_known = is_fixed or self._air.pressures is not None
        if height_known:
            self._height = -down
        wind_north, wind_east = x[WIND].tolist()
        return Estimate(
            north=north,
            east=east,
            height=self._height,
            ground_speed=math.hypot(vn, ve),
            course=math.atan2(ve, vn),
            climb=-vd if height_known else 0.0,
            roll=roll,
            pitch=pitch,
            yaw=yaw,
            p=p,
            q=q,
            r=r,
            airspeed=self._airspeed(aiding, params) if self._air.pressures is None else self._felt_airspeed(aiding, dt),
            density=self._air.density,
            side_force=self._side.value or 0.0,
            lift=self._lift.value if self._lift.value is not None else GRAVITY,
            wind_north=wind_north,
            wind_east=wind_east,
            position_sigma=filter_.sigma(slice(6, 8)) + self._handover.off,
            height_known=height_known,
            height_sigma=filter_.sigma(DOWN),
            airspeed_known=is_fixed or self._air.pressures is not None,
            position_known=is_fixed,
            tilt_sigma=filter_.sigma(slice(0, 2)),
            yaw_sigma=filter_.sigma(YAW),
            wind_sigma=filter_.sigma(WIND),
            ratios=aiding.ratios,
        )

    def _airspeed(self, aiding: Aiding, params: AirParams) -> float:
        if self._air.pressures is not None:
            return self._air.airspeed(float(aiding.filter.state.x[PITOT]))
        return self._through_air(aiding) if self.gnss_age < RECKONING_AFTER else params.trim_airspeed

    def _felt_airspeed(self, aiding: Aiding, dt: float) -> float:
        """m/s, of the pressures with what the aircraft has gained since by its own acceleration."""
        state = aiding.filter.state
        through_air = state.through_air
        gained = float(self._acceleration @ through_air) / max(float(np.linalg.norm(through_air)), SLOWEST)
        return self._air.smooth(float(state.x[PITOT]), gained, aiding.gusts.walk, dt)

    @staticmethod
    def _ahead(aiding: Aiding, rates: tuple[float, float, float], age: float) -> tuple[float, float, float]:
        """Roll, pitch and yaw [rad] now, ``age`` [s] after the last sample, turning on at ``rates``."""
        p, q, r = rates
        roll, pitch, yaw = aiding.filter.state.attitude.euler()
        s, c, tan = math.sin(roll), math.cos(roll), math.tan(pitch)
        turn = q * s + r * c
        return roll + age * (p + turn * tan), pitch + age * (q * c - r * s), math.remainder(yaw + age * turn / math.cos(pitch), math.tau)
