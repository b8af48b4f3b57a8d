"""Types of single values in files of data."""

from typing import Annotated

from msgspec import Meta

from uvf.models.keys import in_unit, name_like

PATH = r"[A-Za-z0-9_][A-Za-z0-9_./-]*"
Positive = Annotated[float, Meta(ge=1e-9, le=1e9)]
NotNegative = Annotated[float, Meta(ge=0, le=1e9)]
Angle = Annotated[float, Meta(ge=-7, le=7), in_unit("rad")]
Lean = Annotated[float, Meta(ge=-3.1416, le=3.1416), in_unit("rad")]
Angles = tuple[Lean, Lean, Angle]
"""Roll, pitch, yaw."""
PhysicsRate = Annotated[float, Meta(ge=20, le=5000)]
Name = Annotated[str, name_like(PATH, 80, "a name has letters, digits and _, ., / or -, and no spaces")]  # of a file, frame or joint
