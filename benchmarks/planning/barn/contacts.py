"""What the robot touches: its footprint as a box in PyBullet among everything that stands and moves in a world.

The box is put where the robot's motion has brought it, and the engine finds the contacts; nothing is pushed, for a run ends there.
"""

import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.planning.barn.controllers import Robot
from benchmarks.planning.barn.worlds import World
from uvf.models.yaml_data import BadInput
from uvf.runtime.process.quiet import c_errors_discarded

with c_errors_discarded():
    import pybullet

Floats = NDArray[np.float64]

HEIGHT = 1.0  # m, of everything
NEAR = 2.0  # m from the robot's middle to a moving disc's edge, within which the engine is told where it is
AWAY = (0.0, 0.0, -100.0)  # m
SHAPE = '<collision><origin xyz="{x!r} {y!r} 0"/><geometry>{geometry}</geometry></collision>'


class Contacts:
    """A physics client of its own."""

    def __init__(self, world: World, robot: Robot) -> None:
        self._client: int = pybullet.connect(pybullet.DIRECT)
        self._standing = self._load(world)
        half = [robot.half_length, robot.half_width, HEIGHT / 4]
        box = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=half, physicsClientId=self._client)
        self._robot: int = pybullet.createMultiBody(1.0, box, physicsClientId=self._client)
        self._moving = [self._mover(radius) for radius in world.movers.discs[:, 0].tolist()]
        self._is_near = [False] * len(self._moving)
        self._reach = NEAR + max(robot.half_length, robot.half_width)

    def _load(self, world: World) -> int | None:
        """One body of all that stands. A line each: the engine's reader of URDF knows no long lines."""
        cylinders = [
            SHAPE.format(x=x, y=y, geometry=f'<cylinder radius="{radius!r}" length="{HEIGHT!r}"/>') for x, y, radius in world.discs.tolist()
        ]
        boxes = [SHAPE.format(x=x, y=y, geometry=f'<box size="{a!r} {b!r} {HEIGHT!r}"/>') for x, y, a, b in world.boxes.tolist()]
        if not cylinders and not boxes:
            return None
        inertia = '<inertial><mass value="0"/><inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial>'
        lines = ['<robot name="world">', '<link name="standing">', inertia, *cylinders, *boxes, "</link>", "</robot>"]
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "world.urdf")
            path.write_text("\n".join(lines))
            try:
                body: int = pybullet.loadURDF(str(path), useFixedBase=True, physicsClientId=self._client)
            except pybullet.error as error:
                raise BadInput(f"{world.name}: PyBullet cannot load it ({error}); it has {len(world.discs)} cylinders") from error
        return body

    def _mover(self, radius: float) -> int:
        shape = pybullet.createCollisionShape(pybullet.GEOM_CYLINDER, radius=radius, height=HEIGHT, physicsClientId=self._client)
        index: int = pybullet.createMultiBody(0.0, shape, basePosition=AWAY, physicsClientId=self._client)
        return index

    def touches(self, pose: Floats, movers: Floats) -> bool:
        """Whether the robot at ``pose`` (3,) x, y [m], yaw [rad] touches anything. movers: (n, 3) x, y, radius [m] now."""
        half_yaw = pose[2] / 2
        turned = (0.0, 0.0, float(np.sin(half_yaw)), float(np.cos(half_yaw)))
        pybullet.resetBasePositionAndOrientation(self._robot, (float(pose[0]), float(pose[1]), 0.0), turned, physicsClientId=self._client)
        self._move(pose, movers)
        pybullet.performCollisionDetection(physicsClientId=self._client)
        found = pybullet.getContactPoints(bodyA=self._robot, physicsClientId=self._client)
        return any(contact[8] <= 0.0 for contact in found)

    def _move(self, pose: Floats, movers: Floats) -> None:
        for i, (x, y, radius) in enumerate(movers.tolist()):
            near = bool(np.hypot(x - pose[0], y - pose[1]) < self._reach + radius)
            if near or self._is_near[i]:
                place = (x, y, 0.0) if near else AWAY
                pybullet.resetBasePositionAndOrientation(self._moving[i], place, (0.0, 0.0, 0.0, 1.0), physicsClientId=self._client)
            self._is_near[i] = near

    def close(self) -> None:
        """Disconnects the physics client."""
        pybullet.disconnect(physicsClientId=self._client)
