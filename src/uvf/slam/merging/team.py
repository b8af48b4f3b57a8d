"""Sessions of several vehicles that begin without knowing of each other, and grow together where they have been at the same places."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import permutations, product

import numpy as np
from numpy.typing import NDArray

from uvf.maths.alignment import aligned
from uvf.maths.se2 import IDENTITY, Pose2
from uvf.maths.se2_arrays import composed, inverted
from uvf.slam.maps.session import MappingSession
from uvf.slam.merging.joint import Crossing, JointGraph, session_of, settled, start_by
from uvf.slam.merging.pair import Pair
from uvf.slam.merging.part import VehicleMap
from uvf.slam.merging.ties import Ties, agreement, ties

Floats = NDArray[np.float64]

AGREEMENT = 0.7
"""Least agreement of two sessions that are one building; those that are alike here and there come to 0.5."""
LEAST_TIES = 8
"""Places at which two sessions have to fit once they are joined, unless fewer closures have said so: of those looked at there are only
so many where both have been in one room."""
AT_ONCE = 8  # places that are searched for before it is seen whether these are enough


@dataclass(frozen=True)
class MapGroup:
    """Sessions in one frame, the map of the first. common: by pairs of them, places where they must have seen the same."""

    joint: JointGraph
    common: Mapping[tuple[str, str], Ties] = field(default_factory=dict)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of its sessions, the first of which gives the frame."""
        return tuple(self.joint.poses)

    @property
    def quality(self) -> float:
        """How far its sessions agree about common places, 0 to 1; 1 for a session alone."""
        return agreement(self.common.values())


class Team:
    """Merges sessions, which are fed by name as often as they grow; works when told to."""

    def __init__(self) -> None:
        self.parts: dict[str, VehicleMap] = {}
        self.groups: list[MapGroup] = []
        self._pairs: dict[tuple[str, str], Pair] = {}
        self._refused: dict[tuple[str, str], int] = {}

    def follow(self, name: str, session: MappingSession) -> None:
        """Takes in a session; one that does not go on from what it was is taken for a new one. Raises BadInput."""
        part = self.parts.get(name)
        if part is None or not part.follow(session):
            part = VehicleMap(name)
            part.follow(session)
            self._forget(name)
            self.parts[name] = part
            self.groups.append(_alone(name, part))
            self._pairs |= {(other, name): Pair(self.parts[other], part) for other in self.parts if other != name}
        for pair in self._pairs.values():
            pair.grow()

    def work(self, most: int) -> bool:
        """Takes in what is new, and searches for at most ``most`` places; returns whether a map may have changed."""
        changed = [self._grow(group) for group in list(self.groups)]
        joined = False
        for (a, b), pair in self._pairs.items():
            if most > 0 and self.group_of(a) is not self.group_of(b) and (asked := pair.ask(most)):
                most -= asked
                joined = self._try(a, b, pair) or joined
        return joined or any(changed)

    def finish(self) -> None:
        """Works until there is nothing left to search for."""
        self.work(AT_ONCE)
        while any(pair.waiting for (a, b), pair in self._pairs.items() if self.group_of(a) is not self.group_of(b)):
            self.work(AT_ONCE)

    def group_of(self, name: str) -> MapGroup:
        """The group that a session belongs to."""
        return next(group for group in self.groups if name in group.names)

    def team_from_map(self, name: str) -> Pose2:
        """Pose of a session's map, as a whole, in the frame of its group."""
        if not len(self.parts[name]):
            return IDENTITY
        return aligned(self.group_of(name).joint.poses[name][:, :2], self.parts[name].poses[:, :2])

    def session_of(self, group: MapGroup) -> MappingSession:
        """One session of all keyframes and edges of a group."""
        return session_of(self._members(group), group.joint)

    def _members(self, *groups: MapGroup) -> dict[str, VehicleMap]:
        return {name: self.parts[name] for group in groups for name in group.names}

    def _forget(self, name: str) -> None:
        """Of a session that has begun anew; those that only it held together part."""
        if name not in self.parts:
            return
        self._pairs = {names: pair for names, pair in self._pairs.items() if name not in names}
        self._refused = {names: size for names, size in self._refused.items() if name not in names}
        group = self.group_of(name)
        self.groups.remove(group)
        crossings = [c for c in group.joint.crossings if name not in (c.a, c.b)]
        for names in _components([n for n in group.names if n != name], crossings):
            first = self.parts[names[0]]
            self.groups.append(_left(group, names, first.poses[0]) if len(names) > 1 else _alone(names[0], first))

    def _grow(self, group: MapGroup) -> bool:
        """Brings a group up to what its sessions are now."""
        parts = [self.parts[n] for n in group.names]
        if all(len(poses) == len(part) for poses, part in zip(group.joint.poses.values(), parts, strict=True)):
            return False
        self.groups[self.groups.index(group)] = self._grown(group) if len(group.names) > 1 else _alone(group.names[0], *parts)
        return True

    def _grown(self, group: MapGroup) -> MapGroup:
        before = group.joint.poses
        poses = {n: _extended(before[n], self.parts[n].poses) for n in group.names}
        new = {(a, b): ties(self.parts, poses, a, b, len(before[b])) for a, b in permutations(group.names, 2)}
        joint = settled(self._members(group), [*group.joint.crossings, *_crossings(new)], poses)
        return MapGroup(joint, {two: group.common[two] + more for two, more in new.items()})

    def _try(self, a: str, b: str, pair: Pair) -> bool:
        """Joins the groups of two sessions if these have met."""
        agreed = pair.met()
        if len(agreed) <= self._refused.get((a, b), 0):
            return False
        one, other = self.group_of(a), self.group_of(b)
        joined = self._joined(one, other, [Crossing(a, b, closure) for closure in agreed])
        if joined is None:
            self._refused[a, b] = len(agreed)
            return False
        self.groups.remove(other)
        self.groups[self.groups.index(one)] = joined
        return True

    def _joined(self, one: MapGroup, other: MapGroup, crossings: list[Crossing]) -> MapGroup | None:
        """Both groups in the frame of the first, tied wherever they have been near each other; None if too little of that fits."""
        poses, best = one.joint.poses, max(crossings, key=lambda c: c.closure.score)
        moved = start_by(best.closure, poses[best.a], other.joint.poses[best.b])
        shift = composed(moved[0], inverted(other.joint.poses[best.b][0]))
        starts = poses | {name: composed(shift, there) for name, there in other.joint.poses.items()}
        members, known = self._members(one, other), [*one.joint.crossings, *other.joint.crossings]
        joint = settled(members, [*known, *crossings], starts)
        both_ways = [*product(one.names, other.names), *product(other.names, one.names)]
        found = {(a, b): ties(self.parts, joint.poses, a, b) for a, b in both_ways}
        if agreement(found.values()) < AGREEMENT or len(_crossings(found)) < min(len(crossings), LEAST_TIES):
            return None
        joint = settled(members, [*known, *_crossings(found)], joint.poses)
        return MapGroup(joint, {**one.common, **other.common, **found})


def _alone(name: str, part: VehicleMap) -> MapGroup:
    return MapGroup(JointGraph({name: part.poses}, []))


def _left(group: MapGroup, names: list[str], map_from_first: Floats) -> MapGroup:
    """Those of a group, in the map frame of the first of them. map_from_first: (3,) where its first keyframe is in that."""
    joint = group.joint
    first_from_team = composed(map_from_first, inverted(joint.poses[names[0]][0]))
    poses = {n: composed(first_from_team, joint.poses[n]) for n in names}
    common = {pair: found for pair, found in group.common.items() if set(pair) <= set(names)}
    return MapGroup(JointGraph(poses, [c for c in joint.crossings if {c.a, c.b} <= set(names)]), common)


def _crossings(found: Mapping[tuple[str, str], Ties]) -> list[Crossing]:
    return [crossing for of_two in found.values() for crossing in of_two.crossings]


def _extended(placed: Floats, own: Floats) -> Floats:
    """(n, 3): keyframes that are new behind the last one that is placed."""
    if len(placed) == len(own):
        return placed
    return np.concatenate((placed, composed(composed(placed[-1], inverted(own[len(placed) - 1])), own[len(placed) :])))


def _components(names: list[str], crossings: list[Crossing]) -> Iterator[list[str]]:
    """Names that crossings hold together, in their order."""
    left = list(names)
    while left:
        found = {left[0]}
        while more := {n for c in crossings for n in (c.a, c.b) if found & {c.a, c.b}} - found:
            found |= more
        yield [n for n in left if n in found]
        left = [n for n in left if n not in found]
