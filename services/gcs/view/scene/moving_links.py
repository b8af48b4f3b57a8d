"""Where the links of a ground vehicle are that its joints move: steering, lift, pan, arm; one that has hardly moved stays as it was."""

from collections.abc import Mapping, Sequence

from schemas.messages import JointStates
from services.gcs.state.vehicle_model import DisplayPose
from uvf.models.urdf.robot import UrdfModel
from uvf.runtime.messages.joints import positions_of

SEEN = 0.005  # rad or m, steps smaller than that are not shown


class MovingLinks:
    """The links behind some joints of one vehicle."""

    def __init__(self, model: UrdfModel, joints: Sequence[str]) -> None:
        self._model = model
        self._links = [model.joints[name].child for name in joints]
        self._positions = dict.fromkeys(joints, 0.0)
        self._heard: JointStates | None = None
        self._placed = self._poses()

    def places(self, heard: JointStates | None) -> Mapping[str, DisplayPose]:
        """Poses of the links in the body frame, by name; the same objects while nothing visible moves."""
        if heard is not None and heard is not self._heard:
            self._heard = heard
            told = positions_of(heard)
            now = {name: told.get(name, before) for name, before in self._positions.items()}
            if any(abs(now[name] - before) > SEEN for name, before in self._positions.items()):
                self._positions = now
                self._placed = self._poses()
        return self._placed

    def _poses(self) -> dict[str, DisplayPose]:
        poses = self._model.link_poses(self._positions)
        return {link: DisplayPose(poses[link].translation, poses[link].rotation) for link in self._links}
