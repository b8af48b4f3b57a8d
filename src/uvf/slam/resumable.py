"""What some methods can beside: their work can be gone on with by another instance, or another day; they tell of their limits."""

from typing import Protocol, runtime_checkable

from uvf.maths.se2 import Pose2
from uvf.slam.maps.session import MappingSession
from uvf.slam.method import SlamMethod


@runtime_checkable
class Resumable(SlamMethod, Protocol):
    """A method whose work another instance can go on with."""

    def session(self) -> MappingSession:
        """The whole mapping session so far."""

    def resume(self, session: MappingSession, map_from_base: Pose2) -> None:
        """Continues a session; called before the first reading. map_from_base: where the vehicle is now."""


@runtime_checkable
class Noting(SlamMethod, Protocol):
    """A method that tells what the user should know of its work."""

    @property
    def notes(self) -> list[str]:
        """Remarks for the user, a line each; a line never goes away again."""
