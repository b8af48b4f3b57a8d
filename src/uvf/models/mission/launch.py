"""``launch`` of an aircraft's start: how it is thrown into the air."""

from typing import Annotated

import msgspec
from msgspec import Meta

from uvf.models.keys import key, plain
from uvf.models.quantities import NotNegative, Positive


class Launch(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A hand, a catapult or a bungee; the defaults are those of a throw by hand."""

    speed: Annotated[Positive, key("m/s", "Speed over the ground with which it is let go.")]
    length: Annotated[Positive, key("m", "How far it is pushed: 1.5 by hand, 3 by a catapult, 20 by a bungee.")] = 1.5
    elevation: Annotated[float, Meta(ge=-0.2, le=1.2), key("rad", "How steeply, up from the horizon; so the nose points too.")] = 0.15
    height: Annotated[NotNegative, key("m", "Height above the ground at which it is held before.")] = 1.8
    weakens: Annotated[bool, plain("The push falls off to nothing at its end, as that of a bungee.")] = False
    delay: Annotated[NotNegative, key("s", "Time from the moment it is armed, its brakes let go of, to the push.")] = 3.0
    scatter: Annotated[NotNegative, key("rad", "How far off its attitude is when it is let go, one sigma about each axis.")] = 0.05
