"""The estimators there are, and what they are told of the instruments."""

import math
from dataclasses import dataclass, field
from typing import Literal, Protocol

from uvf.estimation.ekf.datasheet import Datasheet
from uvf.estimation.ekf.estimator import FullEstimator
from uvf.estimation.sensor_inputs import Sensed, Triple
from uvf.estimation.state import Estimate
from uvf.models.vehicle.flight_params import AirParams


@dataclass(frozen=True)
class Instruments:
    """What is known on the ground of sensors and magnetic field."""

    earth: Triple = (0.0, 0.0, 0.0)  # T, NED: the magnetic field here; zero = a compass does not point
    sheet: Datasheet = field(default_factory=Datasheet)
    imu_xyz: Triple = (0.0, 0.0, 0.0)  # m, FLU, in base_link
    imu_rpy: Triple = (0.0, 0.0, 0.0)  # rad


class Estimator(Protocol):
    """From sensor readings to the state of the aircraft, cycle by cycle, once there is a fix."""

    gnss_age: float
    """s since the last fix."""

    @property
    def started(self) -> bool:
        """Whether there has been a first fix."""
        ...

    def begin_at(self, roll: float, pitch: float, yaw: float) -> None:
        """Attitude [rad, NED to FRD] to start from, where another estimator has left it."""

    def step(self, sensed: Sensed, params: AirParams, dt: float) -> Estimate:
        """The estimate after one cycle, ``dt`` [s] after the last; the first cycle needs a fix."""


def estimator(kind: Literal["full", "book"], instruments: Instruments) -> Estimator:
    """A new estimator: ``full`` is the error-state Kalman filter, ``book`` the filters of Beard & McLain, chapter 8."""
    if kind == "full":
        return FullEstimator(instruments.earth, instruments.sheet)
    # Its library takes more than a second to import: an autopilot that is started again in flight shall not wait for what it does not use.
    from uvf.estimation.beard_mclain import BookEstimator

    north, east, _ = instruments.earth
    return BookEstimator(math.atan2(east, north))
