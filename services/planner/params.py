"""Parameters of the planner."""

from typing import Annotated, Literal

from msgspec import Meta

from uvf.models.keys import key, plain
from uvf.models.params import Params

Positive = Annotated[float, Meta(gt=0)]


class PlannerParams(Params, frozen=True):
    """Parameters of the planner."""

    global_planner: Annotated[
        Literal[
            "astar",
            "dijkstra",
            "jump_points",
            "theta_star",
            "rrt",
            "rrt_star",
            "rrt_connect",
            "prm",
            "visibility_graph",
            "voronoi",
            "potential_field",
            "bug1",
            "bug2",
        ],
        plain("What plans the path on the map."),
    ] = "astar"
    margin: Annotated[Positive, key("m", "Distance kept from obstacles beyond the vehicle's outline.")] = 0.03
    inflation_radius: Annotated[Positive, key("m", "Distance from obstacles beyond which a path costs no more.")] = 0.55
    cost_scaling_factor: Annotated[Positive, key("1/m", "Rate at which the cost decays with the distance from an obstacle.")] = 6.0
    cost_travel_multiplier: Annotated[float, Meta(ge=0), key("", "Weight of costs beside length; 0: the shortest path.")] = 5.0
    max_step: Annotated[Positive, key("m", "Step that is an obstacle, in a map of heights that another vehicle has made.")] = 0.3
    max_slope: Annotated[float, Meta(gt=0, lt=1.5), key("rad", "Slope that is an obstacle, in such a map.")] = 0.35
    goal_tolerance: Annotated[Positive, key("m", "Distance at which a goal is reached.")] = 0.12
    look_tolerance: Annotated[Positive, key("m", "Distance at which a frontier is reached; it only has to be seen.")] = 0.3
    wait_at_goal: Annotated[float, Meta(ge=0), key("s", "Time at an operator's goal, reached or cancelled, before the job continues.")] = (
        5.0
    )
    patience: Annotated[Positive, key("s", "Time without progress before a recovery begins.")] = 4.0
    replan_period: Annotated[Positive, key("s", "Time after which a path is planned anew, also when nothing is in the way.")] = 1.0
    min_frontier_size: Annotated[int, Meta(ge=1), key("cells", "Smallest frontier that is explored.")] = 6
    frontier_choice: Annotated[
        Literal["nearest", "size", "information_gain"],
        plain("Frontier that is explored first: the nearest, a near and wide one, or where most unknown ground could be seen for the way."),
    ] = "size"
    frontier_gain: Annotated[float, Meta(ge=0), key("cells", "Path length that a cell of frontier is worth, by size.")] = 0.5
