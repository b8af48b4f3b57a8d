"""What the loops of an aircraft are designed for: its linear models at an airspeed, its servos, its delays and its sensors."""

from dataclasses import dataclass, replace

from uvf.maths.state_space import Floats, StateSpace

DEAD_TIME = 0.03  # s: a sample of the IMU, a cycle of the autopilot and half of one that the servos hold
GYRO_TIME, FORCE_TIME, AIRSPEED_TIME = 0.02, 0.15, 0.25  # s, of the estimator's filters


@dataclass(frozen=True)
class ActuatorDelays:
    """Time constants [s] of what the autopilot moves: of the servo, and of the aircraft's own control system or engine behind it.

    dead_time: [s], from the motion to the command that the servo holds.
    """

    aileron: tuple[float, float] = (0.05, 0.0)
    elevator: tuple[float, float] = (0.05, 0.0)
    rudder: tuple[float, float] = (0.05, 0.0)
    throttle: tuple[float, float] = (0.0, 0.0)
    dead_time: float = DEAD_TIME

    def slower(self, factor: float) -> "ActuatorDelays":
        """With all time constants times ``factor``."""
        a, e, r, t = ((factor * servo, factor * model) for servo, model in (self.aileron, self.elevator, self.rudder, self.throttle))
        return ActuatorDelays(a, e, r, t, self.dead_time)

    def total(self, name: str) -> float:
        """s, from the motion to the surface ``name`` that answers it."""
        return float(sum(getattr(self, name))) + self.dead_time + GYRO_TIME


@dataclass(frozen=True)
class FlightCondition:
    """Level flight. longitudinal: u, w, q, theta, h by delta_e, delta_t; lateral: v, p, r, phi, psi by delta_a, delta_r."""

    airspeed: float  # m/s, true
    eas: float  # m/s, equivalent
    alpha: float  # rad
    longitudinal: StateSpace
    lateral: StateSpace
    ground_speed: float  # m/s
    span: float  # m


def scaled(model: StateSpace, factors: dict[tuple[str, str], float]) -> StateSpace:
    """The model with derivatives d(state')/d(by) times these factors; by: a state or an input."""
    a, b = model.a.copy(), model.b.copy()
    for (state, by), factor in factors.items():
        row = model.states.index(state)
        part: Floats = a if by in model.states else b
        column = model.states.index(by) if by in model.states else model.inputs.index(by)
        part[row, column] *= factor
    return replace(model, a=a, b=b)
