"""Windsocks: each hangs from the top of its pole as the air simulation says, straight down where that says nothing."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from services.gcs.state.vehicle_model import DisplayPose
from services.gcs.view.drawing import Node
from services.gcs.view.scene.scenery import coloured
from uvf.models.world.file import Windsock
from uvf.models.world.windsock import ORANGE, cloth, hangs, top

Floats = NDArray[np.float64]

CALM = np.zeros(3)


def sock_nodes(socks: Sequence[Windsock]) -> dict[str, Node]:
    """The cloth of each in its own frame, by node name."""
    return {f"{_frame(sock)}/{part}": node for sock in socks for part, node in coloured(cloth(), ORANGE).items()}


def sock_places(socks: Sequence[Windsock], pointing: Mapping[str, Floats]) -> dict[str, DisplayPose]:
    """Their frames, by node name. pointing: attitudes wxyz (4,), world from sock, by name."""
    return {_frame(sock): DisplayPose(top(sock), pointing.get(sock.name, hangs(CALM))) for sock in socks}


def _frame(sock: Windsock) -> str:
    return f"/world/windsocks/{sock.name}"
