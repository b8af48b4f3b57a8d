"""The windsocks of the world in the wind of the simulation."""

from collections.abc import Callable, Sequence

import numpy as np

from schemas.messages import FrameTransform, FrameTransforms
from services.sim_air.environment.wind import AirMass, AirRelativeState
from uvf.maths.rotations import Floats
from uvf.models.world.file import Windsock
from uvf.models.world.wind import Wind
from uvf.models.world.windsock import LENGTH, hangs, top
from uvf.runtime.messages.convert import quaternion, stamp, vector

FOLLOWS = 1.0  # s, in which a sock follows the wind


class Windsocks:
    """Each in air of its own, which passes it as fast as the mean wind carries it."""

    def __init__(
        self, socks: Sequence[Windsock], wind: Wind, rng: Callable[[str], np.random.Generator], ground: Callable[[float, float], float]
    ) -> None:
        """rng: of a sock by its name; ground: its height at (x, y) [m, world]."""
        self._tops = {sock.name: top(sock) for sock in socks}
        self._heights = {name: float(at[2]) - ground(float(at[0]), float(at[1])) for name, at in self._tops.items()}
        self._air = {sock.name: AirMass(wind, LENGTH, rng(sock.name)) for sock in socks}
        self._shown: dict[str, Floats] = {}

    def blow(self, steady: Floats) -> None:
        """Takes another mean wind (3,) [m/s, world], without shear."""
        for air in self._air.values():
            air.blow(steady)

    def step(self, t: float, dt: float) -> FrameTransforms | None:
        """Their frames at ``t`` [s], ``dt`` [s] after those before: at the tops of their poles, x to where they point; None without any."""
        return FrameTransforms(transforms=[self._frame(name, t, dt) for name in self._tops]) if self._tops else None

    def _frame(self, name: str, t: float, dt: float) -> FrameTransform:
        at, height, air = self._tops[name], self._heights[name], self._air[name]
        mean = air.mean(height)
        passing = AirRelativeState(at, height, float(np.arctan2(mean[1], mean[0])), float(np.hypot(mean[0], mean[1])))
        blowing = air.step(t, dt, passing).velocity
        before = self._shown.get(name, blowing)
        shown = self._shown[name] = before + min(dt / FOLLOWS, 1.0) * (blowing - before)
        return FrameTransform(
            timestamp=stamp(t), parent_frame_id="world", child_frame_id=name, translation=vector(at), rotation=quaternion(hangs(shown))
        )
