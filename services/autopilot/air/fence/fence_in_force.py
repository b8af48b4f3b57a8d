"""Which fence is kept: that of the plan, and a simple one about home by parameters; and what is done at both."""

from dataclasses import replace

from schemas.messages import Fence
from uvf.guidance.fence_plan import tightest
from uvf.guidance.route import Place
from uvf.models.mission.fence import ACTIONS, FenceAction, Fencing, near_home
from uvf.models.vehicle.flight_params import AirParams
from uvf.runtime.messages.fences import fencing

HEIGHT_NEEDED = 3  # fence_height, between floor and ceiling


class FenceInForce:
    """Worked out anew when the plan, home or a parameter is another one."""

    def __init__(self) -> None:
        self._fence = Fence()
        self._of: tuple[object, ...] = ()
        self._found = fencing(self._fence)

    def of(self, fence: Fence, home: Place | None, params: AirParams) -> Fencing:
        """The same object as long as nothing changes."""
        of = home, params.max_distance, params.max_height, params.fence_action, too_small(params)
        if fence is not self._fence or of != self._of:
            self._fence, self._of, self._found = fence, of, in_force(fence, home, params)
        return self._found


def in_force(fence: Fence, home: Place | None, params: AirParams) -> Fencing:
    """A fence that is disabled keeps out of nothing, home's neither."""
    plan = fencing(fence)
    if fence.disabled:
        return plan
    if params.fence_action != "plan":
        plan = replace(plan, action=ACTIONS[params.fence_action])
    if home is None:
        return plan
    found = near_home(plan, (home.east, home.north), params.max_distance)
    if params.max_height:
        found = replace(found, ceiling=min(found.ceiling, home.height + params.max_height))
    return replace(found, action=FenceAction.WARN) if too_small(params) else found


def too_small(params: AirParams) -> str:
    """Why the fence about home cannot be kept, and is only told of; empty if it can."""
    room, height = tightest(params) + params.fence_margin, HEIGHT_NEEDED * params.fence_height
    if 0 < params.max_distance < room:
        return f"max_distance of {params.max_distance:.0f} m leaves no room to circle: {room:.0f} m are needed"
    if 0 < params.max_height < height:
        return f"max_height of {params.max_height:.0f} m is too low: {height:.0f} m are needed"
    return ""
