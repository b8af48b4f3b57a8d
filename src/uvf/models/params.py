"""Parameters of an algorithm or a service, as a typed set with limits and units."""

import msgspec


class Params(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Base of parameter sets; limits and units by ``Annotated[float, msgspec.Meta(ge=..., le=..., ...)]``."""
