"""The coefficients of the running Milvus by finite differences, beside the published ones.

The body is held in a state in JSBSim; forces and moments follow from its accelerations, mass and inertia, not from the model's own
properties. ``python -m benchmarks.sim.air.milvus.coefficients docs/images/milvus-coefficients.png`` draws lift, drag and pitching moment.
"""

import sys
from dataclasses import astuple, dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from services.sim_air.engine.airframe import Airframe
from services.sim_air.engine.states import Held
from services.sim_air.engine.wiring import Controls
from uvf.maths import atmosphere
from uvf.maths.geodesy import LocalTangent
from uvf.models.scenario import ROOT
from uvf.models.vehicle.file import load_vehicle

Floats = NDArray[np.float64]

FOLDER = Path(ROOT) / "vehicles" / "milvus"
BODY = load_vehicle(FOLDER.parent, "milvus").air
TANGENT = LocalTangent.from_degrees(40.77, 14.79, 300.0)
MASS, AREA, SPAN, CHORD = 11.0, 0.55, 2.8956, 0.18994
INERTIA = np.array(((0.8244, 0.0, -0.1204), (0.0, 1.135, 0.0), (-0.1204, 0.0, 1.759)))
AIRSPEED, ALTITUDE = 25.0, 800.0  # m/s, m AMSL
NAMES = ("CL", "CD", "Cm", "CY", "Cl", "Cn")
INDUCED = 1 / (np.pi * 0.9 * SPAN**2 / AREA)

# Beard and McLain, supplement of 2020, table E.2; the flaps' from docs/explanation/milvus.md.
STATED = {
    "CL_alpha": 5.61,
    "CL_q": 7.95,
    "CL_elevator": 0.13,
    "CL_flap": 0.96,
    "Cm_alpha": -2.74,
    "Cm_q": -38.21,
    "Cm_elevator": -0.99,
    "Cm_flap": -0.11,
    "CY_beta": -0.98,
    "CY_aileron": 0.075,
    "CY_rudder": 0.19,
    "Cl_beta": -0.13,
    "Cl_p": -0.51,
    "Cl_r": 0.25,
    "Cl_aileron": 0.17,
    "Cl_rudder": 0.0024,
    "Cn_beta": 0.073,
    "Cn_p": 0.069,
    "Cn_r": -0.095,
    "Cn_aileron": -0.011,
    "Cn_rudder": -0.069,
}


@dataclass(frozen=True)
class Point:
    """Angles and deflections [rad]; p, q, r are the book's: times b / 2V, c / 2V, b / 2V."""

    alpha: float = 0.06
    beta: float = 0.0
    p: float = 0.0
    q: float = 0.0
    r: float = 0.0
    aileron: float = 0.0
    elevator: float = -0.15
    rudder: float = 0.0
    flap: float = 0.0


class HeldMilvus:
    """Milvus without thrust, held in any state."""

    def __init__(self) -> None:
        assert BODY is not None
        self.airframe = Airframe(FOLDER, BODY, TANGENT)
        self.airframe.hold_still(True)
        static = atmosphere.pressure(ALTITUDE)
        self._dynamic = 0.5 * atmosphere.density(static, atmosphere.T0 - atmosphere.LAPSE * ALTITUDE) * AIRSPEED**2

    def coefficients(self, point: Point) -> Floats:
        """(6,) in the order of NAMES: equations 4.6 to 4.8 and 4.14 to 4.16 solved for the coefficients."""
        alpha, beta, p, q, r, *surfaces = astuple(point)
        velocity = AIRSPEED * np.array((np.cos(alpha) * np.cos(beta), np.sin(beta), np.sin(alpha) * np.cos(beta)))
        rates = 2 * AIRSPEED * np.array((p / SPAN, q / CHORD, r / SPAN))
        aileron, elevator, rudder, flap = surfaces
        controls = Controls(aileron, elevator, rudder, 0.0, flap)
        moved = self.airframe.accelerations_held(Held(velocity, rates, np.zeros(3), ALTITUDE), controls)
        force = MASS * (moved[:3] + np.cross(rates, velocity) - (0.0, 0.0, 9.80))
        force[0] -= self.airframe.propulsive_force
        moment = INERTIA @ moved[3:] + np.cross(rates, INERTIA @ rates)
        x, y, z = force / (self._dynamic * AREA)
        roll, pitch, yaw = moment / (self._dynamic * AREA * np.array((SPAN, CHORD, SPAN)))
        lift, drag = x * np.sin(alpha) - z * np.cos(alpha), -x * np.cos(alpha) - z * np.sin(alpha)
        return np.array((lift, drag, pitch, y, roll, yaw))

    def slopes(self, name: str, step: float = 0.002) -> dict[str, float]:
        """Change of each coefficient per unit of one field of Point."""
        at = Point(flap=0.1) if name == "flap" else Point()
        up, down = (self.coefficients(replace(at, **{name: getattr(at, name) + sign * step})) for sign in (1, -1))
        return dict(zip(NAMES, ((up - down) / (2 * step)).tolist(), strict=True))


def measured() -> dict[str, float]:
    """What STATED names, of the running model."""
    held = HeldMilvus()
    slopes = {name: held.slopes(name) for name in {key.split("_")[1] for key in STATED}}
    return {key: slopes[key.split("_")[1]][key.split("_")[0]] for key in STATED}


def stated_lift(alpha: Floats) -> Floats:
    """Equations 4.9 and 4.10, M = 50, alpha_0 = 0.47 rad."""
    return (1 - stalled(alpha)) * (0.23 + 5.61 * alpha) + stalled(alpha) * 2 * np.sign(alpha) * np.sin(alpha) ** 2 * np.cos(alpha)


def stated_drag(alpha: Floats) -> Floats:
    """Equation 4.11 blended into the drag of a flat plate."""
    return 0.043 + (1 - stalled(alpha)) * (0.23 + 5.61 * alpha) ** 2 * INDUCED + stalled(alpha) * 2 * np.abs(np.sin(alpha)) ** 3


def stated_pitch(alpha: Floats) -> Floats:
    """C_m without rates and deflections, in stall that of a flat plate."""
    return 0.0135 - 2.74 * ((1 - stalled(alpha)) * alpha + stalled(alpha) * np.sin(alpha))


def stalled(alpha: Floats) -> Floats:
    """sigma(alpha) of equation 4.10, as the two logistic functions that it is made of."""
    return 1 - 0.25 * (1 + np.tanh(25 * (0.47 - alpha))) * (1 + np.tanh(25 * (0.47 + alpha)))


def plot(path: Path) -> None:
    """Lift, drag and pitching moment over all angles of attack [deg], stated and of the running model."""
    from matplotlib.figure import Figure

    held = HeldMilvus()
    alphas = np.radians(np.arange(-180.0, 180.1, 2.5))
    measured_at = np.array([held.coefficients(Point(alpha=float(a), elevator=0.0)) for a in alphas])
    fine = np.linspace(-np.pi, np.pi, 1441)
    figure = Figure(figsize=(10, 3.4), layout="constrained")
    for i, (axes, stated) in enumerate(zip(figure.subplots(1, 3), (stated_lift, stated_drag, stated_pitch), strict=True)):
        axes.plot(np.degrees(fine), stated(fine), color="0.6", label="stated")
        axes.plot(np.degrees(alphas), measured_at[:, i], ".", ms=3, color="C0", label="running model")
        axes.set(xlabel="alpha [deg]", title=("C_L", "C_D", "C_m")[i], xticks=range(-180, 181, 60))
        axes.grid(alpha=0.3)
    figure.axes[0].legend(fontsize=8)
    figure.savefig(path, dpi=110)


def derivatives(_: Path | None) -> dict[str, dict[str, float]]:
    """A row for each coefficient: stated, of the running model, and the difference [%]."""
    return {
        name: {"stated": STATED[name], "running": value, "off %": 100 * abs(value / STATED[name] - 1)} for name, value in measured().items()
    }


CASES = {"derivatives": derivatives}

if __name__ == "__main__":
    plot(Path(sys.argv[1]))
