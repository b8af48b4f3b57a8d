"""The standard atmosphere below 11 km (ICAO 7488/3): pressure, altitude, density, airspeed."""

import math

P0 = 101_325.0  # Pa
T0 = 288.15  # K
LAPSE = 0.0065  # K/m
GAS = 287.052_87  # J/(kg K), dry air
RHO0 = P0 / (GAS * T0)  # kg/m^3
EXPONENT = 9.806_65 / (LAPSE * GAS)


def pressure(altitude: float) -> float:
    """Static pressure [Pa] at a geopotential altitude [m AMSL]."""
    return P0 * math.pow(1 - LAPSE * altitude / T0, EXPONENT)


def altitude(static_pressure: float) -> float:
    """Geopotential altitude [m AMSL] at a static pressure [Pa]; the inverse of ``pressure``."""
    return T0 / LAPSE * (1 - math.pow(static_pressure / P0, 1 / EXPONENT))


def density(static_pressure: float, temperature: float) -> float:
    """Density [kg/m^3] of dry air at a static pressure [Pa] and a temperature [K]."""
    return static_pressure / (GAS * temperature)


def airspeed(differential_pressure: float, rho: float) -> float:
    """Airspeed [m/s] from a pitot's differential pressure [Pa] in air of density ``rho`` [kg/m^3], incompressible; never negative."""
    return math.sqrt(2 * max(differential_pressure, 0.0) / rho)
