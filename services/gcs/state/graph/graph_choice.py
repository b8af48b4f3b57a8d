"""What one browser has chosen in the tab Graph."""

from dataclasses import dataclass

SCOPES = ("vehicle", "all", "problems")
"""Whose topics the table lists: those of the vehicle on show and of the system, all, or those that something is wrong with."""


@dataclass(frozen=True)
class GraphChoice:
    """Filters of the table of topics, and what is looked at closely; "" for nothing."""

    scope: str = SCOPES[0]
    text: str = ""
    """What keys, types and names of services must contain."""
    node: str = ""
    """The service (``owner/name``) whose topics alone are listed, or from which a bundle leads."""
    to: str = ""
    """The service to which the chosen bundle leads."""
    topic: str = ""
    """The key whose newest message is shown."""
