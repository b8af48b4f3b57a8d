"""The autopilot of an aircraft that follows another one."""

from collections.abc import Mapping
from typing import Any

from schemas import topics
from schemas.messages import NavState
from services.autopilot.air.config import Ship
from services.autopilot.air.modes.follower import Formation
from services.autopilot.air.service import AutopilotAir
from uvf.models.vehicle.flight_params import AirParams
from uvf.runtime.contract.service import each_vehicle
from uvf.runtime.messages.outputs import Outputs


class AutopilotWingman(AutopilotAir):
    """All that an aircraft's autopilot does, and mode Follow: it hears where the others think they are."""

    inputs = {**AutopilotAir.inputs, "others": each_vehicle(topics.NAV_STATE)}

    def __init__(self, ship: Ship, params: AirParams, formation: Formation) -> None:
        super().__init__(ship, params)
        self._formation = formation
        self._pilot.join(formation)

    def step(self, t: float, others: Mapping[str, NavState], **heard: Any) -> Outputs:  # type: ignore[override]
        self._formation.hear(t, others)
        return super().step(t, **heard)
