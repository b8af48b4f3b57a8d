"""Methods whose work another instance, or another day, can go on with."""

from typing import Protocol, runtime_checkable

from services.slam.maps.session import Session
from services.slam.method import SlamMethod
from uvf.maths.planar import Pose2


@runtime_checkable
class Resumable(SlamMethod, Protocol):
    """A method whose work another instance can go on with."""

    def session(self) -> Session:
        """All of it."""

    def resume(self, session: Session, map_from_base: Pose2) -> None:
        """Before the first reading; map_from_base: where the vehicle is now."""
