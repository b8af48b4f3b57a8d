"""What a browser can ask for of a vehicle's map."""

from dataclasses import dataclass
from typing import Annotated

import msgspec

from services.gcs.actions.page import Name, PageAction


@dataclass(frozen=True)
class MapForm:
    """What is written into the form."""

    name: Annotated[str, msgspec.Meta(max_length=64)]


@dataclass(frozen=True)
class OfMap(PageAction):
    """Base of these actions. vehicle: whose map."""

    vehicle: Name


@dataclass(frozen=True)
class SaveMap(OfMap):
    """Write the map that is being drawn into the saved maps of the host that draws it."""

    form: MapForm


@dataclass(frozen=True)
class Relocalize(OfMap):
    """Look for the vehicle in the whole map."""


@dataclass(frozen=True)
class Mapping(OfMap):
    """Hold the map as it is, or go on with it."""

    on: bool


@dataclass(frozen=True)
class BeginMap(OfMap):
    """Begin another map where the vehicle is, with a SLAM method."""

    method: Name
