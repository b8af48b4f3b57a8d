"""Mean wind over height, and single gusts in the shape of one minus a cosine."""

import math

FT = 0.3048  # m
CEILING = 1000 * FT  # m, above which the mean wind grows no more


def logarithmic(height: float, roughness: float, reference: float) -> float:
    """Ratio [-] of the wind at ``height`` to that at ``reference`` [m above the ground]: MIL-F-8785C, 3.7.3.3, ln(h / z0) / ln(h_ref / z0).

    roughness: z0 [m]; the standard has 0.15 ft for take-off and landing, 2 ft elsewhere. Below 3 ft it falls straight to nothing.
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
