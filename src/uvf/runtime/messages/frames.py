"""The tree of frames over the last seconds: where was one frame in another at a time.

Semantics of tf2 (Foote, "tf: The Transform Library", TePRA 2013): each frame has one parent, samples are interpolated
between neighbours and never extrapolated, static edges hold at all times, and without a time the newest one counts
at which every edge on the way is known.
"""

from bisect import bisect_left
from collections.abc import Iterator
from functools import reduce

import numpy as np
from google.protobuf.message import Message

from schemas.messages import FrameTransform, FrameTransforms
from uvf.maths.se3 import IDENTITY, Transform, compose, interpolate, inverse
from uvf.models.yaml_data import nearest
from uvf.runtime.messages.convert import array, wxyz
from uvf.runtime.messages.step_times import NS

HISTORY = 10.0  # s


class FrameError(LookupError):
    """A transform that is not known; one line says which and why."""


class FrameEdge:
    """Samples of ``parent_from_child`` by time [ns]; a static one has a single sample that holds at all times."""

    def __init__(self, parent: str, is_static: bool) -> None:
        self.parent = parent
        self.is_static = is_static
        self._times: list[int] = []
        self._samples: list[Transform] = []

    @property
    def oldest(self) -> int:
        """Time [ns] of the oldest sample."""
        return self._times[0]

    @property
    def newest(self) -> int:
        """Time [ns] of the newest sample."""
        return self._times[-1]

    def add(self, t_ns: int, sample: Transform, history_ns: int) -> None:
        """Adds a sample in order of time, however they come; of two with one stamp the first holds. Static: the newest holds."""
        if self.is_static:
            self._times, self._samples = [t_ns], [sample]
            return
        i = bisect_left(self._times, t_ns)
        if i < len(self._times) and self._times[i] == t_ns:
            return
        self._times.insert(i, t_ns)
        self._samples.insert(i, sample)
        old = bisect_left(self._times, self.newest - history_ns)
        del self._times[:old], self._samples[:old]

    def at(self, t_ns: int) -> Transform:
        """Transform at a time [ns] between ``oldest`` and ``newest``, both included."""
        if self.is_static:
            return self._samples[0]
        i = bisect_left(self._times, t_ns)
        if self._times[i] == t_ns:
            return self._samples[i]
        before, after = self._times[i - 1], self._times[i]
        return interpolate(self._samples[i - 1], self._samples[i], (t_ns - before) / (after - before))


class FrameBuffer:
    """All edges heard of, by child frame. A frame that comes with another parent has moved there: what was before is forgotten."""

    def __init__(self, history: float = HISTORY) -> None:
        """history: how far back [s] from the newest sample each edge is kept."""
        self._history_ns = round(history * NS)
        self._edges: dict[str, FrameEdge] = {}
        self._parents: set[str] = set()
        """Every frame that has been named as a parent."""

    def add(self, message: Message, is_static: bool = False) -> None:
        """Adds one transform, or all of a ``FrameTransforms``."""
        if isinstance(message, FrameTransforms):
            for transform in message.transforms:
                self._add(transform, is_static)
        elif isinstance(message, FrameTransform):
            self._add(message, is_static)
        else:
            raise TypeError(f"{type(message).__name__} is no transform")

    def _add(self, message: FrameTransform, is_static: bool) -> None:
        """One that is no number is left out, as if it had not been told."""
        rotation, translation = wxyz(message.rotation), array(message.translation)
        if not (np.isfinite(rotation).all() and np.isfinite(translation).all()):
            return
        child, parent = message.child_frame_id, message.parent_frame_id
        edge = self._edges.get(child)
        if edge is None or (edge.parent, edge.is_static) != (parent, is_static):
            edge = self._edges[child] = FrameEdge(parent, is_static)
            self._parents.add(parent)
        t_ns = message.timestamp.seconds * NS + message.timestamp.nanos
        edge.add(t_ns, Transform(rotation / np.linalg.norm(rotation), translation), self._history_ns)

    @property
    def frames(self) -> set[str]:
        """Names of all frames."""
        return {*self._edges, *self._parents}

    def lookup(self, target: str, source: str, t: float | None = None) -> Transform:
        """Transform ``target_from_source`` at ``t`` [s], or at the newest time known to the whole way. Raises FrameError."""
        down, up = self._ways(target, source)
        t_ns = self._newest_common((*down, *up)) if t is None else round(t * NS)
        for child in (*down, *up):
            self._check_known(child, t_ns)
        above_from_source = self._climb(up, t_ns)
        return compose(inverse(self._climb(down, t_ns)), above_from_source) if down else above_from_source

    def _ways(self, target: str, source: str) -> tuple[list[str], list[str]]:
        """The frames from target and from source up to, but without, the nearest frame above both."""
        down, up = list(self._above(target)), list(self._above(source))
        if down[-1] != up[-1]:
            raise FrameError(f"'{target}' and '{source}' are not in one tree: one hangs on '{down[-1]}', the other on '{up[-1]}'")
        while down and up and down[-1] == up[-1]:
            down.pop()
            up.pop()
        return down, up

    def _above(self, frame: str) -> Iterator[str]:
        """The frame and all above it, the root last."""
        if frame not in self._edges and frame not in self._parents:
            raise FrameError(f"no frame '{frame}'; {nearest(frame, self.frames)}")
        yield frame
        seen = {frame}
        while (edge := self._edges.get(frame)) is not None:
            frame = edge.parent
            if frame in seen:
                raise FrameError(f"the frames {' and '.join(repr(f) for f in sorted(self._loop(frame)))} hang on each other in a loop")
            seen.add(frame)
            yield frame

    def _loop(self, frame: str) -> set[str]:
        found = {frame}
        while (frame := self._edges[frame].parent) not in found:
            found.add(frame)
        return found

    def _newest_common(self, way: tuple[str, ...]) -> int:
        return min((self._edges[child].newest for child in way if not self._edges[child].is_static), default=0)

    def _check_known(self, child: str, t_ns: int) -> None:
        edge = self._edges[child]
        if edge.is_static or edge.oldest <= t_ns <= edge.newest:
            return
        late = t_ns > edge.newest
        known, gap = (edge.newest, t_ns - edge.newest) if late else (edge.oldest, edge.oldest - t_ns)
        raise FrameError(
            f"'{child}' in '{edge.parent}' is not known at {t_ns / NS:.3f} s: that is {gap / NS:.3f} s "
            f"{'after the newest' if late else 'before the oldest'} ({known / NS:.3f} s)"
        )

    def _climb(self, way: list[str], t_ns: int) -> Transform:
        """From the first frame of a way to the parent of its last: ``above_from_first``."""
        samples = [self._edges[child].at(t_ns) for child in way]
        return reduce(lambda below, above: compose(above, below), samples) if samples else IDENTITY
