"""FlightGear's native FDM packet: ``FGNetFDM`` version 24, 408 bytes in network byte order.

Fields and units as in FlightGear's src/Network/net_fdm.hxx: rad, metres for the position, feet and knots for what moves.
"""

import struct
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvf.maths import atmosphere

Floats = NDArray[np.float64]

VERSION = 24
FT, KNOT = 0.3048, 1852 / 3600  # m, m/s
RUNNING = 2
VISIBILITY = 25_000.0  # m
STILL = 0.1  # m/s, below which the air comes from nowhere
_LAYOUT = struct.Struct(
    ">I4x"  # version, padding
    "3d 6f"  # longitude, latitude, altitude; agl, phi, theta, psi, alpha, beta
    "3f 2f"  # phidot, thetadot, psidot; vcas, climb_rate
    "3f 3f 3f"  # v_north, v_east, v_down; v_body_u, v, w; A_X, A_Y, A_Z of the pilot
    "2f"  # stall_warning, slip_deg
    "I 4I 4f 32f"  # num_engines, eng_state, rpm; fuel, temperatures and pressures of four engines
    "I 4f"  # num_tanks, fuel_quantity
    "I 3I 9f"  # num_wheels, wow; gear_pos, gear_steer, gear_compression
    "I i f"  # cur_time, warp, visibility
    "10f"  # elevator, its trim tab, left and right flap, left and right aileron, rudder, nose wheel, speed brake, spoilers
)
SIZE = _LAYOUT.size


@dataclass(frozen=True)
class Seen:
    """The state that FlightGear displays: angles [rad], vectors [m/s, rad/s, m/s^2] in NED or FRD."""

    latitude: float
    longitude: float
    altitude: float  # m AMSL
    height: float  # m above the ground
    attitude: tuple[float, float, float]  # roll, pitch, heading
    rates: Floats  # (3,) rad/s, body
    velocity: Floats  # (3,) m/s, NED, over ground
    velocity_body: Floats  # (3,) m/s, FRD, over ground
    through_air: Floats  # (3,) m/s, FRD
    specific_force: Floats  # (3,) m/s^2, FRD
    rpm: float
    surfaces: tuple[float, ...]
    """Elevator, left and right flap, left and right aileron, rudder: -1..1, positive = trailing edge down, or left."""


def packet(seen: Seen) -> bytes:
    """One FDM packet as bytes; FlightGear counts rudder to the right as positive."""
    u, v, w = seen.through_air
    airspeed = float(np.linalg.norm(seen.through_air))
    alpha, beta = (np.arctan2(w, u), np.arcsin(v / airspeed)) if airspeed > STILL else (0.0, 0.0)
    elevator, left_flap, right_flap, left_aileron, right_aileron, rudder = seen.surfaces
    engine = (1, RUNNING if seen.rpm else 0, 0, 0, 0, seen.rpm, 0.0, 0.0, 0.0)
    return _LAYOUT.pack(
        VERSION,
        *(seen.longitude, seen.latitude, seen.altitude),
        *(seen.height, *seen.attitude, alpha, beta),
        *euler_rates(seen.attitude, seen.rates),
        *(calibrated(airspeed, seen.altitude) / KNOT, -seen.velocity[2] / FT),
        *(seen.velocity / FT),
        *(seen.velocity_body / FT),
        *(seen.specific_force / FT),
        *(0.0, np.degrees(beta)),
        *engine,
        *(0.0,) * 32,
        *(0, 0.0, 0.0, 0.0, 0.0),
        *(0, 0, 0, 0),
        *(0.0,) * 9,
        *(0, 0, VISIBILITY),
        *(elevator, 0.0, left_flap, right_flap, left_aileron, right_aileron, -rudder, -rudder, 0.0, 0.0),
    )


def euler_rates(attitude: tuple[float, float, float], rates: Floats) -> tuple[float, float, float]:
    """Rates of roll, pitch and heading [rad/s] from the attitude (roll, pitch, heading) [rad] and body rates (3,) [rad/s, FRD].

    Beard & McLain (3.3).
    """
    roll, pitch, _ = attitude
    p, q, r = rates
    turn = q * np.sin(roll) + r * np.cos(roll)
    return float(p + turn * np.tan(pitch)), float(q * np.cos(roll) - r * np.sin(roll)), float(turn / np.cos(pitch))


def calibrated(airspeed: float, altitude: float) -> float:
    """Calibrated airspeed [m/s] from the true ``airspeed`` [m/s] at ``altitude`` [m AMSL], in the standard atmosphere.

    Far below the speed of sound it equals the equivalent airspeed.
    """
    static = atmosphere.pressure(altitude)
    rho = atmosphere.density(static, atmosphere.T0 - atmosphere.LAPSE * altitude)
    return airspeed * float(np.sqrt(rho / atmosphere.RHO0))
