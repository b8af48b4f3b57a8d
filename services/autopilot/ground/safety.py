"""Keeps watch over a ground vehicle: what its failsafes look at, and its fence."""

from schemas.convert import seconds, stamp
from schemas.messages import Event, Fence, Link, PoseInFrame
from services.autopilot.failsafes import Order, Watch
from services.autopilot.ground.failsafes import GROUND_RULES, Known
from services.autopilot.ground.fence import Place, stops
from uvf.runtime.fence_file import Fencing, fence_fault, fencing


class Safety:
    """``step`` once a cycle, then ``brakes`` for the velocity that was chosen."""

    def __init__(self, keep: tuple[float, float], fence: Fence) -> None:
        """keep: the vehicle's radius [m] and its deceleration [m/s^2]."""
        self.watch = Watch(GROUND_RULES)
        self.fence = fence
        self.fencing: Fencing = fencing(fence)
        self._keep = keep
        self._heard: float | None = None
        self._times = {"unplaced": 0.0, "unsteered": 0.0}
        self._fenced = False

    def set_fence(self, fence: Fence, here: Place | None) -> str:
        """Why it is refused; empty if it is in force from now on."""
        why = fence_fault(fence)
        if not why and here is not None and (room := fencing(fence).region.at((here.x, here.y))) < 0:
            why = f"the vehicle is {-room:.1f} m outside of it"
        if not why:
            self.fence, self.fencing = fence, fencing(fence)
        return why

    def step(
        self, t: float, link: Link | None, needs: dict[str, bool], link_timeout: float, dt: float
    ) -> tuple[list[Event], Order[Known] | None]:
        """needs: whether it moves, and whether it is without a pose or a command that its mode needs."""
        if link is not None and link.stations:
            self._heard = seconds(link.timestamp)
        for name, time in self._times.items():
            self._times[name] = time + dt if needs[name] else 0.0
        silence = t - self._heard if self._heard is not None else 0.0
        known = Known(link_timeout, needs["moves"], silence, self._times["unplaced"], self._times["unsteered"], self._fenced)
        changes, order = self.watch.step(known, dt)
        return [
            Event(
                timestamp=stamp(t),
                severity=c.rule.severity if c.began else Event.NOTICE,
                text=c.rule.begins if c.began else c.rule.ends,
                cause=c.cause,
                source="autopilot",
            )
            for c in changes
        ], order

    def brakes(self, here: Place | None, linear: float) -> bool:
        """Whether it has to stop before the fence."""
        self._fenced = here is not None and stops(self.fencing, here, linear, self._keep)
        return self._fenced


def place(pose: PoseInFrame, yaw: float) -> Place:
    return Place(pose.pose.position.x, pose.pose.position.y, yaw)
