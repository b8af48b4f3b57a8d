"""Positions of joints as messages."""

from math import isfinite

from schemas.messages import JointStates


def positions_of(states: JointStates) -> dict[str, float]:
    """Of each joint by its name [rad, or m of a prismatic one]; what is no number is left out."""
    return {joint.name: joint.position for joint in states.joints if isfinite(joint.position)}
