"""Linear models of a JSBSim aircraft in level flight, by central differences of the running model."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from services.sim_air.analysis.equilibrium import INPUTS, STATES, Condition, derivatives, level
from services.sim_air.engine.airframe import Airframe
from services.sim_air.engine.states import AircraftMotion
from uvf.control.design.design_models import DesignModels, design_models
from uvf.maths import rotations
from uvf.maths.eigenmodes import Mode, lateral_modes, longitudinal_modes
from uvf.maths.rotations import Floats
from uvf.maths.state_space import StateSpace, jacobian
from uvf.models.yaml_data import BadInput

LONGITUDINAL = (("u", "w", "q", "theta", "h"), ("delta_e", "delta_t"))
LATERAL = (("v", "p", "r", "phi", "psi"), ("delta_a", "delta_r"))
STATE_STEPS = (0.05, 0.05, 0.05, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3, 10.0)  # m/s, rad/s, rad, m
INPUT_STEPS = (1e-3, 1e-3, 1e-3, 1e-3)  # rad, throttle 0..1


@dataclass(frozen=True)
class LinearModels:
    """Linear models about the level flight ``trim``."""

    trim: Condition
    residual: float  # m/s^2 or rad/s^2, the largest that is left in trim
    whole: StateSpace

    @property
    def longitudinal(self) -> StateSpace:
        """The longitudinal model: states u, w, q, theta, h; inputs delta_e, delta_t."""
        return self.whole.part(*LONGITUDINAL)

    @property
    def lateral(self) -> StateSpace:
        """The lateral model: states v, p, r, phi, psi; inputs delta_a, delta_r."""
        return self.whole.part(*LATERAL)

    @property
    def modes(self) -> list[Mode]:
        """The longitudinal and lateral modes."""
        return [*longitudinal_modes(self.longitudinal.a), *lateral_modes(self.lateral.a)]

    @property
    def design(self) -> DesignModels:
        """The transfer-function coefficients of the design models."""
        return design_models(self.longitudinal, self.lateral, self.trim.airspeed, self.trim.alpha)


@contextmanager
def held_still(airframe: Airframe) -> Iterator[Airframe]:
    """Holds the motion of the body while the engine runs on, within the context."""
    airframe.hold_still(True)
    try:
        yield airframe
    finally:
        airframe.hold_still(False)


def linearize(airframe: Airframe, airspeed: float, altitude: float, path: Path) -> LinearModels:
    """Linear models about level flight at ``airspeed`` [m/s] and ``altitude`` [m AMSL].

    ``path`` names the model in errors. Raises BadInput when there is no such flight.
    """
    with held_still(airframe):
        trim = level(airframe, airspeed, altitude)
        if trim is None:
            raise BadInput(f"{path}: no level flight at {airspeed:g} m/s and {altitude:g} m; try another --speed")
        return about(airframe, trim)


def about(airframe: Airframe, trim: Condition) -> LinearModels:
    """Linear models about ``trim`` of a body that is held still."""
    a = jacobian(lambda x: derivatives(airframe, x, trim.inputs), trim.state, STATE_STEPS)
    b = jacobian(lambda u: derivatives(airframe, trim.state, u), trim.inputs, INPUT_STEPS)
    residual = float(np.abs(derivatives(airframe, trim.state, trim.inputs)[:6]).max())
    return LinearModels(trim, residual, StateSpace(a, b, STATES, INPUTS))


def state_of(motion: AircraftMotion, altitude: float) -> Floats:
    """State (10,) in the order of STATES [m/s, rad/s, rad, m AMSL] over a world origin at ``altitude`` [m AMSL], in calm air."""
    roll, pitch, yaw = rotations.to_euler(motion.world_from_body)
    flip = np.array((1.0, -1.0, -1.0))
    velocity = rotations.matrix(motion.world_from_body).T @ motion.velocity * flip
    rates = motion.angular_velocity * flip
    return np.array((*velocity, *rates, roll, -pitch, np.pi / 2 - yaw, motion.position[2] + altitude))
