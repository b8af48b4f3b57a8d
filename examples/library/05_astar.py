"""Plans a path on a map in map_server's format: costs near obstacles, A*, a path that a robot can follow."""

from pathlib import Path

from uvf.models import load_map
from uvf.planning import RobotFootprint, astar, make_costmap

grid = load_map(Path(__file__).with_name("house.yaml"))
robot = RobotFootprint(radius=0.14, inflation_radius=0.35, cost_scaling_factor=6.0)  # m, m, factor
costs = make_costmap(grid.cells, (grid.resolution, (grid.origin.x, grid.origin.y)), robot)
path, cost = astar(costs.cost, costs.cell(0.0, 0.0), costs.cell(3.5, 5.5))  # m, map frame
print(f"{len(path)} cells, cost {cost:.1f}, from {costs.points(path)[0]} to {costs.points(path)[-1]} m")
