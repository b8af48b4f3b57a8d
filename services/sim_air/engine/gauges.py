"""What a loaded model says of itself: JSBSim's properties in SI units, world ENU and body FLU."""

import math
import re
from collections.abc import Collection

import numpy as np

from services.sim_air.engine.states import Air, AircraftMotion
from services.sim_air.engine.wiring import Properties
from services.sim_air.environment.wind import AirRelativeState
from uvf.maths import rotations
from uvf.maths.geodesy import LocalTangent
from uvf.maths.rotations import Floats
from uvf.models.vehicle.air import BatteryPack

FT = 0.3048  # m
LBF = 4.4482216152605  # N
HP = 745.6998715822702  # W
PSF = 47.88025898033584  # Pa
RANKINE = 5 / 9  # K
PITOT_CONE = math.cos(math.radians(20.0))
G = 9.80665  # m/s^2, JSBSim's unit of load factors
POWER = re.compile(r"propulsion/engine(\[\d+\])?/power-hp")


def pitot_share(forward: float, airspeed: float) -> float:
    """Share [-] of the dynamic pressure that a forward tube takes in at ``airspeed``, ``forward`` of it from ahead (one unit, e.g. [m/s]).

    All of it within 20 degrees, as real tubes do, then less by the square of the cosine, and nothing from the side or from behind.
    """
    if forward <= 0:
        return 0.0
    return min(forward / (airspeed * PITOT_CONE), 1.0) ** 2


class Gauges:
    """Reads the state of one aircraft; known: the names of the model's properties."""

    def __init__(self, properties: Properties, known: Collection[str], tangent: LocalTangent) -> None:
        self._properties = properties
        self._enu_from_ecef = tangent.enu_from_ecef.tolist()
        self._origin_ecef = tangent.origin_ecef.tolist()
        self._has_engines = "forces/fbx-prop-lbs" in known
        self.powered = any(name.startswith("propulsion/engine") for name in known)
        self._powers = [name for name in known if POWER.fullmatch(name)]

    def motion(self) -> AircraftMotion:
        """True motion now: world ENU, body FLU."""
        p = self._properties
        velocity = np.array((p["velocities/v-east-fps"] * FT, p["velocities/v-north-fps"] * FT, p["velocities/v-down-fps"] * -FT))
        # ENU and FLU are each half a turn away from NED and FRD: yaw is mirrored, pitch changes sign with y and z.
        attitude = rotations.from_euler(p["attitude/phi-rad"], -p["attitude/theta-rad"], np.pi / 2 - p["attitude/psi-rad"])
        rates = np.array((p["velocities/p-rad_sec"], -p["velocities/q-rad_sec"], -p["velocities/r-rad_sec"]))
        force = np.array(
            (p["accelerations/Nx"] * G, p["accelerations/Ny"] * -G, p["accelerations/Nz"] * G)
        )  # at the centre of gravity, z up
        spin = np.array((p["accelerations/pdot-rad_sec2"], -p["accelerations/qdot-rad_sec2"], -p["accelerations/rdot-rad_sec2"]))
        return AircraftMotion(self.position(), velocity, attitude, rates, force, p["velocities/vt-fps"] * FT, spin)

    def position(self) -> Floats:
        """Position (3,) [m, world]."""
        p = self._properties
        x0, y0, z0 = self._origin_ecef
        x, y, z = p["position/ecef-x-ft"] * FT - x0, p["position/ecef-y-ft"] * FT - y0, p["position/ecef-z-ft"] * FT - z0
        return np.array([a * x + b * y + c * z for a, b, c in self._enu_from_ecef])  # asked for too often for matrices

    def height(self) -> float:
        """Height [m] above the ground."""
        return self._properties["position/h-agl-ft"] * FT

    def flight(self) -> AirRelativeState:
        """The state that the wind model depends on."""
        p = self._properties
        return AirRelativeState(self.position(), self.height(), np.pi / 2 - p["attitude/psi-rad"], p["velocities/vt-fps"] * FT)

    def air(self) -> Air:
        """Pressures [Pa] and temperature [K] now; the differential pressure is that of the pitot tube."""
        p = self._properties
        pitot = pitot_share(p["velocities/u-aero-fps"], p["velocities/vt-fps"]) * p["aero/qbar-psf"]
        return Air(p["atmosphere/P-psf"] * PSF, pitot * PSF, p["atmosphere/T-R"] * RANKINE)

    def accelerations(self) -> Floats:
        """(6,) derivatives of u, v, w [m/s^2] and p, q, r [rad/s^2], FRD."""
        p = self._properties
        linear = [p[f"accelerations/{axis}dot-ft_sec2"] * FT for axis in "uvw"]
        return np.array(linear + [p[f"accelerations/{axis}dot-rad_sec2"] for axis in "pqr"])

    @property
    def span(self) -> float:
        """Wing span [m]."""
        return float(self._properties["metrics/bw-ft"] * FT)

    @property
    def propulsive_force(self) -> float:
        """Force [N] of all engines along the body's x axis."""
        return float(self._properties["forces/fbx-prop-lbs"] * LBF) if self._has_engines else 0.0

    @property
    def shaft_power(self) -> float:
        """Shaft power [W] of all engines."""
        return float(sum(max(self._properties[name], 0.0) for name in self._powers) * HP)

    def motor_power(self, pack: BatteryPack | None) -> float:
        """Electric power [W] that all engines draw from the battery; 0 without one."""
        if pack is None:
            return 0.0
        return float(self._properties[pack.power]) if pack.power else self.shaft_power / pack.efficiency
