"""The book's estimator: low-passes, two-state attitude, seven-state track and a complementary height together."""

import math

from uvf.estimation.attitude import AttitudeFilter
from uvf.estimation.sensor_inputs import GnssFix, InertialSample, Pressures, Sensed, Triple
from uvf.estimation.state import Estimate
from uvf.estimation.track_filter import CHI, PSI, WE, WN, E, N, TrackFilter, V
from uvf.estimation.vertical import Vertical
from uvf.maths import atmosphere
from uvf.maths.filters import LowPass
from uvf.maths.geodesy import GRAVITY
from uvf.models.vehicle.flight_params import AirParams

GYRO_TIME = 0.02  # s
PRESSURE_TIME = 0.08  # s
FORCE_TIME = 0.15  # s
RECKONING_AFTER = 1.0  # s without a fix
LONGEST = 0.1  # s, of a step: the IMU may have been silent for longer
CLIMB_SIGMA = 1.0  # m/s, with neither barometer nor fixes


class BookEstimator:
    """The filters of Beard & McLain, chapter 8, started by the first fix.

    Alpha is taken from the load on the wing (``alpha_zero_lift``, ``alpha_per_load``).
    Without fixes it reckons on with heading, airspeed and the wind of before. Without pressures the airspeed is the ground
    velocity less the wind and the height that of the fixes; without both, the airspeed is taken to be that of trim.
    """

    def __init__(self, declination: float) -> None:
        """``declination`` [rad]: magnetic north east of true north."""
        self._declination = declination
        self._gyros = [LowPass(GYRO_TIME) for _ in range(3)]
        self._static, self._differential = LowPass(PRESSURE_TIME), LowPass(PRESSURE_TIME)
        self._side = LowPass(FORCE_TIME)
        self._attitude = AttitudeFilter()
        self._yaw: float | None = None  # rad, left by another estimator
        self._track: TrackFilter | None = None
        self._vertical: Vertical | None = None
        self.density = atmosphere.RHO0
        self._airspeed = 0.0
        self._baro: float | None = None
        self.gnss_age = 0.0
        """s since the last fix."""
        self._lift = GRAVITY  # m/s^2
        self._age = 0.0  # s, of the newest IMU sample
        self._pitot = False
        self._fix_height_sigma = 0.0  # m
        self._aside = 0.0  # rad, of the flight through the air from the nose

    def begin_at(self, roll: float, pitch: float, yaw: float) -> None:
        """Attitude [rad, NED to FRD] to start from, where another estimator has left it; without it level flight is supposed."""
        self._attitude.roll, self._attitude.pitch = roll, pitch
        self._yaw = yaw

    @property
    def started(self) -> bool:
        """Whether the filters have been started by a first fix."""
        return self._track is not None

    def step(self, sensed: Sensed, params: AirParams, dt: float) -> Estimate:
        """The estimate after one cycle of ``dt`` [s]. Raises AssertionError if the first cycle has no fix."""
        dt = min(dt, LONGEST)
        samples, fix = sensed.samples, sensed.fix
        self.gnss_age = 0.0 if fix is not None else self.gnss_age + dt
        self._take_pressures(sensed.pressures, params, dt)
        track, vertical = self._track, self._vertical
        if track is None or vertical is None:
            assert fix is not None, "the first cycle needs a fix"
            track, vertical = self._start(samples, fix)
        up = [self._take_inertial(sample, params, dt / len(samples)) for sample in samples]
        self._step_track(track, samples, params, dt)
        if up:
            self._age = samples[-1].age
            vertical.step(self._baro, sum(up) / len(up), dt)
        if fix is not None:
            self._correct(track, vertical, fix)
        if not self._height_known:
            vertical.rest()
        if self.gnss_age > RECKONING_AFTER:
            track.reckon(self.gnss_age, dt)
        if self.gnss_age > RECKONING_AFTER or (fix is not None and self._baro is not None):
            track.correct_triangle(self._horizontal_airspeed())
        return self._estimate(track, vertical)

    def _correct(self, track: TrackFilter, vertical: Vertical, fix: GnssFix) -> None:
        here = (fix.north, fix.east, fix.v_north, fix.v_east)
        track.correct_fix(here, fix.age, (fix.position_sigma, fix.speed_sigma))
        height = fix.height + fix.v_up * fix.age
        self._fix_height_sigma = fix.height_sigma
        if self._baro is None:
            vertical.correct(height, fix.v_up)
        else:
            vertical.correct_offset(height, self._baro)

    @property
    def _height_known(self) -> bool:
        return self._baro is not None or self.gnss_age < RECKONING_AFTER

    def _start(self, samples: list[InertialSample], fix: GnssFix) -> tuple[TrackFilter, Vertical]:
        self._track = TrackFilter(fix.north, fix.east, fix.v_north, fix.v_east)
        self._vertical = Vertical(fix.height, fix.v_up)
        if self._yaw is not None:
            self._track.x[PSI] = self._yaw
        elif samples:
            self._attitude.start(samples[-1].force)
        return self._track, self._vertical

    def _take_pressures(self, pressures: Pressures | None, params: AirParams, dt: float) -> None:
        self._pitot = pressures is not None
        if pressures is None:
            self._baro = None
            self._airspeed = self._airspeed_over_ground() if self._height_known else params.trim_airspeed
            return
        static = self._static.step(pressures.static, dt)
        self.density = atmosphere.density(static, pressures.temperature)
        self._airspeed = atmosphere.airspeed(self._differential.step(pressures.differential, dt), self.density)
        self._baro = atmosphere.altitude(static)

    def _airspeed_over_ground(self) -> float:
        """m/s, from the ground velocity less the wind; the last one measured until there is a track."""
        if self._track is None or self._vertical is None:
            return self._airspeed
        _, _, v, chi, wn, we, _ = self._track.x.tolist()
        return math.hypot(v * math.cos(chi) - wn, v * math.sin(chi) - we, self._vertical.climb)

    def _alpha(self, params: AirParams) -> float:
        """rad; at zero lift plus what the load asks for at this dynamic pressure."""
        eas2 = max(self._airspeed, 5.0) ** 2 * self.density / atmosphere.RHO0
        return params.alpha_zero_lift + params.alpha_per_load * self._lift / eas2

    def _take_inertial(self, sample: InertialSample, params: AirParams, dt: float) -> float:
        """Attitude over one sample; returns the upward acceleration [m/s^2]."""
        p, q, r = sample.rates
        fx, fy, fz = sample.force
        for low_pass, rate in zip(self._gyros, sample.rates, strict=True):
            low_pass.step(rate, dt)
        self._side.step(fy, dt)
        self._lift += dt / FORCE_TIME * (-fz - self._lift)
        attitude = self._attitude
        attitude.predict(sample.rates, dt)
        alpha = self._alpha(params)
        u, w = self._airspeed * math.cos(alpha), self._airspeed * math.sin(alpha)
        attitude.correct((q * w - fx, r * u - p * w - fy, -q * u - fz), dt)
        sr, cr, sp, cp = math.sin(attitude.roll), math.cos(attitude.roll), math.sin(attitude.pitch), math.cos(attitude.pitch)
        return fx * sp - (fy * sr + fz * cr) * cp - GRAVITY

    def _step_track(self, track: TrackFilter, samples: list[InertialSample], params: AirParams, dt: float) -> None:
        attitude = self._attitude
        q, r = (self._gyros[i].value or 0.0 for i in (1, 2))
        before, self._aside = self._aside, self._azimuth_of(self._alpha(params))
        yaw_rate = ((q - attitude.bias_q) * math.sin(attitude.roll) + r * math.cos(attitude.roll)) / math.cos(attitude.pitch)
        track.predict(self._horizontal_airspeed(), yaw_rate + (self._aside - before) / dt, attitude.roll, dt)
        if samples and any(samples[-1].field):
            magnetic = _heading(samples[-1].field, attitude.roll, attitude.pitch)
            track.correct_heading(magnetic + self._declination + self._aside)

    def _azimuth_of(self, alpha: float) -> float:
        """rad; in a bank the angle of attack carries the nose aside of the flight through the air."""
        roll, pitch = self._attitude.roll, self._attitude.pitch
        ahead = math.cos(alpha) * math.cos(pitch) + math.cos(roll) * math.sin(alpha) * math.sin(pitch)
        return math.atan2(-math.sin(roll) * math.sin(alpha), ahead)

    def _horizontal_airspeed(self) -> float:
        climb = self._vertical.climb if self._vertical else 0.0
        return math.sqrt(max(self._airspeed**2 - climb**2, 1.0))

    def _estimate(self, track: TrackFilter, vertical: Vertical) -> Estimate:
        x = track.x.tolist()
        p, q, r = (g.value or 0.0 for g in self._gyros)
        a = self._attitude
        roll, pitch = a.ahead((p, q, r), self._age)
        return Estimate(
            north=x[N],
            east=x[E],
            height=vertical.height,
            ground_speed=x[V],
            course=math.remainder(x[CHI], math.tau),
            climb=vertical.climb,
            roll=roll,
            pitch=pitch,
            yaw=math.remainder(x[PSI] - self._aside, math.tau),
            p=p - a.bias_p,
            q=q - a.bias_q,
            r=r,
            airspeed=self._airspeed,
            density=self.density,
            side_force=self._side.value or 0.0,
            lift=self._lift,
            wind_north=x[WN],
            wind_east=x[WE],
            position_sigma=track.position_sigma,
            height_known=self._height_known,
            height_sigma=self._height_sigma(),
            airspeed_known=self._pitot or self._height_known,
            position_known=self.gnss_age < RECKONING_AFTER,
        )

    def _height_sigma(self) -> float:
        """m; the complementary filter has no covariance, so this is that of the fixes, growing without any."""
        return self._fix_height_sigma + (0.0 if self._height_known else CLIMB_SIGMA * self.gnss_age)


def _heading(field: Triple, roll: float, pitch: float) -> float:
    """Tilt-compensated heading [rad] from the magnetic field [FRD], from magnetic north."""
    x, y, z = field
    sr, cr, sp, cp = math.sin(roll), math.cos(roll), math.sin(pitch), math.cos(pitch)
    return math.atan2(z * sr - y * cr, x * cp + (y * sr + z * cr) * sp)
