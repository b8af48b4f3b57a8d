"""``wind:`` of a world or a mission: steady wind with shear, single gusts and turbulence, as data."""

import math
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from uvf.maths.dryden import W20
from uvf.models.yaml_data import BadInput, FileLocation

WindSpeed = Annotated[float, Meta(ge=-100, le=100)]
Velocity = tuple[WindSpeed, WindSpeed, WindSpeed]
Metres = Annotated[float, Meta(ge=-1e5, le=1e5)]
Reference = Annotated[float, Meta(ge=1, le=300)]


class Shear(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """How the steady wind grows with height: by the logarithm of MIL-F-8785C (3.7.3.3), or by a power of the height."""

    law: Literal["logarithmic", "power"]
    roughness: Annotated[float, Meta(ge=1e-4, le=3)] = 0.61  # m, z0: 2 ft; take-off and landing 0.046 m (0.15 ft)
    exponent: Annotated[float, Meta(gt=0, le=1)] = 1 / 7
    height: Reference = 6.096  # m above the ground at which the wind is the steady one (20 ft)


class Gust(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One minus cosine (CS 25.341): met by every aircraft at a ``time``, or standing at a ``place`` as a round column of air.

    length: the whole of it along the flight, twice the standard's gradient distance H.
    """

    velocity: Velocity  # m/s, ENU, in the middle
    length: Annotated[float, Meta(ge=1, le=10_000)]  # m
    time: Annotated[float, Meta(ge=0, le=1e6)] | None = None  # s
    place: tuple[Metres, Metres] | None = None  # m, world


class TurbulenceFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Dryden's form after MIL-F-8785C, see ``uvf.maths.dryden``."""

    severity: Literal["light", "moderate", "severe"] = "light"
    w20: Annotated[float, Meta(ge=0, le=60)] | None = None  # m/s at 20 ft; left out: 15, 30 or 45 knots by the severity

    @property
    def at_20_feet(self) -> float:
        """m/s."""
        return W20[self.severity] if self.w20 is None else self.w20


class Wind(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Velocity of the air, the way it blows to, ENU [m/s]."""

    steady: Velocity = (0.0, 0.0, 0.0)
    shear: Shear | None = None
    gusts: list[Gust] = []
    turbulence: TurbulenceFile | None = None


def check_wind(wind: Wind, place: FileLocation) -> None:
    """Raises BadInput."""
    shear = wind.shear
    if shear is not None and shear.law == "logarithmic" and shear.height <= math.e * shear.roughness:
        raise BadInput(f"{place.at('shear')}: height {shear.height:g} m is within the roughness of {shear.roughness:g} m; raise it")
    for i, gust in enumerate(wind.gusts):
        if (gust.time is None) == (gust.place is None):
            raise BadInput(f"{place.at('gusts', i)}: give either the time at which it is met or the place where it stands")
