"""How late a model's own control system and engine are: filters, actuators and spinning-up behind the command."""

import numpy as np

from services.sim_air.analysis.equilibrium import Condition
from services.sim_air.engine.airframe import Airframe
from services.sim_air.engine.states import Held
from services.sim_air.engine.wiring import Controls

STEPS = {"aileron": 0.02, "elevator": 0.02, "rudder": 0.02, "throttle": 0.1}  # rad; 0..1
FELT = {"aileron": 3, "elevator": 4, "rudder": 5, "throttle": 0}  # of u', v', w', p', q', r'
WATCHED = {"aileron": 2.0, "elevator": 2.0, "rudder": 2.0, "throttle": 10.0}  # s, after which it has arrived
LEAST = 1e-4  # m/s^2 or rad/s^2, of an effect
CLOSE = 0.002  # s, that are the steps' own


def lags(airframe: Airframe, trim: Condition, hz: float) -> dict[str, float]:
    """Mean delay [s] between a command and its effect, by control, of a body held in ``trim``; 0 where it has none or no effect.

    That is the area between the step and its response (Elmore's delay); hz: physics steps a second. Call ``hold_still`` before.
    """
    return {name: _lag(airframe, trim, name, hz) for name in STEPS}


def _lag(airframe: Airframe, trim: Condition, name: str, hz: float) -> float:
    at = {"aileron": trim.aileron, "elevator": trim.elevator, "rudder": trim.rudder, "throttle": trim.throttle}
    towards = STEPS[name] if at[name] < 0.5 else -STEPS[name]
    state = trim.state
    airframe.accelerations_held(Held(state[:3], state[3:6], state[6:9], trim.altitude), Controls(**at))
    before = airframe.accelerations_now()[FELT[name]]
    airframe.command(Controls(**(at | {name: at[name] + towards})))
    felt = np.empty(round(WATCHED[name] * hz))
    for k in range(len(felt)):
        airframe.step()
        felt[k] = airframe.accelerations_now()[FELT[name]] - before
    if abs(felt[-1]) < LEAST:
        return 0.0
    lag = float((1 - felt / felt[-1]).sum() / hz)
    return lag if lag > CLOSE else 0.0
