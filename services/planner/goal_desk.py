"""Answers to who asks for a goal, or what the way to one would be like."""

from math import inf

from schemas.messages import Fence, PreviewReply, PreviewRequest, Vector3
from services.planner.directives import line_of
from uvf.maths.se2 import Pose2, compose, inverse
from uvf.planning.global_planner import GlobalPlanner
from uvf.planning.smoothing import length
from uvf.runtime.messages.plans.fences import fencing

Point = tuple[float, float]

PREVIEWS = 4  # answered in a step; each costs a search


class GoalDesk:
    """One vehicle's. bounds: the fence in force."""

    def __init__(self, planner: GlobalPlanner, world_from_map: Pose2, speed: float) -> None:
        """speed: that of the vehicle on straight parts [m/s]."""
        self.bounds: Fence | None = None
        self._planner, self._speed = planner, speed
        self._world_from_map, self._map_from_world = world_from_map, inverse(world_from_map)

    def in_map(self, point: Point) -> Point:
        """A point [m, world] in the map frame."""
        x, y, _ = compose(self._map_from_world, Pose2(point[0], point[1], 0.0))
        return (x, y)

    def refusal(self, here: Point, place: Vector3) -> str:
        """Why a vehicle that is at ``here`` [map] cannot be sent to a place [m, world]; "" if it can."""
        return self._beyond(place) or self._planner.refusal(here, self.in_map((place.x, place.y)))

    def previews(self, here: Pose2, wanted: list[PreviewRequest]) -> list[PreviewReply]:
        """The ways as they would be driven now, or why there is none; from ``here`` [map] where no start is given."""
        busy = PreviewReply(reason=f"more than {PREVIEWS} at once; ask again")
        return [self._preview(here[:2], request) for request in wanted[:PREVIEWS]] + [busy] * (len(wanted) - PREVIEWS)

    def _preview(self, here: Point, wanted: PreviewRequest) -> PreviewReply:
        if wanted.HasField("start"):
            start = self.in_map((wanted.start.x, wanted.start.y))
            reason = self._misplaced(wanted.start, "start") or self._misplaced(wanted.position)
        else:
            start, reason = here, self.refusal(here, wanted.position)
        if reason:
            return PreviewReply(reason=reason)
        planned = self._planner.plan(start, self.in_map((wanted.position.x, wanted.position.y)))
        costs = self._planner.costs
        if planned.path is None or costs is None:
            return PreviewReply(reason=planned.reason)
        way = length(planned.path)
        room = min(costs.clearance_at(costs.cell(x, y)) for x, y in planned.path.tolist())
        reply = PreviewReply(accepted=True, length=way, duration=way / self._speed, clearance=room)
        reply.poses.extend(line_of(self._world_from_map, planned.path))
        return reply

    def _misplaced(self, place: Vector3, name: str = "goal") -> str:
        """Why a vehicle cannot stand at a place [m, world]; empty if it can."""
        return self._beyond(place, name) or self._planner.misplaced(self.in_map((place.x, place.y)), name)

    def _beyond(self, place: Vector3, name: str = "goal") -> str:
        """Why a place lies too near to the fence, or outside of it; empty if it does not."""
        room = inf if self.bounds is None else fencing(self.bounds).region.at((place.x, place.y))
        if room < 0:
            return f"the {name} is {-room:.1f} m outside of the fence"
        needed = self._planner.body.footprint.circumscribed_radius
        return f"the {name} is {room:.2f} m from the fence, too near" if room < needed else ""
