"""Masks of the map server as the library has them."""

from schemas.messages import Grid
from uvf.planning.costmap.zone_mask import ZoneMask
from uvf.runtime.messages.convert import occupancy_cells


class MaskReader:
    """Keeps the newest mask of a topic, so that each message is read once."""

    def __init__(self) -> None:
        self._message: Grid | None = None
        self._mask: ZoneMask | None = None
        self.is_new = False
        """Whether the mask that was taken last is another one than before."""

    def take(self, message: Grid | None) -> ZoneMask | None:
        """The mask; the last one while there is no newer one."""
        self.is_new = message is not None and message is not self._message and message != self._message
        if message is not None and self.is_new:
            frame = message.cell_size.x, (message.pose.position.x, message.pose.position.y)
            self._message, self._mask = message, ZoneMask(occupancy_cells(message), frame)
        return self._mask
