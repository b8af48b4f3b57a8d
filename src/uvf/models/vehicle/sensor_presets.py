"""Sensors by name: what ``preset: <name>`` stands for in a vehicle's file. Keys that are written beside it count."""

import math
from typing import Any

from uvf.models.yaml_data import BadInput, FileLocation, nearest

_HOKUYO = {"hz": 40.0, "beams": 1081, "angle_min": -0.75 * math.pi, "angle_increment": math.pi / 720}  # 270 deg in steps of 0.25 deg

PRESETS: dict[str, dict[str, dict[str, float]]] = {
    "lidar": {
        # Data sheets. Noise: LDS-01, precision up to 0.5 m; UTM-30LX and UST-10LX, the upper bounds they give for near targets.
        "lds01": {
            "hz": 5.0,
            "beams": 360,
            "angle_min": 0.0,
            "angle_increment": math.pi / 180,
            "range_min": 0.12,
            "range_max": 3.5,
            "noise": 0.01,
        },
        "utm30lx": {**_HOKUYO, "range_min": 0.1, "range_max": 30.0, "noise": 0.01},
        "ust10": {**_HOKUYO, "range_min": 0.06, "range_max": 10.0, "noise": 0.03},
    },
    "gnss": {
        # Beard & McLain (2012), table 7.1 and eq. 7.17: increments of 0.21 and 0.40 m a second, forgotten within 1100 s. Their
        # recursion has the standard deviations 0.21 and 0.40 / sqrt(1 - exp(-2 / 1100)).
        "book": {
            "hz": 1.0,
            "horizontal_drift": 4.927,
            "vertical_drift": 9.385,
            "drift_time": 1100.0,
            "speed_noise": 0.05,
            "latency": 0.1,
        },
        "good": {"hz": 5.0, "horizontal_noise": 0.3, "vertical_noise": 0.5, "speed_noise": 0.05, "latency": 0.1},
    },
    # Beard & McLain (2012), appendix H: 0.13 deg/s, 0.0025 g, a compass of 0.3 deg in a field of 48 uT; 10 and 2 Pa with biases of
    # 125 and 20 Pa.
    "imu": {"book": {"hz": 100.0, "gyro_noise": math.radians(0.13), "accel_noise": 0.0025 * 9.80665, "mag_noise": 2.5e-7}},
    "air_data": {"book": {"hz": 50.0, "static_noise": 10.0, "static_bias": 125.0, "differential_noise": 2.0, "differential_bias": 20.0}},
}
SEVERAL = {"other_lidars": "lidar"}
"""Sections that are lists, and whose presets they take."""


def fill_presets(data: Any, place: FileLocation) -> Any:
    """The plain data of a vehicle.yaml with its presets' values put in. Raises BadInput for a preset that there is not."""
    sensors = data.get("sensors") if isinstance(data, dict) else None
    if not isinstance(sensors, dict):
        return data  # what is wrong with it is found when it is converted
    filled = {
        kind: _filled(sensors[kind], known, place.at("sensors", kind, "preset")) for kind, known in PRESETS.items() if kind in sensors
    }
    for kind, one in SEVERAL.items():
        if isinstance(sensors.get(kind), list):
            place_of = [place.at("sensors", kind, i, "preset") for i in range(len(sensors[kind]))]
            filled[kind] = [_filled(each, PRESETS[one], at) for each, at in zip(sensors[kind], place_of, strict=True)]
    return {**data, "sensors": {**sensors, **filled}}


def _filled(sensor: Any, known: dict[str, dict[str, float]], place: FileLocation) -> Any:
    if not isinstance(sensor, dict) or "preset" not in sensor:
        return sensor
    name = str(sensor["preset"])
    if name not in known:
        raise BadInput(f"{place}: no preset '{name}'; {nearest(name, known)}")
    return {**known[name], **sensor}
