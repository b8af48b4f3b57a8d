"""``follow:`` of a job: who follows whom where."""

from collections.abc import Mapping
from typing import Annotated

import msgspec
from msgspec import Meta

from uvf.models.keys import key, plain
from uvf.models.yaml_data import BadInput, FileLocation, nearest

Aside = Annotated[float, Meta(ge=-1000, le=1000)]


class Follow(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A station behind a leader, for an aircraft."""

    leader: Annotated[str, plain("Vehicle that is followed.")]
    behind: Annotated[float, Meta(gt=0, le=1000), key("m", "Distance behind the leader, along its path through the air.")]
    right: Annotated[Aside, key("m", "Offset to the right of the leader's path.")] = 0.0
    above: Annotated[Aside, key("m", "Offset above the leader.")] = 0.0


def check_follow(follows: Mapping[str, Follow], vehicles: Mapping[str, object], place: FileLocation) -> None:
    """Checks who follows whom; ``follows`` is by the follower's name. Raises BadInput for an unknown leader or a ring."""
    for name, follow in follows.items():
        where = place.at(name, "job", "follow", "leader")
        if follow.leader not in vehicles:
            raise BadInput(f"{where}: no vehicle '{follow.leader}'; {nearest(follow.leader, set(vehicles) - {name})}")
        if follow.leader == name:
            raise BadInput(f"{where}: {name} cannot follow itself; name another aircraft")
        if name in (chain := chain_of(name, follows)):
            raise BadInput(f"{where}: {' follows '.join([name, *chain])}: a circle without a leader; let one of them fly a mission")


def chain_of(name: str, follows: Mapping[str, Follow]) -> list[str]:
    """Names of the leader of ``name``, the leader's leader and so on; the chain ends where one comes up again."""
    chain: list[str] = []
    while name in follows and follows[name].leader not in chain:
        name = follows[name].leader
        chain.append(name)
    return chain


def offset_of(name: str, follows: Mapping[str, Follow]) -> tuple[float, float, float]:
    """Offset [m] of a formation slot behind, right of and above the first of all leaders."""
    parts = [follows[n] for n in (name, *chain_of(name, follows)) if n in follows]
    return sum(f.behind for f in parts), sum(f.right for f in parts), sum(f.above for f in parts)
