"""Types of single values in files of data."""

from typing import Annotated

from msgspec import Meta

Positive = Annotated[float, Meta(ge=1e-9, le=1e9)]
NotNegative = Annotated[float, Meta(ge=0, le=1e9)]
PhysicsRate = Annotated[float, Meta(ge=20, le=5000)]
Name = Annotated[str, Meta(pattern=r"^[A-Za-z0-9_][A-Za-z0-9_./-]*\Z", max_length=80)]  # of a file, frame or joint
