"""The controllers of the benchmark by their names."""

from collections.abc import Callable
from functools import partial

from benchmarks.planning.barn import checks
from benchmarks.planning.barn.controllers import Briefing, Controller
from benchmarks.planning.barn.stack import move_base_stack, stack_of
from benchmarks.planning.barn.worlds import World
from uvf.models.yaml_data import BadInput, nearest
from uvf.planning.local.planners import LOCAL_PLANNERS

ControllerMaker = Callable[[Briefing], Controller]

CONTROLLERS: dict[str, ControllerMaker] = {name: partial(stack_of, name) for name in LOCAL_PLANNERS} | {"move_base": move_base_stack}
"""Navigation stacks by name, one of each local planner; the first one is the default."""

CHECKS: dict[str, ControllerMaker] = {
    "path": lambda briefing: checks.PathFollower(_told(briefing)),
    "straight": lambda briefing: checks.Straight(),
}
"""Controllers that try the simulation. They are told the world, and their odometry is the truth."""


def _told(briefing: Briefing) -> World:
    if briefing.world is None:
        raise ValueError("briefing.world: None; a controller of CHECKS is told the world")
    return briefing.world


def known_controller(name: str | None) -> str:
    """The name of a controller that is there; None stands for the default. Raises BadInput."""
    known = [*CONTROLLERS, *CHECKS]
    if name is None:
        return known[0]
    if name not in known:
        raise BadInput(f"no controller '{name}'; {nearest(name, known)}")
    return name
