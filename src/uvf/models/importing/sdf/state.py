"""The <state> that Gazebo classic writes when a world is saved: where things stood then, which counts instead of their poses."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.se3 import Transform
from uvf.models.importing.sdf.poses import numbers, transform

Floats = NDArray[np.float64]


class ModelState(NamedTuple):
    """Saved poses world_from_model, and world_from_link by name; scale (3,) [-] of the shapes."""

    pose: Transform | None
    links: dict[str, Transform]
    scale: Floats


NOTHING_SAVED = ModelState(None, {}, np.ones(3))


def saved_states(world: Any) -> dict[str, ModelState]:
    """Saved states by the model's name, that of a model in a model after ``::``. Raises BadInput."""
    states: dict[str, ModelState] = {}
    for model in world.findall("state/model"):
        _add(states, model, "")
    return states


def deleted(world: Any) -> set[str]:
    """Names of the models that were taken away after the start."""
    return {(name.text or "").strip() for name in world.findall("state/deletions/name")}


def _add(states: dict[str, ModelState], model: Any, owner: str) -> None:
    name = owner + str(model.get("name"))
    pose, scale = model.find("pose"), model.find("scale")
    links = {link.get("name"): transform(link.find("pose")) for link in model.findall("link") if link.find("pose") is not None}
    states[name] = ModelState(
        transform(pose) if pose is not None else None, links, np.abs(numbers(scale, 3)) if scale is not None else np.ones(3)
    )
    for inner in model.findall("model"):
        _add(states, inner, f"{name}::")
