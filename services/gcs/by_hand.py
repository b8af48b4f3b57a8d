"""Who drives which ground vehicle by hand: one page at a time, for as long as it says that a key or button is held."""

from collections.abc import Mapping

from uvf.runtime.teleop_hand import Command, Hand

PATIENCE = 0.5  # s a direction counts: a page repeats it every 0.1 s while it is held


class ByHand:
    """Times [s] come from one clock that never goes back."""

    def __init__(self, most: Mapping[str, Command]) -> None:
        """most: of each vehicle that can be driven, what it can do."""
        self._hands = {name: Hand((name,), limits) for name, limits in most.items()}
        self.vehicle = ""
        self.page = ""
        """The page's own word for itself; empty while nobody drives."""

    def can_drive(self, vehicle: str) -> bool:
        return vehicle in self._hands

    def scale(self, vehicle: str) -> Command:
        """Speeds at which a held direction drives."""
        return self._hands[vehicle].scale

    def take(self, t: float, page: str, vehicle: str) -> None:
        """The page drives that vehicle from now on; whoever drove before does no more."""
        self.leave(t)
        self.page, self.vehicle = page, vehicle

    def leave(self, t: float) -> None:
        """Nobody drives by hand; the vehicle is told to stand."""
        if self.page:
            self._hands[self.vehicle].stop(t)
        self.page = self.vehicle = ""

    def steer(self, t: float, page: str, way: tuple[float, float]) -> None:
        """A page says what it holds: parts (-1..1) of the linear and the angular scale, (0, 0) for nothing; only the driver is heard."""
        if not page or page != self.page:
            return
        hand = self._hands[self.vehicle]
        if way == (0.0, 0.0):
            hand.stop(t)
        else:
            hand.hold(t, way, PATIENCE)

    def rescale(self, t: float, page: str, key: str) -> None:
        """key: one of ``teleop_hand.SCALINGS``."""
        if page and page == self.page:
            self._hands[self.vehicle].key(t, key)

    def commands(self, t: float) -> dict[str, Command]:
        """What is to be sent now; nothing to a vehicle that has been told long enough to stand."""
        return {name: command for hand in self._hands.values() for name, command in hand.commands(t).items()}
