"""One aircraft in JSBSim: the only file that imports it and knows feet, pounds and its property names."""

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from services.sim_air.model_file import check_model, properties_read
from services.sim_air.trim import Trim, solve
from uvf.maths import rotations
from uvf.maths.geodesy import LocalTangent, ecef_from_geodetic
from uvf.runtime.params import BadInput
from uvf.runtime.quiet import c_output_discarded
from uvf.runtime.vehicle_file import AirBody

os.environ.setdefault("JSBSIM_DEBUG", "0")  # read when the engine is made: without it a banner goes to the output
import jsbsim

Floats = rotations.Floats

FT = 0.3048  # m
LBF = 4.4482216152605  # N
HP = 745.6998715822702  # W
PSF = 47.88025898033584  # Pa
RANKINE = 5 / 9  # K
SPIN_UP = 3.0  # s, after which a propeller turns steadily while the body is held still
EARTH_RATE = 7.292115e-5  # rad/s
INTEGRATORS = tuple(
    f"simulation/integrator/{kind}" for kind in ("rate/rotational", "rate/translational", "position/rotational", "position/translational")
)
DERIVATIVES = ("u", "v", "w", "p", "q", "r")


@dataclass(frozen=True)
class Motion:
    """What is true now. World frame ENU, body frame FLU."""

    position: Floats  # (3,) m
    velocity: Floats  # (3,) m/s over ground
    world_from_body: Floats  # (4,) wxyz
    angular_velocity: Floats  # (3,) rad/s, body
    specific_force: Floats  # (3,) m/s^2, body
    airspeed: float  # m/s


@dataclass(frozen=True)
class Air:
    """The air about the aircraft."""

    static_pressure: float  # Pa
    differential_pressure: float  # Pa, of the pitot tube
    temperature: float  # K


@dataclass(frozen=True)
class Controls:
    """Deflections [rad] with the signs of SurfaceCommand, throttle 0..1."""

    aileron: float = 0.0
    elevator: float = 0.0
    rudder: float = 0.0
    throttle: float = 0.0


@dataclass(frozen=True)
class Start:
    """Level flight at ``airspeed`` [m/s] from ``position`` [m, world] towards ``yaw`` [rad, world] in a steady ``wind`` [m/s, world]."""

    position: Floats
    yaw: float
    airspeed: float
    wind: Floats


class Airframe:
    """A JSBSim model, flying, held at the commands it was last given."""

    def __init__(self, folder: Path, body: AirBody, tangent: LocalTangent) -> None:
        self._body = body
        self._tangent = tangent
        self._enu_from_ecef = tangent.enu_from_ecef
        self._origin_ecef = ecef_from_geodetic(tangent.latitude, tangent.longitude, tangent.altitude)
        self._path = folder / body.model / f"{body.model}.xml"
        self._fdm = _load(folder, self._path, body)
        self._integrators = {name: self._fdm[name] for name in INTEGRATORS}

    def start(self, start: Start) -> Trim:
        """Puts the aircraft into trimmed level flight. Raises BadInput when it cannot fly so."""
        try:
            with c_output_discarded():
                trim = self._trim(start)
        except jsbsim.BaseError as error:
            raise _refusal(self._path, error) from error
        if not trim.converged:
            raise BadInput(f"{self._path}: no level flight at {start.airspeed} m/s: {trim.residual:.2g} m/s^2 or rad/s^2 are left")
        return trim

    def _trim(self, start: Start) -> Trim:
        self.hold_still(True)
        trim = solve(lambda guess: self.accelerations(start, guess))
        self.accelerations(start, trim)
        self.hold_still(False)
        return trim

    def hold_still(self, still: bool) -> None:
        """Stops the motion of the body while the engine turns on, or lets it go."""
        for name, method in self._integrators.items():
            self._fdm[name] = 0 if still else method

    def accelerations(self, start: Start, trim: Trim) -> Floats:
        """(6,) body accelerations [m/s^2, rad/s^2] once the propeller turns steadily, the body held in this state."""
        fdm = self._fdm
        self._place(start, trim)
        self.command(Controls(trim.aileron, trim.elevator, trim.rudder, trim.throttle))
        for _ in range(round(SPIN_UP * self._body.physics_hz)):
            fdm.run()
        units = (FT, FT, FT, 1.0, 1.0, 1.0)
        return np.array([fdm[f"accelerations/{d}dot-{'ft' if i < 3 else 'rad'}_sec2"] * units[i] for i, d in enumerate(DERIVATIVES)])

    def _place(self, start: Start, trim: Trim) -> None:
        fdm = self._fdm
        latitude, longitude, altitude = self._tangent.geodetic(start.position)
        fdm["ic/lat-geod-rad"], fdm["ic/h-sl-ft"] = latitude, altitude / FT
        fdm["ic/terrain-elevation-ft"] = self._tangent.altitude / FT
        fdm["ic/long-gc-rad"] = longitude + EARTH_RATE * SPIN_UP  # the Earth turns under a body that is held still
        fdm["ic/phi-rad"], fdm["ic/theta-rad"], fdm["ic/psi-true-rad"] = trim.roll, trim.alpha, np.pi / 2 - start.yaw
        ground = start.airspeed * np.array((np.cos(start.yaw), np.sin(start.yaw), 0.0)) + start.wind
        fdm["ic/ve-fps"], fdm["ic/vn-fps"], fdm["ic/vd-fps"] = ground[0] / FT, ground[1] / FT, -ground[2] / FT
        fdm.run_ic()
        fdm["propulsion/set-running"] = -1
        self.blow(start.wind)

    def blow(self, wind: Floats) -> None:
        """Sets the velocity of the air [m/s, world]."""
        self._fdm["atmosphere/wind-east-fps"] = wind[0] / FT
        self._fdm["atmosphere/wind-north-fps"] = wind[1] / FT
        self._fdm["atmosphere/wind-down-fps"] = -wind[2] / FT

    def command(self, controls: Controls) -> None:
        fdm, body = self._fdm, self._body
        fdm["fcs/aileron-cmd-norm"] = controls.aileron / body.max_aileron
        fdm["fcs/elevator-cmd-norm"] = controls.elevator / body.max_elevator
        fdm["fcs/rudder-cmd-norm"] = controls.rudder / body.max_rudder
        fdm["fcs/throttle-cmd-norm"] = controls.throttle

    def step(self) -> None:
        """One physics step of 1 / physics_hz."""
        self._fdm.run()

    def motion(self) -> Motion:
        fdm = self._fdm
        ecef = np.array((fdm["position/ecef-x-ft"], fdm["position/ecef-y-ft"], fdm["position/ecef-z-ft"])) * FT
        velocity = np.array((fdm["velocities/v-east-fps"], fdm["velocities/v-north-fps"], -fdm["velocities/v-down-fps"])) * FT
        # ENU and FLU are each half a turn away from NED and FRD: yaw is mirrored, pitch changes sign with y and z.
        attitude = rotations.from_euler(fdm["attitude/phi-rad"], -fdm["attitude/theta-rad"], np.pi / 2 - fdm["attitude/psi-rad"])
        rates = np.array((fdm["velocities/p-rad_sec"], -fdm["velocities/q-rad_sec"], -fdm["velocities/r-rad_sec"]))
        force = np.array([fdm[f"accelerations/a-pilot-{axis}-ft_sec2"] for axis in "xyz"]) * (FT, -FT, -FT)
        return Motion(self._enu_from_ecef @ (ecef - self._origin_ecef), velocity, attitude, rates, force, fdm["velocities/vt-fps"] * FT)

    def air(self) -> Air:
        fdm = self._fdm
        return Air(fdm["atmosphere/P-psf"] * PSF, fdm["aero/qbar-psf"] * PSF, fdm["atmosphere/T-R"] * RANKINE)

    @property
    def propeller_speed(self) -> float:
        """rad/s."""
        return float(self._fdm["propulsion/engine/propeller-rpm"] * np.pi / 30)

    @property
    def shaft_power(self) -> float:
        """W."""
        return float(max(self._fdm["propulsion/engine/power-hp"], 0.0) * HP)


def _load(folder: Path, path: Path, body: AirBody) -> jsbsim.FGFDMExec:
    """The model at ``path`` = ``folder``/<model>/<model>.xml, with engines in ``folder``/engine. Raises BadInput."""
    if not path.is_file():
        raise BadInput(f"{folder / 'vehicle.yaml'}: air: model: there is no {body.model}/{body.model}.xml")
    check_model(path)
    fdm = jsbsim.FGFDMExec(str(folder))
    fdm.set_debug_level(0)
    try:
        with c_output_discarded():
            loaded = fdm.load_model_with_paths(body.model, ".", "engine", "systems")
    except jsbsim.BaseError as error:
        raise _refusal(path, error) from error
    if not loaded:
        raise BadInput(f"{path}: JSBSim refuses it; look at its <file=...> names, engine and sections")
    _check_properties(path, fdm)
    fdm.set_dt(1 / body.physics_hz)
    return fdm


def _check_properties(path: Path, fdm: jsbsim.FGFDMExec) -> None:
    """Whatever the model reads is there. Raises BadInput."""
    manager = fdm.get_property_manager()
    missing = [name for name in properties_read(path) if not manager.hasNode(name)]
    for name in missing:
        fdm[name] = 0.0  # the engine aborts the process when it is taken down without it, not only when it flies
    if missing:
        raise BadInput(f"{path}: nothing makes the property '{missing[0]}'; mend its name")


def _refusal(path: Path, error: Exception) -> BadInput:
    """What the engine says in several lines, as one."""
    return BadInput(f"{path}: JSBSim refuses it: {' '.join(str(error).split())}")
