"""A vehicle's body as links and joints, whatever file it was read from."""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from uvf.maths.rotations import from_axis
from uvf.maths.se3 import IDENTITY, Transform, compose
from uvf.models.shapes.solid import Solid

Floats = NDArray[np.float64]

JOINT_KINDS = ("continuous", "fixed", "floating", "planar", "prismatic", "revolute")


@dataclass(frozen=True)
class ModelFault:
    """What is wrong with a file; line 0 = unknown."""

    path: Path
    line: int
    text: str

    def __str__(self) -> str:
        return f"{self.path}:{self.line}: {self.text}" if self.line else f"{self.path}: {self.text}"


@dataclass(frozen=True)
class Inertial:
    """Inertia of a link: mass [kg]; com (3,) [m] in the link; inertia (3, 3) [kg m^2] about the centre of mass, axes of the link."""

    mass: float
    com: Floats
    inertia: Floats


@dataclass(frozen=True)
class Link:
    """A link. inertial: None = none given, a frame without mass. Shapes are in the link's frame.

    contact: what the file says of touching (lateral_friction and the like), name -> value.
    """

    name: str
    inertial: Inertial | None = None
    visuals: tuple[Solid, ...] = ()
    collisions: tuple[Solid, ...] = ()
    contact: tuple[tuple[str, float], ...] = ()
    line: int = 0


@dataclass(frozen=True)
class Joint:
    """A joint. parent_from_child: at rest; axis: (3,) unit vector in the child's frame; limits: lower and upper [rad or m], None = none.

    damping [N m s/rad], friction [N m] of the bearing; speed [rad/s or m/s] and effort [N m or N] of what moves it, 0 = not given.
    """

    name: str
    kind: str
    parent: str
    child: str
    parent_from_child: Transform = IDENTITY
    axis: Floats = field(default_factory=lambda: np.array((1.0, 0.0, 0.0)))
    limits: tuple[float, float] | None = None
    mimics: str | None = None
    damping: float = 0.0
    friction: float = 0.0
    speed: float = 0.0
    effort: float = 0.0
    line: int = 0

    def at(self, value: float) -> Transform:
        """Transform parent_from_child at an angle [rad] or, for a prismatic joint, a displacement [m]."""
        if self.kind == "prismatic":
            moved = Transform(IDENTITY.rotation, self.axis * value)
        elif self.kind in ("continuous", "revolute"):
            moved = Transform(from_axis(self.axis, value), np.zeros(3))
        else:
            return self.parent_from_child
        return compose(self.parent_from_child, moved)


@dataclass(frozen=True)
class UrdfModel:
    """Links and joints in the order of the file. Of things named twice the last counts; ``faults`` says so."""

    path: Path
    name: str
    links: dict[str, Link]
    joints: dict[str, Joint]
    faults: tuple[ModelFault, ...] = ()

    @property
    def parents(self) -> dict[str, Joint]:
        """The joint that each link hangs on, by the name of the child link."""
        return {joint.child: joint for joint in self.joints.values()}

    @property
    def roots(self) -> list[str]:
        """The links that hang on no joint; one in a sound model."""
        parents = self.parents
        return [name for name in self.links if name not in parents]

    def link_poses(self, joint_angles: Mapping[str, float] | None = None) -> dict[str, Transform]:
        """Transform root_from_link of each link below the first root, at joint angles [rad] or displacements [m], 0 where not named."""
        angles, poses = joint_angles or {}, dict.fromkeys(self.roots[:1], IDENTITY)
        waiting = [j for j in self.joints.values() if j.child in self.links]
        while ready := [j for j in waiting if j.parent in poses and j.child not in poses]:
            for joint in ready:
                poses[joint.child] = compose(poses[joint.parent], joint.at(angles.get(joint.name, 0.0)))
            waiting = [j for j in waiting if j.child not in poses]
        return poses

    def below(self, link: str) -> Iterator[str]:
        """A link and all that hang on it, each once, even where joints form a ring."""
        found = [link]
        for name in found:  # grows
            yield name
            found += [j.child for j in self.joints.values() if j.parent == name and j.child not in found]

    def carried_by(self, joints: Collection[str]) -> set[str]:
        """The links that these joints move."""
        return {link for name in joints if name in self.joints for link in self.below(self.joints[name].child)}

    def rigid_with(self, link: str) -> set[str]:
        """The links that move as one body with this one."""
        group, grown = {link}, True
        while grown:
            ends = [{j.parent, j.child} for j in self.joints.values() if j.kind == "fixed" and len({j.parent, j.child} & group) == 1]
            grown = bool(ends)
            group = group.union(*ends)
        return group & set(self.links)
