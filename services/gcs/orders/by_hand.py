"""Who drives which ground vehicle by hand: one page each, for as long as it says that a key or button is held."""

from collections.abc import Mapping

from uvf.control.teleop_drive import STILL, DriveTeleop
from uvf.maths.kinematics import Twist

PATIENCE = 0.5  # s a direction counts: a page repeats it every 0.1 s while it is held


class ManualDriving:
    """Who drives which vehicle: a vehicle has one holder, and a page holds one vehicle. Times [s] are of one monotonic clock."""

    def __init__(self, most: Mapping[str, Twist]) -> None:
        """most: of each vehicle that can be driven, what it can do."""
        self._hands = {name: DriveTeleop((name,), limits) for name, limits in most.items()}
        self._holders: dict[str, int] = {}

    def can_drive(self, vehicle: str) -> bool:
        """Whether the vehicle can be driven by hand."""
        return vehicle in self._hands

    def scale(self, vehicle: str) -> Twist:
        """Velocities [m/s, rad/s] at which a held direction drives."""
        return self._hands[vehicle].scale

    def holder(self, vehicle: str) -> int | None:
        """The page that drives the vehicle; None if none does."""
        return self._holders.get(vehicle)

    def held_by(self, page: int) -> str:
        """The vehicle that the page drives; empty when it drives none."""
        return next((vehicle for vehicle, holder in self._holders.items() if holder == page), "")

    def take(self, t: float, page: int, vehicle: str) -> None:
        """Gives the vehicle to the page at ``t`` [s]; its driver before, and the page's vehicle before, are released."""
        self.let_go(t, page)
        self.free(t, vehicle)
        self._holders[vehicle] = page

    def let_go(self, t: float, page: int) -> None:
        """Stops and releases the vehicle that the page drives, at ``t`` [s]."""
        self.free(t, self.held_by(page))

    def free(self, t: float, vehicle: str) -> None:
        """Releases the vehicle at ``t`` [s], and stops it if somebody drove it."""
        if self._holders.pop(vehicle, None) is not None:
            self._hands[vehicle].stop(t)

    def leave(self, t: float) -> None:
        """Stops and releases all vehicles driven by hand, at ``t`` [s]."""
        for vehicle in list(self._holders):
            self.free(t, vehicle)

    def steer(self, t: float, page: int, way: Twist) -> None:
        """Takes what a page holds at ``t`` [s]: parts (-1..1) of the scales; ignored unless the page drives."""
        hand = self._hands.get(self.held_by(page))
        if hand is None:
            return
        if way == STILL:
            hand.stop(t)
        else:
            hand.hold(t, way, PATIENCE)

    def rescale(self, t: float, page: int, key: str) -> None:
        """Changes the velocity scale of the page's vehicle at ``t`` [s]. key: one of ``teleop_drive.SCALINGS``."""
        hand = self._hands.get(self.held_by(page))
        if hand is not None:
            hand.key(t, key)

    def commands(self, t: float) -> dict[str, Twist]:
        """The velocity commands to send at ``t`` [s]; none to a vehicle that has been told long enough to stop."""
        return {name: command for hand in self._hands.values() for name, command in hand.commands(t).items()}
