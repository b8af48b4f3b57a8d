"""The shortest path of an aircraft between two places and courses, turning no tighter than 90 m (Beard & McLain, section 11.2)."""

import matplotlib.pyplot as plt
import numpy as np

from uvf.guidance import dubins_path

path = dubins_path((0.0, 0.0, 0.0), (300.0, 200.0, np.pi), radius=90.0)  # north [m], east [m], course [rad]
points = path.at(np.linspace(0.0, path.length, 200))
print(f"{path.word}, {path.length:.0f} m, segments of {', '.join(f'{s:.0f}' for s in path.lengths)} m")
plt.plot(points[:, 1], points[:, 0])
plt.axis("equal")
plt.savefig("dubins.png")
