"""Sensor messages of steady level flight to the east, for the service without a simulator."""

import math

from schemas.messages import AirData, Gnss, Imu, MissionItem, Vector3
from services.autopilot.air.config import AutopilotConfig
from services.autopilot.air.service import AutopilotAir
from tests.runtime.stepping import stepped
from tests.stops import NOBODY
from uvf.estimation.estimators import Instruments
from uvf.maths import atmosphere
from uvf.maths.geodesy import LocalTangent
from uvf.models.vehicle.flight_params import AirParams
from uvf.runtime.messages.convert import stamp

TANGENT = LocalTangent.from_degrees(40.77, 14.79, 300.0)
NOTHING_ASKED = {name: [] for name in AutopilotAir.requests}
WAYPOINTS = [MissionItem(position=Vector3(x=900.0, z=60.0)), MissionItem(position=Vector3(x=900.0, y=900.0, z=60.0))]


def sensors(t, speed=25.0):
    latitude, longitude, altitude = TANGENT.geodetic([speed * t, 0.0, 60.0])
    static = atmosphere.pressure(360.0) + 1e-3 * math.sin(1000.0 * t)  # a sensor that never changes has frozen
    rho = atmosphere.density(static, 285.8)
    gnss = Gnss(
        timestamp=stamp(t),
        fix=Gnss.FIX_3D,
        latitude=latitude,
        longitude=longitude,
        altitude=altitude,
        velocity_enu=Vector3(x=speed),
        horizontal_accuracy=0.8,
        vertical_accuracy=1.5,
        speed_accuracy=0.1,
    )
    imu = [Imu(timestamp=stamp(t - d), specific_force=Vector3(x=0.5, z=9.79)) for d in (0.01, 0.0)]
    return {
        "imu": imu,
        "air_data": AirData(timestamp=stamp(t), static_pressure=static, differential_pressure=0.5 * rho * speed**2, temperature=285.8),
        "gnss": gnss,
        "battery": None,
        "range": [],
        "link": None,
        "stop": NOBODY,
        "teleop": None,
        "mavlink": None,
        "client": None,
        "setpoint_offboard": None,
        "setpoint_client": None,
        "setpoint_mavlink": None,
    }


def autopilot(items=WAYPOINTS):
    return AutopilotAir(AutopilotConfig("milvus", 7, TANGENT, Instruments(), list(items), starts_in_air=True), AirParams())


class Bench:
    """Steps the service on level flight, whatever it commands; ``run`` returns the outputs of the last cycle."""

    def __init__(self, items=WAYPOINTS):
        self.service = autopilot(items)
        self.n = 0
        self.outputs = []

    def run(self, cycles=1, speed=25.0, **asked):
        for _ in range(cycles):
            self.n += 1
            t = self.n / self.service.hz
            self.outputs.append(stepped(self.service, t, **{**NOTHING_ASKED, **sensors(t - 0.01, speed), **asked}))
        return self.outputs[-1]

    @property
    def status(self):
        return next(out["status"] for out in reversed(self.outputs) if "status" in out)

    @property
    def texts(self):
        return [event.text for out in self.outputs for event in out.get("events", [])]


def resting(*args):
    """A bench whose aircraft has stood still until it is taken to be landed."""
    bench = Bench(*args)
    bench.run(cycles=80, speed=0.0)
    return bench
