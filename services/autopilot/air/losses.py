"""Which sensors are lost, and what is done about it."""

from enum import Enum

GNSS_LOST = 2.0  # s without a fix
GNSS_HOLD = 5.0  # s without a fix, after which the aircraft holds


class Loss(Enum):
    """What is said of it when it begins and when it ends."""

    GNSS = ("GNSS lost: dead reckoning", "GNSS back")
    AIR_DATA = ("air data lost: airspeed and height from GNSS, else throttle and pitch at trim", "air data back")

    @property
    def begins(self) -> str:
        return self.value[0]

    @property
    def ends(self) -> str:
        return self.value[1]


def losses(unfixed: float, has_air_data: bool) -> frozenset[Loss]:
    """``unfixed`` [s] is the time since the last fix."""
    states = {Loss.GNSS: unfixed > GNSS_LOST, Loss.AIR_DATA: not has_air_data}
    return frozenset(loss for loss, is_lost in states.items() if is_lost)
