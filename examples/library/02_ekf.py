"""Estimates attitude, position and wind of a recorded flight with the error-state Kalman filter, 50 times a second."""

from pathlib import Path

import numpy as np

from uvf.estimation import Datasheet, FullEstimator, GnssFix, InertialSample, Pressures, Sensed
from uvf.models import AirParams

flight = np.load(Path(__file__).with_name("flight.npz"))  # NED and FRD, SI; column 0 of each table is the time [s]
ekf, params, errors = FullEstimator((22e-6, 0.0, 42e-6), Datasheet()), AirParams(), []


def since(table, t):
    return table[(table[:, 0] > t - 0.02) & (table[:, 0] <= t)].astype(float)


for t in np.arange(flight["gnss"][0, 0], flight["imu"][-1, 0], 0.02):
    samples = [InertialSample(tuple(s[1:4]), tuple(s[4:7]), tuple(s[7:10]), t - s[0]) for s in since(flight["imu"], t)]
    fixes = [GnssFix(*s[1:7], t - s[0], *s[7:]) for s in since(flight["gnss"], t)]
    pressures = [Pressures(*s[1:], t - s[0]) for s in since(flight["air"], t)]
    now = ekf.step(Sensed(samples, pressures[-1] if pressures else None, fixes[-1] if fixes else None), params, 0.02)
    true = flight["true"][np.argmin(abs(flight["true"][:, 0] - t)), 1:]
    errors.append(np.linalg.norm(true - (now.north, now.east, now.height)))
print(f"position off by {np.median(errors):.1f} m in the median; roll {now.roll:.2f}, pitch {now.pitch:.2f}, yaw {now.yaw:.2f} rad")
