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


def standard_density(altitude: float) -> float:
    """Density [kg/m^3] of the standard atmosphere at ``altitude`` [m AMSL], in the troposphere."""
    return density(pressure(altitude), T0 - LAPSE * altitude)


def density(static_pressure: float, temperature: float) -> float:
    """Density [kg/m^3] of dry air at a static pressure [Pa] and a temperature [K]."""
    return static_pressure / (GAS * temperature)


def airspeed(differential_pressure: float, rho: float) -> float:
    """Airspeed [m/s] from a pitot's differential pressure [Pa] in air of density ``rho`` [kg/m^3], incompressible; never negative."""
    return math.sqrt(2 * max(differential_pressure, 0.0) / rho)


FT = 0.3048  # m
CEILING = 1000 * FT  # m, above which the mean wind grows no more
STRIP_ROUGHNESS = 0.15 * FT  # m, for take-off and landing (MIL-F-8785C, 3.7.3.3)


def logarithmic(height: float, roughness: float, reference: float) -> float:
    """Ratio [-] of the wind at ``height`` to that at ``reference`` [m above the ground]: MIL-F-8785C, 3.7.3.3, ln(h / z0) / ln(h_ref / z0).

    roughness: z0 [m]; the standard has that of a strip for take-off and landing, 2 ft elsewhere. Below 3 ft it falls straight to nothing.
    """
    lowest = max(3 * FT, 1.01 * roughness)
    h = min(max(height, 0.0), CEILING)
    share = min(h / lowest, 1.0)
    return share * math.log(max(h, lowest) / roughness) / math.log(reference / roughness)


def power(height: float, exponent: float, reference: float) -> float:
    """Ratio [-] of the wind at ``height`` to that at ``reference`` [m above the ground]: (h / h_ref)^exponent; 1/7 over open country."""
    return float((min(max(height, 0.0), CEILING) / reference) ** exponent)


def one_minus_cosine(flown: float, length: float) -> float:
    """Strength of a gust, 0 to 1 [-], ``flown`` [m] into its whole ``length`` [m]; 1 in its middle.

    CS 25.341(a): (1 - cos(2 pi s / length)) / 2.
    """
    return 0.5 * (1 - math.cos(2 * math.pi * flown / length)) if 0 < flown < length else 0.0
