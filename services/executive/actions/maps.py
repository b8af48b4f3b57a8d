"""Maps that are saved."""

from schemas.messages import SaveMapRequest
from services.executive.actions.action import RequestAction
from services.executive.interface import SOURCE
from services.executive.situation import TeamSituation


class SaveMapAction(RequestAction):
    """Saves the map that a vehicle draws."""

    def __init__(self, vehicle: str, name: str, layer: str) -> None:
        super().__init__(vehicle)
        self._name, self._layer = name, layer

    def step(self, now: TeamSituation) -> bool:
        """Whether the map is saved."""
        return self._accepted(
            now, self._ticket or now.desk.ask("save_map", self.vehicle, SaveMapRequest(name=self._name, layer=self._layer, source=SOURCE))
        )
