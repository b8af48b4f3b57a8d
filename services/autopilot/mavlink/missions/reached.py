"""Which items of a mission have just been done, for MISSION_ITEM_REACHED: flown to, or carried out right after."""

from collections.abc import Sequence

from schemas.messages import MissionItem, MissionProgress

FLOWN = frozenset({MissionItem.WAYPOINT, MissionItem.ORBIT, MissionItem.RETURN, MissionItem.TAKEOFF, MissionItem.LAND})
UNBEGUN = (MissionProgress.NO_MISSION, MissionProgress.NOT_STARTED)


class ReachedItems:
    """Reports each reached item once per lap; nothing that was reached before the first look."""

    def __init__(self) -> None:
        self._before: tuple[int, int, bool] | None = None
        self._current = 0  # of the look before

    def look(self, progress: MissionProgress, items: Sequence[MissionItem]) -> range:
        """The items reached since the look before."""
        begun = progress.state not in UNBEGUN or progress.reached >= 0
        now = (progress.laps, progress.reached, begun)
        before, self._before = self._before, now
        first, self._current = min(self._current, progress.reached), progress.current
        if before is None or before == now or not begun:
            return range(0)
        return range(max(first, 0), min(_end(progress, items), len(items)))


def _end(progress: MissionProgress, items: Sequence[MissionItem]) -> int:
    """Behind the last item done: waypoints passed with the one reached, speeds, pictures, marks and jumps after it."""
    begin = progress.reached + 1
    if progress.current > progress.reached >= 0 and progress.state != MissionProgress.COMPLETE:
        return progress.current
    return next((i for i in range(begin, len(items)) if items[i].kind in FLOWN), max(begin, len(items)))
