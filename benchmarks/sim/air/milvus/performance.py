"""What Milvus can do, from steady flights of the running model, beside hand calculation from its stated coefficients.

By hand: alpha and elevator solve lift = weight across the path and C_m = 0, drag is the polar there, and the motor's and the
propeller's torque are equal (Beard and McLain, supplement of 2020). ``python -m benchmarks.sim.air.milvus.performance
docs/images/milvus-performance.png`` draws climb, glide and power over airspeed.
"""

import math
import sys
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

from benchmarks.sim.air.milvus.coefficients import AREA, BODY, FOLDER, INDUCED, MASS
from services.sim_air.analysis.equilibrium import Condition, find
from services.sim_air.analysis.linear import held_still
from services.sim_air.engine.airframe import Airframe
from services.sim_air.engine.states import InitialState
from uvf.maths import atmosphere
from uvf.maths.geodesy import LocalTangent
from uvf.models.vehicle.battery import lasts

Figures = dict[str, dict[str, float]]

SPEEDS, ALTITUDES = (20.0, 25.0, 30.0), (100.0, 1000.0, 2500.0)  # m/s, m AMSL
AT_SEA_LEVEL = LocalTangent.from_degrees(40.77, 14.79, 0.0)
G = 9.80
LIMIT = 0.52  # rad, of the elevator
KQ, OHM, IDLE, VOLTS, SIZE = 60 / (2 * math.pi * 145), 0.042, 1.5, 44.4, 0.508


def density(altitude: float) -> float:
    """kg/m^3, of the standard atmosphere at an altitude [m]."""
    return atmosphere.density(atmosphere.pressure(altitude), atmosphere.T0 - atmosphere.LAPSE * altitude)


@dataclass(frozen=True)
class ByHand:
    """Balanced flight at an airspeed [m/s] in air of density rho, its path ``climb`` [rad] up, thrust along the body."""

    airspeed: float
    rho: float
    climb: float = 0.0

    @property
    def pressure_area(self) -> float:
        """N."""
        return 0.5 * self.rho * self.airspeed**2 * AREA

    def elevator(self, alpha: float) -> float:
        """rad, at which the pitching moment is zero."""
        return (0.0135 - 2.74 * alpha) / 0.99

    def lift(self, alpha: float) -> float:
        """N."""
        return self.pressure_area * (0.23 + 5.61 * alpha + 0.13 * self.elevator(alpha))

    def drag(self, alpha: float) -> float:
        """N."""
        return self.pressure_area * (0.043 + (0.23 + 5.61 * alpha) ** 2 * INDUCED + 0.0135 * abs(self.elevator(alpha)))

    def thrust_needed(self, alpha: float) -> float:
        """N, that keeps the airspeed on this path."""
        return (self.drag(alpha) + MASS * G * math.sin(self.climb)) / math.cos(alpha)

    def alpha(self, thrust: float | None = None) -> float:
        """At which lift and the thrust's share carry the weight; thrust: N, or what the path needs."""

        def missing(alpha: float) -> float:
            pull = self.thrust_needed(alpha) if thrust is None else thrust
            return self.lift(alpha) + pull * math.sin(alpha) - MASS * G * math.cos(self.climb)

        return float(brentq(missing, -0.1, 0.45))


def motor(airspeed: float, throttle: float, rho: float) -> tuple[float, float]:
    """Thrust [N] and electric power [W]."""
    volts = VOLTS * throttle
    a = rho * SIZE**5 / (2 * math.pi) ** 2 * 0.005230
    b = rho * SIZE**4 / (2 * math.pi) * 0.004970 * airspeed + KQ**2 / OHM
    c = -rho * SIZE**3 * 0.01664 * airspeed**2 - KQ * volts / OHM + KQ * IDLE
    omega = (-b + math.sqrt(b * b - 4 * a * c)) / (2 * a)
    turns = omega / (2 * math.pi)
    advance = airspeed / (turns * SIZE)
    thrust = rho * turns**2 * SIZE**4 * (0.09357 - 0.06044 * advance - 0.1079 * advance**2)
    return thrust, volts * (volts - KQ * omega) / OHM


def level_by_hand(airspeed: float, rho: float) -> tuple[float, float]:
    """Throttle and electric power [W]; the propeller meets V cos(alpha)."""
    flight = ByHand(airspeed, rho)
    alpha = flight.alpha()
    inflow, needed = airspeed * math.cos(alpha), flight.thrust_needed(alpha)
    throttle = float(brentq(lambda t: motor(inflow, t, rho)[0] - needed, 0.2, 1.5))
    return throttle, motor(inflow, throttle, rho)[1]


def glide_by_hand(airspeed: float, rho: float) -> float:
    """Glide angle [rad, negative]."""

    def left(climb: float) -> float:
        flight = ByHand(airspeed, rho, climb)
        return flight.drag(flight.alpha(0.0)) + MASS * G * math.sin(climb)

    return float(brentq(left, -0.6, 0.0))


def climb_by_hand(airspeed: float, rho: float) -> float:
    """Climb angle [rad] at full throttle."""
    alpha = 0.0

    def left(climb: float) -> float:
        flight = ByHand(airspeed, rho, climb)
        return flight.thrust_needed(flight.alpha(thrust)) - thrust

    for _ in range(5):  # the inflow depends on alpha, and alpha a little on the thrust
        thrust = motor(airspeed * math.cos(alpha), 1.0, rho)[0]
        climb = float(brentq(left, -0.6, 0.6))
        alpha = ByHand(airspeed, rho, climb).alpha(thrust)
    return climb


def slowest_by_hand(rho: float) -> float:
    """Level flight with the elevator at its stop."""
    alpha = (0.0135 + 0.99 * LIMIT) / 2.74
    return float(brentq(lambda v: ByHand(v, rho).alpha() - alpha, 12.0, 25.0))


class Running:
    """The model in JSBSim."""

    def __init__(self) -> None:
        assert BODY is not None
        self.airframe = Airframe(FOLDER, BODY, AT_SEA_LEVEL)

    def steady(self, airspeed: float, altitude: float, **fixed: float) -> Condition:
        """Level (climb=0) or with this throttle. Raises ValueError when there is no such flight."""
        return self._found(Condition(airspeed, altitude), "airspeed", **fixed)

    def _found(self, near: Condition, *names: str, **fixed: float) -> Condition:
        wanted = (*names, *fixed)
        with held_still(self.airframe):
            found = find(self.airframe, replace(near, **fixed), (wanted[0], wanted[1]))
        if found is None:
            raise ValueError(f"no steady flight with {wanted} of {near}")
        return found

    def electric_power(self) -> float:
        """W, in the flight that was found last."""
        return float(self.airframe._fdm["electric/power-w"])

    def slowest(self, altitude: float) -> float:
        """m/s, level with the elevator at its stop."""
        return self._found(self.steady(17.0, altitude, climb=0.0), elevator=-LIMIT, climb=0.0).airspeed


def trims(_: Path | None) -> Figures:
    """Level flight; the residual is the largest acceleration that is left, in m/s^2 or rad/s^2."""
    running, rows = Running(), {}
    for altitude in ALTITUDES:
        for speed in SPEEDS:
            trim = running.airframe.start(InitialState(np.array((0.0, 0.0, altitude)), 0.0, speed, np.zeros(3)))
            hand = ByHand(speed, density(altitude))
            rows[f"{speed:g} m/s, {altitude:g} m"] = {
                "residual": trim.residual,
                "alpha deg": math.degrees(trim.alpha),
                "by hand": math.degrees(hand.alpha()),
                "elevator deg": math.degrees(trim.elevator),
                "by hand ": math.degrees(hand.elevator(hand.alpha())),
                "throttle": trim.throttle,
                "by hand  ": level_by_hand(speed, density(altitude))[0],
            }
    return rows


def performance(_: Path | None) -> Figures:
    """Slowest flight [m/s], glide ratios, climb [m/s] and endurance [h]: of the running model, by hand, and the difference [%]."""
    altitude, running = 100.0, Running()
    rho = density(altitude)
    pairs = {"slowest level flight, m/s": (running.slowest(altitude), slowest_by_hand(rho))}
    for speed in (17.0, 20.0, 25.0):
        glide = running.steady(speed, altitude, throttle=0.0).climb
        pairs[f"glide ratio at {speed:g} m/s"] = (-1 / math.tan(glide), -1 / math.tan(glide_by_hand(speed, rho)))
    for speed in (18.0, 22.0, 25.0):
        climb = running.steady(speed, altitude, throttle=1.0).climb
        pairs[f"climb at {speed:g} m/s, full throttle, m/s"] = (speed * math.sin(climb), speed * math.sin(climb_by_hand(speed, rho)))
    for speed in (17.0, 20.0, 25.0):
        running.steady(speed, altitude, climb=0.0)
        by_hand = level_by_hand(speed, rho)[1]
        pairs[f"endurance at {speed:g} m/s, h"] = (endurance(running.electric_power()), endurance(by_hand))
    return {name: {"running": a, "by hand": b, "off %": 100 * abs(a / b - 1)} for name, (a, b) in pairs.items()}


def endurance(power: float) -> float:
    """h on a full battery."""
    assert BODY is not None and BODY.battery is not None
    return lasts(BODY.battery, power + BODY.battery.avionics) / 3600


def plot(path: Path) -> None:
    """Glide ratio, climb [m/s] and electric power [W] over airspeed, by hand and of the running model."""
    from matplotlib.figure import Figure

    running, altitude = Running(), 100.0
    rho, speeds, fine = density(altitude), np.arange(17.0, 35.0, 1.5), np.linspace(16.3, 35.0, 80)
    figure = Figure(figsize=(11, 3.4), layout="constrained")
    glide, climb, power = figure.subplots(1, 3)
    glide.plot(fine, [-1 / math.tan(glide_by_hand(v, rho)) for v in fine], "0.6", label="by hand")
    glide.plot(speeds, [-1 / math.tan(running.steady(v, altitude, throttle=0.0).climb) for v in speeds], ".", label="running model")
    for i, height in enumerate(ALTITUDES):
        air = density(height)
        climb.plot(fine, [v * math.sin(climb_by_hand(v, air)) for v in fine], "0.6")
        found = [v * math.sin(running.steady(v, height, throttle=1.0).climb) for v in speeds]
        climb.plot(speeds, found, ".", color=f"C{i}", label=f"{height:g} m")
    power.plot(fine, [level_by_hand(v, rho)[1] for v in fine], "0.6", label="by hand")
    found = [running.electric_power() for v in speeds if running.steady(v, altitude, climb=0.0)]
    power.plot(speeds, found, ".", label="running model")
    for axes, title in zip((glide, climb, power), ("glide ratio", "climb, full throttle [m/s]", "electric power, level [W]"), strict=True):
        axes.set(xlabel="airspeed [m/s]", title=title)
        axes.grid(alpha=0.3)
        axes.legend(fontsize=8)
    figure.savefig(path, dpi=110)


CASES = {"trims": trims, "performance": performance}

if __name__ == "__main__":
    plot(Path(sys.argv[1]))
