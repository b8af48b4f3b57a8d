"""Maps a recorded drive: a CARMEN log in, trajectory and occupancy grid out."""

from pathlib import Path

import matplotlib.pyplot as plt

from uvf.slam import GraphSlam, TileMap, read_carmen

slam, grid = GraphSlam(), TileMap(resolution=0.05)
log = read_carmen(Path(__file__).with_name("house.carmen"))
for reading in log:
    estimate = slam.add(reading)
slam.finish()
grid.follow(slam.keyframes())
cells, (x, y) = grid.cells()  # int8, row 0 at the lowest y: -1 unknown, 0 free .. 100 occupied
print(f"{len(log)} scans, {len(grid)} keyframes, {cells.shape} cells; ends at {estimate.map_from_base}")
plt.imshow(cells, origin="lower", cmap="Greys", extent=(x, x + 0.05 * cells.shape[1], y, y + 0.05 * cells.shape[0]))
plt.plot(*slam.trajectory()[:, :2].T)
plt.savefig("slam.png")
