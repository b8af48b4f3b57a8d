"""The frames that a vehicle's messages speak of, as axes: x red, y green, z blue."""

from collections.abc import Iterable

from schemas.messages import FrameTransform, FrameTransforms
from services.gcs.view.drawing import Axes
from uvf.maths.rotations import multiply, rotate
from uvf.runtime.messages.convert import array, wxyz

MOST = 40


def fixed_frames(told: FrameTransforms, root: str, length: float) -> dict[str, Axes]:
    """Axes, by the frame's own name, of the frames that are fixed to ``root``, in its frame; one that hangs on none of them is left out."""
    waiting, found = list(told.transforms)[:MOST], {root: Axes(length)}
    while ready := [one for one in waiting if _own(one.parent_frame_id) in found]:
        for one in ready:
            base = found[_own(one.parent_frame_id)]
            turn, place = wxyz(one.rotation), array(one.translation)
            name = _own(one.child_frame_id)
            found.setdefault(name, Axes(length, base.position + rotate(base.wxyz, place), multiply(base.wxyz, turn)))
        waiting = [one for one in waiting if one not in ready]
    return found


def chained(frames: Iterable[FrameTransform], length: float) -> Axes:
    """Axes at the end of a chain of transforms, the outermost first."""
    end = Axes(length)
    for one in frames:
        end = Axes(length, end.position + rotate(end.wxyz, array(one.translation)), multiply(end.wxyz, wxyz(one.rotation)))
    return end


def _own(frame_id: str) -> str:
    """Without the vehicle's name."""
    return frame_id.rpartition("/")[2]
