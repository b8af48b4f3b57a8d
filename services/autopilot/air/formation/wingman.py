"""The autopilot of an aircraft that follows another one."""

from schemas import topics
from schemas.messages import NavState
from services.autopilot.air import interface
from services.autopilot.air.config import AutopilotConfig
from services.autopilot.air.modes.follower import FormationLink
from services.autopilot.air.service import AutopilotAir
from uvf.models.vehicle.flight_params import AirParams
from uvf.runtime.contract.declaration import each_vehicle


class AutopilotWingman(AutopilotAir):
    """All that an aircraft's autopilot does, and mode Follow: it hears where the others think they are."""

    class Inputs(interface.Inputs):
        others: dict[str, NavState] = each_vehicle(topics.NAV_STATE)

    def __init__(self, config: AutopilotConfig, params: AirParams, formation: FormationLink) -> None:
        super().__init__(config, params)
        self._formation = formation
        self._mode_manager.join(formation)

    def step(self, t: float, now: interface.Inputs) -> interface.Outputs:
        assert isinstance(now, self.Inputs)
        self._formation.hear(t, now.others)
        return super().step(t, now)
