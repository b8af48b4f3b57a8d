"""Samples a gyroscope at rest for ten minutes and finds its noise again in the Allan deviation (IEEE Std 952)."""

import numpy as np

from uvf.sensors import Channel, Errors, allan_deviation

hz, density = 100.0, 1e-4  # Hz, rad/s/sqrt(Hz)
errors = Errors(noise=density * hz**0.5, bias=2e-3, drift=5e-5, drift_time=200.0)  # rad/s, s
gyroscope = Channel(errors, size=3, rng=np.random.default_rng(1))
readings = np.array([gyroscope.read(np.zeros(3), dt=1 / hz) for _ in range(60_000)])  # (n, 3) rad/s
times, deviations = allan_deviation(readings[:, 0], hz, factors=[100, 1000, 10_000])
for time, deviation in zip(times, deviations, strict=True):
    print(f"{time:5.0f} s: {deviation:.1e} rad/s, white noise alone {density / time**0.5:.1e} rad/s")
