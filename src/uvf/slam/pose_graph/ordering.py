"""In which order the poses of a graph are eliminated, so that the factor of its normal matrix stays sparse.

Approximate minimum degree on a quotient graph: Amestoy, Davis, Duff, "An Approximate Minimum Degree Ordering Algorithm"
(1996), with aggressive absorption and mass elimination, without supervariables. What has been eliminated is an *element*,
known by the *members* it ties together; their lists are at the same time the structure of the factor.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvf.maths.compiled import compiled

Ints = NDArray[np.int64]


class Elimination(NamedTuple):
    """Elimination order. pivots: (n,) poses as they go; supernode s eliminates pivots[starts[s] : starts[s + 1]] together.

    Each of those is tied to all others of them and to rows[row_starts[s] : row_starts[s + 1]], eliminated later.
    """

    pivots: Ints
    starts: Ints
    rows: Ints
    row_starts: Ints


class Quotient(NamedTuple):
    """Pose i touches the poses ``neighbours[start[i]:][:near[i]]`` and the elements ``elements[start[i]:][:over[i]]``.

    The members of element e are at first[e], ``size[e]`` of them; those of one that was absorbed are not looked at again.
    """

    start: Ints
    neighbours: Ints
    near: Ints
    elements: Ints
    over: Ints
    first: Ints
    size: Ints
    absorbed: NDArray[np.bool_]
    tag: Ints
    outside: Ints


class Queue(NamedTuple):
    """Poses by degree: doubly linked lists, one a degree; -1 is none."""

    degree: Ints
    head: Ints
    after: Ints
    before: Ints


@compiled
def _push(queue: Queue, i: int, degree: int) -> None:
    following = queue.head[degree]
    queue.degree[i], queue.after[i], queue.before[i] = degree, following, -1
    if following >= 0:
        queue.before[following] = i
    queue.head[degree] = i


@compiled
def _drop(queue: Queue, i: int) -> None:
    before, after = queue.before[i], queue.after[i]
    if before >= 0:
        queue.after[before] = after
    else:
        queue.head[queue.degree[i]] = after
    if after >= 0:
        queue.before[after] = before


@compiled
def _gather(q: Quotient, p: int, members: Ints, top: int) -> int:
    """Writes all that touches p behind ``top``, tags it with p, and absorbs the elements of p; how many."""
    count = 0
    q.tag[p] = p
    for k in range(q.start[p], q.start[p] + q.near[p]):
        v = q.neighbours[k]
        q.tag[v] = p
        members[top + count] = v
        count += 1
    for k in range(q.start[p], q.start[p] + q.over[p]):
        e = q.elements[k]
        q.absorbed[e] = True
        for m in range(q.first[e], q.first[e] + q.size[e]):
            v = members[m]
            if q.tag[v] != p:
                q.tag[v] = p
                members[top + count] = v
                count += 1
    return count


@compiled
def _prune(q: Quotient, i: int, p: int, seen: Ints) -> None:
    """Takes from pose i what element p now covers, and counts the members that its other elements have outside p."""
    at = q.start[i]
    kept = 0
    for k in range(at, at + q.near[i]):
        v = q.neighbours[k]
        if q.tag[v] != p:
            q.neighbours[at + kept] = v
            kept += 1
    q.near[i] = kept
    kept = 0
    for k in range(at, at + q.over[i]):
        e = q.elements[k]
        if not q.absorbed[e]:
            if seen[e] != p:
                seen[e], q.outside[e] = p, q.size[e]
            q.outside[e] -= 1
            q.elements[at + kept] = e
            kept += 1
    q.over[i] = kept


@compiled
def _outer_degree(q: Quotient, i: int) -> int:
    """How many poses i touches outside the newest element, at most; elements wholly inside it are absorbed."""
    degree, kept, at = int(q.near[i]), 0, q.start[i]
    for k in range(at, at + q.over[i]):
        e = q.elements[k]
        if q.outside[e] > 0:
            degree += q.outside[e]
            q.elements[at + kept] = e
            kept += 1
        else:
            q.absorbed[e] = True
    q.over[i] = kept
    return degree


@compiled
def _requeue(q: Quotient, queue: Queue, p: int, members: Ints, outer: Ints) -> int:
    """New degrees of the members of p; the least of them."""
    least: int = q.start.shape[0]
    inner = q.size[p] - 1
    for m in range(q.first[p], q.first[p] + q.size[p]):
        i = members[m]
        q.elements[q.start[i] + q.over[i]] = p
        q.over[i] += 1
        degree = min(outer[i] + inner, queue.degree[i] + inner)
        _push(queue, i, degree)
        least = min(least, degree)
    return least


@compiled
def _eliminate(q: Quotient, queue: Queue, p: int, members: Ints, work: tuple[Ints, Ints, Ints], done: int) -> int:
    """Turns p into an element, with the members that nothing else ties; writes them to the pivots behind ``done``."""
    seen, outer, pivots = work
    first = q.first[p]
    count = _gather(q, p, members, first)
    pivots[done] = p
    done += 1
    for m in range(first, first + count):
        _drop(queue, members[m])
        _prune(q, members[m], p, seen)
    kept = 0
    for m in range(first, first + count):
        i = members[m]
        outer[i] = _outer_degree(q, i)
        if outer[i] == 0:
            pivots[done] = i
            done += 1
        else:
            members[first + kept] = i
            kept += 1
    q.size[p] = kept
    return done


@compiled
def minimum_degree(start: Ints, neighbours: Ints) -> Elimination:
    """Elimination order of the poses of a graph.

    Neighbours of pose i: neighbours[start[i] : start[i + 1]], each once, without i itself, and i among theirs.
    """
    n = start.shape[0] - 1
    near = np.empty(n, np.int64)
    for i in range(n):
        near[i] = start[i + 1] - start[i]
    q = Quotient(
        start,
        neighbours.copy(),
        near,
        np.empty_like(neighbours),
        np.zeros(n, np.int64),
        np.zeros(n, np.int64),
        np.zeros(n, np.int64),
        np.zeros(n, np.bool_),
        np.full(n, -1),
        np.zeros(n, np.int64),
    )
    queue = Queue(np.zeros(n, np.int64), np.full(n + 1, -1), np.full(n, -1), np.full(n, -1))
    for i in range(n - 1, -1, -1):
        _push(queue, i, q.near[i])
    work = np.full(n, -1), np.zeros(n, np.int64), np.empty(n, np.int64)
    members = np.empty(8 * n + neighbours.shape[0], np.int64)
    starts, row_starts = np.zeros(n + 1, np.int64), np.zeros(n + 1, np.int64)
    done, top = starts[0], row_starts[0]
    supernodes = least = 0
    while done < n:
        while queue.head[least] < 0:
            least += 1
        p = queue.head[least]
        _drop(queue, p)
        if top + least > members.shape[0]:
            members = np.concatenate((members, np.empty(members.shape[0] + least, np.int64)))
        q.first[p] = top
        done = _eliminate(q, queue, p, members, work, done)
        least = min(least, _requeue(q, queue, p, members, work[1]))
        top += q.size[p]
        supernodes += 1
        starts[supernodes], row_starts[supernodes] = done, top
    return Elimination(work[2], starts[: supernodes + 1].copy(), members[:top].copy(), row_starts[: supernodes + 1].copy())
