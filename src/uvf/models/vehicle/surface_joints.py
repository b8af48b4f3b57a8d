"""Deflections of an aircraft's surfaces from what ``sensor/joints`` tells, whichever joints its model has."""

from collections.abc import Mapping


def deflection(name: str, told: Mapping[str, float]) -> float:
    """Deflection [rad] of left_aileron, right_flap ... by the joint angles ``told`` [rad]; trailing edge down (a rudder: left) positive.

    A model that tells of one joint for both sides (rudder, flap, aileron) moves both, ailerons against each other.
    """
    if name in told:
        return told[name]
    side, _, both = name.partition("_")
    sign = -1.0 if (side, both) == ("right", "aileron") else 1.0
    return sign * told.get(both, 0.0)
