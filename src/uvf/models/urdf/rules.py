"""What a model must keep to be simulated: every fault of it, not only the first."""

from collections.abc import Iterator

import numpy as np

from uvf.models.urdf.robot import Inertial, Joint, Link, ModelFault, UrdfModel
from uvf.models.yaml_data import nearest

TRIANGLE_SLACK = 1e-3
"""Of the largest principal moment: rounded figures of flat or thin bodies stay within it."""


LIGHTEST_WHEEL = 5e-4
"""Share of the vehicle's mass that a wheel weighs at least: lighter ones slip and hop in any solver."""

RESERVED = ("base_footprint", "map", "odom")
"""Frames that every vehicle has besides the URDF's links (REP-105); a root called base_footprint is that frame."""


def model_faults(model: UrdfModel) -> Iterator[ModelFault]:
    """Faults of a model: those found in reading, then those of inertia, tree and wheels."""
    yield from model.faults
    for link in model.links.values():
        yield from (ModelFault(model.path, link.line, f"link '{link.name}': {text}") for text in _inertia_faults(model, link))
    yield from _tree_faults(model)
    for link in (link for name, link in model.links.items() if name in RESERVED and (name != "base_footprint" or name in model.parents)):
        yield ModelFault(
            model.path, link.line, f"link '{link.name}': every vehicle has a frame of that name above base_link; take the link out"
        )


def wheel_faults(model: UrdfModel, wheels: tuple[str, ...], steering: tuple[str, ...] = ()) -> Iterator[ModelFault]:
    """Faults of the joints of wheels and steering that vehicle.yaml names: joints that do not exist or do not turn."""
    for name in (*wheels, *steering):
        joint, steers = model.joints.get(name), name in steering
        if joint is None:
            yield ModelFault(model.path, 0, f"no joint '{name}' (named in vehicle.yaml); {nearest(name, model.joints)}")
        elif not steers and joint.kind != "continuous":
            yield ModelFault(model.path, joint.line, f"joint '{name}' is '{joint.kind}', but a wheel needs type=\"continuous\"")
        elif steers and joint.kind not in ("revolute", "continuous"):
            yield ModelFault(model.path, joint.line, f"joint '{name}' is '{joint.kind}', but a steering needs type=\"revolute\"")


def _inertia_faults(model: UrdfModel, link: Link) -> Iterator[str]:
    """What moves as one body has some mass, in one of its links."""
    if link.inertial is not None:
        yield from inertial_faults(link.inertial)
        return
    joint = model.parents.get(link.name)
    moves = joint is not None and joint.kind not in ("fixed", "")
    if moves or all(model.links[name].inertial is None for name in model.rigid_with(link.name)):
        yield "give it <inertial> with <mass> and <inertia>"


def inertial_faults(inertial: Inertial) -> Iterator[str]:
    """Faults of an inertia: principal moments must be above zero, and none above the sum of the other two (the triangle rule)."""
    if inertial.mass <= 0 or not (np.diag(inertial.inertia) > 0).all():
        yield "mass, ixx, iyy and izz must be numbers above zero"
        return
    a, b, c = np.linalg.eigvalsh(inertial.inertia)
    if a <= 0 or a + b < c * (1 - TRIANGLE_SLACK):
        yield f"no body has the principal moments {a:.3g}, {b:.3g}, {c:.3g} kg m^2: each is above zero and at most the other two together"


def _tree_faults(model: UrdfModel) -> Iterator[ModelFault]:
    """Every joint ties two known links, every link but one hangs on one joint, and all hang together."""
    hung: dict[str, Joint] = {}
    for joint in model.joints.values():
        for end, name in (("parent", joint.parent), ("child", joint.child)):
            if name not in model.links:
                yield ModelFault(model.path, joint.line, f"joint '{joint.name}': no {end} link '{name}'; {nearest(name, model.links)}")
        if joint.child in hung:
            yield ModelFault(model.path, joint.line, f"link '{joint.child}' is the child of two joints; one is enough")
        hung[joint.child] = joint
    roots = sorted(set(model.links) - set(hung))
    if len(roots) != 1:
        yield ModelFault(model.path, 0, f"one link must be the root, but without a parent joint are: {', '.join(roots) or 'none'}")
    for link, joint in hung.items():
        if link in _above(link, hung):
            yield ModelFault(model.path, joint.line, f"link '{link}' hangs on itself in a ring of joints; cut it")


def _above(link: str, hung: dict[str, Joint]) -> Iterator[str]:
    """The links that a link hangs on, no more than there are."""
    for _ in hung:
        if link not in hung:
            return
        link = hung[link].parent
        yield link
