"""A link that joints move, and what sits on it."""

from collections.abc import Mapping

from uvf.maths.se3 import IDENTITY, Transform, compose, inverse
from uvf.models.urdf.robot import UrdfModel


class Carrier:
    """The link that a sensor sits on, whose mount is given in base_link with all joints at zero."""

    def __init__(self, model: UrdfModel, link: str) -> None:
        self._model, self._link = model, link
        self._link_from_rest = inverse(model.link_poses()[link])
        self._known: tuple[Mapping[str, float], Transform] = {}, IDENTITY

    def moved(self, positions: Mapping[str, float]) -> Transform:
        """Where base_link would be if it had moved with the link, in base_link. positions: of joints by their names [rad or m]."""
        if positions != self._known[0]:
            self._known = positions, compose(self._model.link_poses(positions)[self._link], self._link_from_rest)
        return self._known[1]
