"""Plans a path on a map in map_server's format: costs near obstacles as ROS has them, then A*."""

from pathlib import Path

from uvf.models import load_map
from uvf.planning import GridSearch, Inflation, RobotFootprint, cost_factors, make_costmap

grid = load_map(Path(__file__).with_name("house.yaml"))
frame = grid.resolution, (grid.origin.x, grid.origin.y)
costs = make_costmap(grid.cells, frame, RobotFootprint.circle(0.14), Inflation(inflation_radius=0.55, cost_scaling_factor=6.0))  # m, m, 1/m
found = GridSearch(costs.values, cost_factors(2.0)).astar(costs.cell(0.0, 0.0), costs.cell(3.5, 5.5))  # m, map frame
points = costs.points(found.cells)
print(f"{len(points)} cells, cost {found.cost:.1f}, from {points[0]} to {points[-1]} m")
