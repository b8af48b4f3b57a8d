"""A 3-D occupancy map of cells that are occupied, free or unknown: rays go in, questions are answered."""

import numpy as np
from numpy.typing import NDArray

from uvf.slam.octree.blocks import apply_marks, cast, put_in, rehash, set_blocks, set_cells, values_at
from uvf.slam.octree.layout import BLOCKS, CELLS, HIGHEST, LOWEST, REACH, SPARE, TOUCHED, Blocks, Marks

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Ints = NDArray[np.int64]

FIRST_BLOCKS = 4096
FREE, OCCUPIED, NOT_KNOWN = 0, 1, -1


class Octree:
    """A 3-D occupancy map. Its cells are cubes of ``resolution`` [m], the first from the frame's origin on.

    It reaches 4 194 300 of them to each side. What is measured and how sure it is are OctoMap's (``layout.py``); a cell is occupied
    from log-odds 0 on. Points and directions are taken in single precision, as there.
    """

    def __init__(self, resolution: float) -> None:
        self.resolution = resolution
        self._blocks = Blocks(
            np.full(2 * FIRST_BLOCKS, -1, dtype=np.int32),
            np.empty(FIRST_BLOCKS, dtype=np.int64),
            np.empty(FIRST_BLOCKS, dtype=np.int32),
            np.empty(FIRST_BLOCKS, dtype=np.float32),
            np.empty((0, CELLS), dtype=np.float32),
            np.empty(0, dtype=np.int32),
            np.zeros(3, dtype=np.int64),
        )
        self._marks = _marks(FIRST_BLOCKS, FIRST_BLOCKS)

    @property
    def is_empty(self) -> bool:
        """Whether nothing is known."""
        return self.block_count == 0

    @property
    def block_count(self) -> int:
        """Number of blocks of cells of which anything is known."""
        return int(self._blocks.counts[BLOCKS])

    @property
    def memory(self) -> int:
        """Memory taken in bytes, with what is kept for growing and for the next scan."""
        return sum(array.nbytes for array in (*self._blocks, *self._marks))

    @property
    def blocks(self) -> Blocks:
        """The blocks, for kernels that read the whole map."""
        return self._blocks

    def insert(self, origin: Floats, points: Floats, reach: float = np.inf) -> None:
        """Inserts one scan: origin (3,) [m], where it was taken from, and points (n, 3) [m], where its beams ended.

        A beam longer than ``reach`` [m] has met nothing: it is free as far as there (that is how those without a return are told).
        Points that are not finite, and beams that leave the map, are left out.
        """
        with np.errstate(over="ignore"):
            start, beams = np.array(origin, dtype=np.float32), np.array(points, dtype=np.float32, order="C").reshape(-1, 3)
        scan = (start, beams, float(reach))
        done, wanted = put_in(self._blocks, self._marks, scan, self.resolution, 0)
        while done < len(beams):
            self._grow_for_ray(wanted)
            done, wanted = put_in(self._blocks, self._marks, scan, self.resolution, done)
        if wanted:
            self._grow_rows(wanted)
            apply_marks(self._blocks, self._marks)

    def log_odds(self, points: Floats) -> Singles:
        """Log-odds (n,) of the cells at points (n, 3) [m]; NaN where nothing is known."""
        return values_at(self._blocks, np.ascontiguousarray(points, dtype=np.float32).reshape(-1, 3), self.resolution)

    def states(self, points: Floats) -> NDArray[np.int8]:
        """State (n,) of the cells at points (n, 3) [m]: OCCUPIED, FREE or NOT_KNOWN."""
        values = self.log_odds(points)
        return np.where(np.isnan(values), NOT_KNOWN, np.where(values >= 0.0, OCCUPIED, FREE)).astype(np.int8)

    def cast(self, origins: Floats, directions: Floats, reach: float = 0.0, through_unknown: bool = False) -> Floats:
        """Middles (n, 3) [m] of the first occupied cell on each ray; NaN where nothing, or something unknown, comes first.

        origins (n, 3) [m]; directions (n, 3), of any length; reach: to a cell's middle [m], 0 = to the map's end.
        """
        starts, along = (np.ascontiguousarray(a, dtype=np.float32).reshape(-1, 3) for a in (origins, directions))
        cells = cast(self._blocks, (starts, along, float(reach)), self.resolution, through_unknown)
        return np.where(cells >= 0, (cells - REACH + 0.5) * self.resolution, np.nan)

    def set_cells(self, keys: Ints, inside: Ints, values: Singles) -> None:
        """Gives cells log-odds (n,), clamped. keys: (n,) of their blocks, inside: (n,) Morton numbers within these."""
        fresh = np.unique(keys)
        self._grow_blocks(self.block_count + len(fresh))
        self._grow_rows(len(fresh))
        set_cells(self._blocks, keys, inside, np.clip(values, LOWEST, HIGHEST))

    def set_blocks(self, keys: Ints, values: Singles) -> None:
        """Gives whole blocks that are not there yet one log-odds each, values (n,), clamped; keys: (n,)."""
        self._grow_blocks(self.block_count + len(keys))
        set_blocks(self._blocks, keys, np.clip(values, LOWEST, HIGHEST))

    def _grow_for_ray(self, needed: int) -> None:
        """Room for so many more blocks, of which a scan may touch as many; at least half as much again as there was."""
        self._grow_blocks(max(self.block_count + needed, self.block_count * 3 // 2))
        rows = len(self._marks.touched)
        touched = int(self._blocks.counts[TOUCHED])
        if touched + needed > rows:
            grown = _marks(len(self._blocks.keys), max(touched + needed, 2 * rows))
            grown.rows[: len(self._marks.rows)] = self._marks.rows
            for name in ("touched", "free", "hit"):
                getattr(grown, name)[:rows] = getattr(self._marks, name)
            self._marks = grown

    def _grow_blocks(self, count: int) -> None:
        """Room for so many blocks."""
        if count > len(self._blocks.keys):
            old = self._blocks
            n = self.block_count
            keys, slots, uniform = (_longer(a[:n], count) for a in (old.keys, old.slots, old.uniform))
            table = np.full(1 << int(2 * count - 1).bit_length(), -1, dtype=np.int32)
            self._blocks = old._replace(table=table, keys=keys, slots=slots, uniform=uniform)
            rehash(self._blocks)
            self._marks = self._marks._replace(rows=_longer(self._marks.rows, count))

    def _grow_rows(self, spare: int) -> None:
        """So many spare rows of cells."""
        blocks, have = self._blocks, int(self._blocks.counts[SPARE])
        if have < spare:
            rows = len(blocks.values)
            grown = max(rows + spare - have, rows * 5 // 4)
            blocks.values.resize((grown, CELLS), refcheck=False)  # in place: half of the memory need not be free for a copy
            blocks.spare.resize(grown, refcheck=False)
            blocks.spare[have : have + grown - rows] = np.arange(rows, grown)
            blocks.counts[SPARE] = have + grown - rows


def _longer(array: NDArray[np.generic], length: int) -> NDArray:  # type: ignore[type-arg]
    """A copy with room for ``length`` rows; what is new is not set."""
    grown = np.empty((length, *array.shape[1:]), dtype=array.dtype)
    grown[: len(array)] = array
    return grown


def _marks(blocks: int, rows: int) -> Marks:
    return Marks(
        np.zeros(blocks, dtype=np.int32),
        np.zeros(rows, dtype=np.int32),
        np.empty(rows, dtype=np.uint64),
        np.empty(rows, dtype=np.uint64),
    )
