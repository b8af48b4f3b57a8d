"""Maps that are saved, and maps that are handed over."""

from collections.abc import Sequence

from schemas.messages import MapRequest, SaveMapRequest
from services.executive.actions.action import RequestAction
from services.executive.interface import SOURCE
from services.executive.situation import TeamSituation
from uvf.maths.se2 import Pose2, compose
from uvf.models.mission.tasks import ShareMapTask
from uvf.runtime.messages.convert import planar_pose, pose2_of


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


class ShareMapAction(RequestAction):
    """Hands the map of a vehicle over to others."""

    def __init__(self, wanted: ShareMapTask, receivers: Sequence[str]) -> None:
        super().__init__(wanted.vehicle)
        self._wanted, self._receivers = wanted, receivers

    def step(self, now: TeamSituation) -> bool:
        """Whether the map is handed over."""
        request = MapRequest(layer=self._wanted.layer, area=self._wanted.area or (), source=SOURCE)
        ticket = self._ticket or now.desk.ask("get_map", self.vehicle, request)
        if not self._accepted(now, ticket):
            return False
        grid = ticket.reply.grid
        if grid.frame_id != "world":
            start = now.members[self.vehicle].entry.start
            grid.pose.CopyFrom(planar_pose(*compose(Pose2(start.x, start.y, start.yaw), pose2_of(grid.pose))))
            grid.frame_id = "world"
        now.shared.update(dict.fromkeys(self._receivers, grid))
        return True
