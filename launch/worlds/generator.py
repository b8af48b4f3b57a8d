"""Made-up houses: rooms by cutting a rectangle, doors that join them all, furniture that shuts none of them off; decided by the seed."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import msgspec
import numpy as np

from uvf.models.importing.heights import HOME
from uvf.models.world.file import Box, Colour, Field, Wall, WorldFile
from uvf.models.world.geometry import FloorPlan, floor_plan, reachable_floor

ROOM_AREA = 16.0  # m^2 on average
SHORTEST = 2.4  # m, side of a room
FRAME = 0.25  # m of wall at least on either side of a door
DOORS = (0.9, 1.1)  # m
EXTRA_DOORS = 0.3  # share of the walls without need of a door that get one
CLEAR = 0.7  # m before a door that stay free
PASSER = 0.3  # m, radius of the robot that gets everywhere
RESOLUTION = 0.05  # m
LEFT_FREE = 0.55  # of the room that this robot still covers
TRIES = 100
FLOORS: Sequence[Colour] = ((0.66, 0.53, 0.38), (0.7, 0.68, 0.64), (0.58, 0.46, 0.34), (0.62, 0.66, 0.68), (0.55, 0.5, 0.46))


class Room(NamedTuple):
    """A rectangular room: its edges [m, world]."""

    x_min: float
    y_min: float
    x_max: float
    y_max: float

    @property
    def sides(self) -> tuple[float, float]:
        """Its lengths along x and y [m]."""
        return self.x_max - self.x_min, self.y_max - self.y_min

    @property
    def middle(self) -> tuple[float, float]:
        """Its centre (x, y) [m, world]."""
        return (self.x_min + self.x_max) / 2, (self.y_min + self.y_max) / 2


class Border(NamedTuple):
    """A stretch of wall between two rooms (their indices), begin and end [m]; door: (x, y) of the middle and width [m], or None."""

    rooms: tuple[int, int]
    begin: tuple[float, float]
    end: tuple[float, float]
    door: tuple[float, float, float] | None = None


class Piece(NamedTuple):
    """A piece of furniture; size: width along the wall, depth, height [m]."""

    name: str
    size: tuple[float, float, float]
    colour: Colour
    at_wall: bool = True


PIECES = (
    Piece("sofa", (1.9, 0.85, 0.6), (0.25, 0.35, 0.55)),
    Piece("bed", (1.6, 2.0, 0.5), (0.6, 0.28, 0.28)),
    Piece("shelf", (1.3, 0.35, 1.8), (0.4, 0.28, 0.18)),
    Piece("cupboard", (1.1, 0.5, 1.9), (0.75, 0.72, 0.66)),
    Piece("desk", (1.5, 0.75, 0.74), (0.5, 0.36, 0.22)),
    Piece("chest", (0.9, 0.45, 0.85), (0.6, 0.45, 0.3)),
    Piece("armchair", (0.75, 0.75, 0.7), (0.3, 0.45, 0.32), at_wall=False),
    Piece("table", (1.2, 0.8, 0.74), (0.58, 0.42, 0.26), at_wall=False),
    Piece("box", (0.45, 0.45, 0.4), (0.72, 0.58, 0.4), at_wall=False),
)


def generate(rooms: int, seed: int) -> WorldFile:
    """A house of so many rooms, all mutually reachable for a robot of radius ``PASSER``."""
    rng = np.random.default_rng(seed)
    while True:
        cut = _cut(rooms, rng)
        borders = _with_doors(list(_borders(cut)), len(cut), rng)
        if borders is not None:
            break
    bare = _bare(cut, borders, f"A made-up house of {rooms} rooms (uvf world new house --rooms {rooms} --seed {seed}).")
    return _furnished(bare, cut, borders, rng)


def _cut(rooms: int, rng: np.random.Generator) -> list[Room]:
    """Always the largest room is cut, across its longer side."""
    width = float(np.round(np.sqrt(rooms * ROOM_AREA * rng.uniform(1.1, 1.6)), 1))
    cut = [Room(0.0, 0.0, width, float(np.round(max(rooms * ROOM_AREA / width, SHORTEST), 1)))]
    while len(cut) < rooms:
        largest = max(cut, key=lambda r: r.sides[0] * r.sides[1])
        cut.remove(largest)
        cut += _halves(largest, float(rng.uniform(0.38, 0.62)))
    return sorted(cut)


def _halves(room: Room, share: float) -> tuple[Room, Room]:
    width, depth = room.sides
    if width >= depth:
        x = round(room.x_min + share * width, 2)
        return Room(room.x_min, room.y_min, x, room.y_max), Room(x, room.y_min, room.x_max, room.y_max)
    y = round(room.y_min + share * depth, 2)
    return Room(room.x_min, room.y_min, room.x_max, y), Room(room.x_min, y, room.x_max, room.y_max)


def _borders(rooms: Sequence[Room]) -> Iterator[Border]:
    for i, a in enumerate(rooms):
        for k, b in enumerate(rooms[:i]):
            low = (max(a.x_min, b.x_min), max(a.y_min, b.y_min))
            high = (min(a.x_max, b.x_max), min(a.y_max, b.y_max))
            if (low[0] == high[0] and low[1] < high[1]) or (low[1] == high[1] and low[0] < high[0]):
                yield Border((k, i), low, high)


def _with_doors(borders: list[Border], rooms: int, rng: np.random.Generator) -> list[Border] | None:
    """Doors that join all rooms, and some more; None when the walls are too short for that."""
    joined = list(range(rooms))
    made = list(borders)
    for n in rng.permutation(len(borders)):
        border = borders[n]
        length = float(np.hypot(border.end[0] - border.begin[0], border.end[1] - border.begin[1]))
        width = float(np.round(rng.uniform(*DOORS), 2))
        one, other = (joined[room] for room in border.rooms)
        wanted = one != other or rng.random() < EXTRA_DOORS
        if wanted and length >= width + 2 * FRAME:
            along = float(np.round(rng.uniform(FRAME + width / 2, length - FRAME - width / 2), 2))
            share = along / length
            x, y = (b + share * (e - b) for b, e in zip(border.begin, border.end, strict=True))
            made[n] = border._replace(door=(x, y, width))
            joined = [one if group == other else group for group in joined]
    return made if len(set(joined)) == 1 else None


def _bare(rooms: Sequence[Room], borders: Sequence[Border], about: str) -> WorldFile:
    x_max, y_max = max(r.x_max for r in rooms), max(r.y_max for r in rooms)
    outside = Wall([(0.0, 0.0), (x_max, 0.0), (x_max, y_max), (0.0, y_max), (0.0, 0.0)], thickness=0.2, colour=(0.8, 0.7, 0.58))
    walls = [outside, *(Wall(stretch) for border in borders for stretch in _stretches(border))]
    fields = [Field((r.x_min, r.y_min, r.x_max, r.y_max), FLOORS[i % len(FLOORS)]) for i, r in enumerate(rooms)]
    return WorldFile(about, HOME, (0.0, 0.0, x_max, y_max), walls=walls, fields=fields)


def _stretches(border: Border) -> list[list[tuple[float, float]]]:
    """The wall, or both sides of its door."""
    if border.door is None:
        return [[border.begin, border.end]]
    x, y, width = border.door
    dx, dy = (width / 2, 0.0) if border.begin[1] == border.end[1] else (0.0, width / 2)
    return [[border.begin, (round(x - dx, 3), round(y - dy, 3))], [(round(x + dx, 3), round(y + dy, 3)), border.end]]


def _furnished(world: WorldFile, rooms: Sequence[Room], borders: Sequence[Border], rng: np.random.Generator) -> WorldFile:
    """Piece by piece; one that shuts something off is taken out again."""
    doors = [border.door for border in borders if border.door is not None]
    for number, room in enumerate(rooms, 1):
        width, depth = room.sides
        for _ in range(int(width * depth / 4.0) + 1):
            box = _piece(room, rng, f"{number}_{len(world.boxes)}")
            fuller = msgspec.structs.replace(world, boxes=[*world.boxes, box])
            if _is_clear(box, world.boxes, doors) and all_reachable(fuller, rooms):
                world = fuller
    return world


def _piece(room: Room, rng: np.random.Generator, number: str) -> Box:
    """Somewhere in the room, along a wall or free."""
    piece = PIECES[rng.integers(len(PIECES))]
    turned = bool(rng.random() < 0.5)
    wide, deep, high = piece.size
    size = (deep, wide, high) if turned else (wide, deep, high)
    low = [edge + s / 2 + 0.12 for edge, s in zip(room[:2], size, strict=False)]
    top = [edge - s / 2 - 0.12 for edge, s in zip(room[2:], size, strict=False)]
    place = [float(rng.uniform(a, b)) if a < b else (a + b) / 2 for a, b in zip(low, top, strict=True)]
    if piece.at_wall:
        across = 0 if turned else 1
        place[across] = low[across] if rng.random() < 0.5 else top[across]
    name = f"{piece.name}_{number}"
    return Box(name, (round(place[0], 2), round(place[1], 2), high / 2), size, colour=piece.colour)


def _is_clear(box: Box, others: Sequence[Box], doors: Sequence[tuple[float, float, float]]) -> bool:
    """Neither in another piece nor before a door."""
    x, y, _ = box.centre
    half_x, half_y = box.size[0] / 2, box.size[1] / 2
    if any(np.hypot(max(abs(dx - x) - half_x, 0.0), max(abs(dy - y) - half_y, 0.0)) < CLEAR for dx, dy, _ in doors):
        return False
    return not any(abs(o.centre[0] - x) < half_x + o.size[0] / 2 and abs(o.centre[1] - y) < half_y + o.size[1] / 2 for o in others)


def all_reachable(world: WorldFile, rooms: Sequence[Room]) -> bool:
    """Whether a robot of radius ``PASSER`` covers enough of every room from one start."""
    plan = floor_plan(world, RESOLUTION)
    start = free_start(plan, rooms[0])
    if start is None:
        return False
    reached = reachable_floor(plan, *start, PASSER)
    for room in rooms:
        (r0, c0), (r1, c1) = plan.cell(*room[:2]), plan.cell(*room[2:])
        free = ~plan.cells[r0:r1, c0:c1]
        if reached[r0:r1, c0:c1].sum() < LEFT_FREE * free.sum():
            return False
    return True


def free_start(plan: FloorPlan, room: Room) -> tuple[float, float] | None:
    """The place (x, y) [m, world] nearest to the room's middle where a robot of radius ``PASSER`` fits; None when there is none."""
    x, y = plan.centres()
    (r0, c0), (r1, c1) = plan.cell(*room[:2]), plan.cell(*room[2:])
    window = np.s_[r0:r1, c0:c1]
    order = np.argsort(np.hypot(x[window] - room.middle[0], y[window] - room.middle[1]), axis=None)
    for n in order[:: max(1, len(order) // TRIES)]:
        row, column = np.unravel_index(n, x[window].shape)
        place = (float(x[window][row, column]), float(y[window][row, column]))
        if reachable_floor(plan, *place, PASSER).any():
            return place
    return None
