"""Who drives which ground vehicle by hand: one page each, for as long as it says that a key or button is held."""

from collections.abc import Mapping

from uvf.control.teleop_drive import DriveTeleop, TeleopCommand

PATIENCE = 0.5  # s a direction counts: a page repeats it every 0.1 s while it is held


class ManualDriving:
    """A vehicle has one holder, and a page holds one vehicle. Times [s] come from one clock that never goes back."""

    def __init__(self, most: Mapping[str, TeleopCommand]) -> None:
        """most: of each vehicle that can be driven, what it can do."""
        self._hands = {name: DriveTeleop((name,), limits) for name, limits in most.items()}
        self._holders: dict[str, int] = {}

    def can_drive(self, vehicle: str) -> bool:
        return vehicle in self._hands

    def scale(self, vehicle: str) -> TeleopCommand:
        """Speeds at which a held direction drives."""
        return self._hands[vehicle].scale

    def holder(self, vehicle: str) -> int | None:
        """The page that drives it."""
        return self._holders.get(vehicle)

    def held_by(self, page: int) -> str:
        """The vehicle that the page drives; empty when it drives none."""
        return next((vehicle for vehicle, holder in self._holders.items() if holder == page), "")

    def take(self, t: float, page: int, vehicle: str) -> None:
        """The page drives that vehicle from now on, and no other; whoever drove it before does no more."""
        self.let_go(t, page)
        self.free(t, vehicle)
        self._holders[vehicle] = page

    def let_go(self, t: float, page: int) -> None:
        """What the page drives is told to stand."""
        self.free(t, self.held_by(page))

    def free(self, t: float, vehicle: str) -> None:
        """Nobody drives it any more; it is told to stand if somebody did."""
        if self._holders.pop(vehicle, None) is not None:
            self._hands[vehicle].stop(t)

    def leave(self, t: float) -> None:
        """Nobody drives anything by hand; what was driven is told to stand."""
        for vehicle in list(self._holders):
            self.free(t, vehicle)

    def steer(self, t: float, page: int, way: tuple[float, float]) -> None:
        """A page says what it holds: parts (-1..1) of the linear and the angular scale, (0, 0) for nothing; only a driver is heard."""
        hand = self._hands.get(self.held_by(page))
        if hand is None:
            return
        if way == (0.0, 0.0):
            hand.stop(t)
        else:
            hand.hold(t, way, PATIENCE)

    def rescale(self, t: float, page: int, key: str) -> None:
        """key: one of ``teleop_hand.SCALINGS``."""
        hand = self._hands.get(self.held_by(page))
        if hand is not None:
            hand.key(t, key)

    def commands(self, t: float) -> dict[str, TeleopCommand]:
        """What is to be sent now; nothing to a vehicle that has been told long enough to stand."""
        return {name: command for hand in self._hands.values() for name, command in hand.commands(t).items()}
