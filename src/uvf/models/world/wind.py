"""``wind:`` of a world or a mission: steady wind with shear, single gusts and turbulence, as data."""

import math
from itertools import pairwise
from typing import Annotated, Literal

import msgspec
from msgspec import Meta

from uvf.maths.dryden import W20
from uvf.models.keys import key, plain
from uvf.models.yaml_data import BadInput, FileLocation

WindSpeed = Annotated[float, Meta(ge=-100, le=100)]
Velocity = tuple[WindSpeed, WindSpeed, WindSpeed]
Metres = Annotated[float, Meta(ge=-1e5, le=1e5)]
Reference = Annotated[float, Meta(ge=1, le=300)]


class Shear(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """How the steady wind grows with height: by the logarithm of MIL-F-8785C (3.7.3.3), or by a power of the height."""

    law: Annotated[Literal["logarithmic", "power"], plain("`logarithmic` (MIL-F-8785C, 3.7.3.3) or `power` of the height.")]
    roughness: Annotated[
        float, Meta(ge=1e-4, le=3), key("m", "Roughness length z0; 0.61 m is 2 ft, take-off and landing 0.046 m (0.15 ft).")
    ] = 0.61
    exponent: Annotated[float, Meta(gt=0, le=1), key("", "Exponent of the power law.")] = 1 / 7
    height: Annotated[Reference, key("m", "Height above the ground at which the wind is the steady one; 20 ft by default.")] = 6.096


class Gust(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One minus cosine (CS 25.341): met by every aircraft at a ``time``, or standing at a ``place`` as a round column of air.

    length: total length along the flight path, twice the standard's gradient distance H.
    """

    velocity: Annotated[Velocity, plain("Velocity of the air in the middle of the gust [m/s], ENU, pointing where the wind blows to.")]
    length: Annotated[float, Meta(ge=1, le=10_000), key("m", "Total length along the flight path, twice the distance H of CS 25.341.")]
    time: Annotated[
        Annotated[float, Meta(ge=0, le=1e6)] | None,
        key("s", "Simulation time at which every aircraft meets it; give either `time` or `place`."),
    ] = None
    place: Annotated[tuple[Metres, Metres] | None, plain("Middle of a standing round column of air, x, y [m], world frame.")] = None


class TurbulenceFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Dryden's form after MIL-F-8785C, see ``uvf.maths.dryden``."""

    severity: Annotated[Literal["light", "moderate", "severe"], plain("Severity after MIL-F-8785C; it sets `w20`.")] = "light"
    w20: Annotated[
        Annotated[float, Meta(ge=0, le=60)] | None,
        key("m/s", "Wind at 20 ft that sets the intensity. Left out: 15, 30 or 45 knots by the severity."),
    ] = None

    @property
    def at_20_feet(self) -> float:
        """Wind speed [m/s] at 20 feet above the ground."""
        return W20[self.severity] if self.w20 is None else self.w20


class WindChange(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The steady wind becomes another one, in a straight line over some time."""

    at: Annotated[float, Meta(ge=0, le=1e6), key("s", "Simulation time at which it begins to change.")]
    steady: Annotated[Velocity, plain("Velocity of the air that it comes to [m/s], ENU, pointing where the wind blows to.")]
    over: Annotated[float, Meta(ge=0, le=1e6), key("s", "Time that the change takes.")] = 0.0


class WindBegin(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """When and where all of the wind begins: before that time and below that height the air is at rest."""

    time: Annotated[float, Meta(ge=0, le=1e6), key("s", "Simulation time at which it begins.")] = 0.0
    over: Annotated[float, Meta(ge=0, le=1e6), key("s", "Time in which it comes up.")] = 5.0
    height: Annotated[float, Meta(ge=0, le=1e4), key("m", "Height above the ground below which there is none.")] = 0.0
    layer: Annotated[float, Meta(ge=0, le=1e4), key("m", "Heights above that over which it comes up.")] = 10.0


class Wind(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Velocity of the air [m/s], ENU, pointing where the wind blows to."""

    steady: Annotated[Velocity, plain("Velocity of the air [m/s], ENU, pointing where the wind blows to.")] = (0.0, 0.0, 0.0)
    shear: Annotated[Shear | None, plain("How the steady wind grows with height.")] = None
    begins: Annotated[WindBegin | None, plain("When and where it begins; left out: at once and everywhere.")] = None
    changes: Annotated[list[WindChange], plain("Other steady winds that come up later, in the order of their times.")] = []
    gusts: Annotated[list[Gust], plain("Single gusts, one minus cosine.")] = []
    turbulence: Annotated[TurbulenceFile | None, plain("Dryden turbulence.")] = None


def check_wind(wind: Wind, place: FileLocation) -> None:
    """Checks a wind for what its types do not say. Raises BadInput."""
    shear = wind.shear
    if shear is not None and shear.law == "logarithmic" and shear.height <= math.e * shear.roughness:
        raise BadInput(f"{place.at('shear')}: height {shear.height:g} m is within the roughness of {shear.roughness:g} m; raise it")
    for i, (before, change) in enumerate(pairwise(wind.changes), start=1):
        if change.at < before.at + before.over:
            raise BadInput(f"{place.at('changes', i, 'at')}: {change.at:g} s is before the change ahead of it has ended")
    for i, gust in enumerate(wind.gusts):
        if (gust.time is None) == (gust.place is None):
            raise BadInput(f"{place.at('gusts', i)}: give either the time at which it is met or the place where it stands")
