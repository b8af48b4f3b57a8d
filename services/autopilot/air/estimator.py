"""The state of the aircraft from its sensors: low-passes, attitude, track and height together."""

import math
from dataclasses import dataclass

from services.autopilot.air.attitude import Attitude
from services.autopilot.air.state import Estimate
from services.autopilot.air.track_filter import CHI, PSI, WE, WN, E, N, TrackFilter, V
from services.autopilot.air.vertical import Vertical
from uvf.maths import atmosphere
from uvf.maths.filters import LowPass
from uvf.maths.geodesy import GRAVITY

GYRO_TIME = 0.02  # s
PRESSURE_TIME = 0.08  # s
FORCE_TIME = 0.15  # s
Triple = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Inertial:
    """One IMU sample, FRD: rad/s, m/s^2, T."""

    rates: Triple
    force: Triple
    field: Triple
    age: float = 0.0  # s, since it was taken


@dataclass(frozen=True, slots=True)
class Fix:
    """A satellite fix in the world frame, valid ``age`` [s] ago."""

    north: float  # m
    east: float  # m
    height: float  # m
    v_north: float  # m/s
    v_east: float  # m/s
    v_up: float  # m/s
    age: float  # s
    position_sigma: float  # m
    speed_sigma: float  # m/s


@dataclass(frozen=True, slots=True)
class Pressures:
    static: float  # Pa
    differential: float  # Pa
    temperature: float  # K


class Estimator:
    """Started by the first fix; alpha is taken from the load on the wing (``alpha_zero_lift``, ``alpha_per_load``),
    ``declination`` [rad] is that of the magnetic field, east positive.
    """

    def __init__(self, alpha_zero_lift: float, alpha_per_load: float, declination: float = 0.0) -> None:
        self._declination = declination
        self._alpha_zero, self._alpha_load = alpha_zero_lift, alpha_per_load
        self._gyros = [LowPass(GYRO_TIME) for _ in range(3)]
        self._static, self._differential = LowPass(PRESSURE_TIME), LowPass(PRESSURE_TIME)
        self._side = LowPass(FORCE_TIME)
        self._attitude = Attitude()
        self._attitude_known = False
        self._track: TrackFilter | None = None
        self._vertical: Vertical | None = None
        self.density = atmosphere.RHO0
        self._airspeed = 0.0
        self._baro = 0.0
        self._lift = GRAVITY  # m/s^2
        self._age = 0.0  # s, of the newest IMU sample
        self._aside = 0.0  # rad, of the flight through the air from the nose

    def begin_at(self, roll: float, pitch: float) -> None:
        """Attitude [rad] to begin with, where another estimator has left it; else level flight is supposed."""
        self._attitude.roll, self._attitude.pitch = roll, pitch
        self._attitude_known = True

    @property
    def started(self) -> bool:
        return self._track is not None

    def step(self, samples: list[Inertial], pressures: Pressures, fix: Fix | None, dt: float) -> Estimate:
        """One cycle of ``dt`` [s]: the IMU samples since the last, the newest pressures, a fix if one has come."""
        self._take_pressures(pressures, dt)
        track, vertical = self._track, self._vertical
        if track is None or vertical is None:
            assert fix is not None, "the first cycle needs a fix"
            track, vertical = self._start(samples, fix)
        up = [self._take_inertial(sample, dt / len(samples)) for sample in samples]
        self._step_track(track, samples, dt)
        if up:
            self._age = samples[-1].age
            vertical.step(self._baro, sum(up) / len(up), dt)
        if fix is not None:
            ahead = (fix.north, fix.east, fix.v_north, fix.v_east)
            track.correct_fix(ahead, fix.age, (fix.position_sigma, fix.speed_sigma))
            vertical.correct_offset(fix.height + fix.v_up * fix.age, self._baro)
            track.correct_triangle(self._horizontal_airspeed())
        return self._estimate(track, vertical)

    def _start(self, samples: list[Inertial], fix: Fix) -> tuple[TrackFilter, Vertical]:
        self._track = TrackFilter(fix.north, fix.east, fix.v_north, fix.v_east)
        self._vertical = Vertical(fix.height, self._baro, fix.v_up)
        if samples and not self._attitude_known:
            self._attitude.start(samples[-1].force)
        return self._track, self._vertical

    def _take_pressures(self, pressures: Pressures, dt: float) -> None:
        static = self._static.step(pressures.static, dt)
        self.density = atmosphere.density(static, pressures.temperature)
        self._airspeed = atmosphere.airspeed(self._differential.step(pressures.differential, dt), self.density)
        self._baro = atmosphere.altitude(static)

    @property
    def _alpha(self) -> float:
        """rad; at zero lift plus what the load asks for at this dynamic pressure."""
        eas2 = max(self._airspeed, 5.0) ** 2 * self.density / atmosphere.RHO0
        return self._alpha_zero + self._alpha_load * self._lift / eas2

    def _take_inertial(self, sample: Inertial, dt: float) -> float:
        """Attitude over one sample; returns the upward acceleration [m/s^2]."""
        p, q, r = sample.rates
        fx, fy, fz = sample.force
        for low_pass, rate in zip(self._gyros, sample.rates, strict=True):
            low_pass.step(rate, dt)
        self._side.step(fy, dt)
        self._lift += dt / FORCE_TIME * (-fz - self._lift)
        attitude = self._attitude
        attitude.predict(sample.rates, dt)
        u, w = self._airspeed * math.cos(self._alpha), self._airspeed * math.sin(self._alpha)
        attitude.correct((q * w - fx, r * u - p * w - fy, -q * u - fz), dt)
        sr, cr, sp, cp = math.sin(attitude.roll), math.cos(attitude.roll), math.sin(attitude.pitch), math.cos(attitude.pitch)
        return fx * sp - (fy * sr + fz * cr) * cp - GRAVITY

    def _step_track(self, track: TrackFilter, samples: list[Inertial], dt: float) -> None:
        attitude = self._attitude
        q, r = (self._gyros[i].value or 0.0 for i in (1, 2))
        before, self._aside = self._aside, self._azimuth_of_alpha()
        yaw_rate = ((q - attitude.bias_q) * math.sin(attitude.roll) + r * math.cos(attitude.roll)) / math.cos(attitude.pitch)
        track.predict(self._horizontal_airspeed(), yaw_rate + (self._aside - before) / dt, attitude.roll, dt)
        if samples and any(samples[-1].field):
            magnetic = _heading(samples[-1].field, attitude.roll, attitude.pitch)
            track.correct_heading(magnetic + self._declination + self._aside)

    def _azimuth_of_alpha(self) -> float:
        """rad; in a bank the angle of attack carries the nose aside of the flight through the air."""
        roll, pitch, alpha = self._attitude.roll, self._attitude.pitch, self._alpha
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
            wind_north=x[WN],
            wind_east=x[WE],
            position_sigma=track.position_sigma,
        )


def _heading(field: Triple, roll: float, pitch: float) -> float:
    """Tilt-compensated heading [rad] from the magnetic field [FRD], from magnetic north."""
    x, y, z = field
    sr, cr, sp, cp = math.sin(roll), math.cos(roll), math.sin(pitch), math.cos(pitch)
    return math.atan2(z * sr - y * cr, x * cp + (y * sr + z * cr) * sp)
