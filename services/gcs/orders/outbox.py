"""The messages that the ground station sends with a step."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from google.protobuf.message import Message

from schemas.messages import StopCommand


@dataclass
class Outbox:
    """The messages that a step sends, by the service's declared names."""

    stop: list[StopCommand] = field(default_factory=list)
    calls: dict[str, Any] = field(default_factory=dict)
    """Requests by the name of the call, then by vehicle; those to the system as a list."""
    drive: dict[str, Message] = field(default_factory=dict)
    gimbal: dict[str, Message] = field(default_factory=dict)

    def call(self, name: str, vehicle: str, request: Message) -> None:
        """Adds a request."""
        self.calls.setdefault(name, {}).setdefault(vehicle, []).append(request)

    def said(self) -> Mapping[str, Any]:
        """All of it by the names of the service's outputs."""
        return {"stop": self.stop, "drive": self.drive, "gimbal": self.gimbal, **self.calls}
