"""Initial conditions: where and how a loaded model begins, and the air it begins in."""

from dataclasses import replace
from typing import Protocol

import numpy as np

from services.sim_air.engine.gauges import FT
from services.sim_air.engine.states import Held, InitialState
from services.sim_air.engine.trim import TrimAttitude
from services.sim_air.engine.wiring import Properties
from uvf.maths.geodesy import LocalTangent
from uvf.maths.rotations import Floats

EARTH_RATE = 7.292115e-5  # rad/s


class Engine(Properties, Protocol):
    """A loaded JSBSim model (part of FGFDMExec)."""

    def run(self) -> bool:
        """Makes one physics step."""
        ...

    def run_ic(self) -> bool:
        """Applies the initial conditions."""
        ...

    def query_property_catalog(self, check: str) -> str:
        """The catalogue of properties whose names contain ``check``, one a line."""
        ...

    def set_trim_status(self, status: bool) -> None:
        """Sets whether the model counts as being trimmed."""
        ...


def at_rest(place: InitialState, height: float) -> InitialState:
    """The state at rest in calm air with the centre of gravity at ``height`` [m, world]."""
    x, y, _ = place.position
    return replace(place, position=np.array((x, y, height)), airspeed=0.0, climb=0.0, turn_rate=0.0, wind=np.zeros(3))


def put(fdm: Engine, tangent: LocalTangent, start: InitialState, lies: TrimAttitude, spin_up: float = 0.0) -> None:
    """Places the aircraft over the terrain laid before; spin_up: time [s] for which the body will be held still."""
    latitude, longitude, altitude = tangent.geodetic(start.position)
    fdm["ic/lat-geod-rad"], fdm["ic/h-sl-ft"] = latitude, altitude / FT
    fdm["ic/long-gc-rad"] = longitude + EARTH_RATE * spin_up  # the Earth turns under a body that is held still
    fdm["ic/phi-rad"], fdm["ic/theta-rad"], fdm["ic/psi-true-rad"] = lies.roll, lies.pitch, np.pi / 2 - start.yaw + lies.yaw
    ground = start.velocity / FT
    fdm["ic/ve-fps"], fdm["ic/vn-fps"], fdm["ic/vd-fps"] = ground[0], ground[1], -ground[2]
    fdm["ic/p-rad_sec"], fdm["ic/q-rad_sec"], fdm["ic/r-rad_sec"] = lies.rates
    fdm.run_ic()


def lay_terrain(fdm: Engine, tangent: LocalTangent, x: float, y: float, height: float) -> None:
    """Sets the terrain below the start at x, y [m, world] to ``height`` [m, world]."""
    fdm["ic/terrain-elevation-ft"] = tangent.geodetic(np.array((x, y, height)))[2] / FT


def put_held(fdm: Engine, tangent: LocalTangent, held: Held) -> None:
    """Places the aircraft in a held state in calm air."""
    fdm["ic/lat-geod-rad"], fdm["ic/h-sl-ft"] = tangent.latitude, held.altitude / FT
    fdm["ic/terrain-elevation-ft"] = tangent.altitude / FT
    for name, value in zip(("phi-rad", "theta-rad", "psi-true-rad"), held.angles, strict=True):
        fdm[f"ic/{name}"] = value
    for name, value in zip("uvwpqr", (*held.velocity / FT, *held.rates), strict=True):
        fdm[f"ic/{name}-{'fps' if name in 'uvw' else 'rad_sec'}"] = value
    fdm.run_ic()


def blow(fdm: Properties, wind: Floats) -> None:
    """Sets the wind velocity (3,) [m/s, world], the direction it blows to."""
    fdm["atmosphere/wind-east-fps"] = wind[0] / FT
    fdm["atmosphere/wind-north-fps"] = wind[1] / FT
    fdm["atmosphere/wind-down-fps"] = -wind[2] / FT
