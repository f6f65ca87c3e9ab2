"""Blocks: a recording cut into stretches of rows, and their results joined as if never cut.

A block brings the rows beyond its own that the tool asked for. Values of single points are taken
from the block that owns the point; numbers of components are joined through the points that two
blocks share, then numbered anew.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.image.segment_kernels import renumber_kernel, roots_kernel, unite_kernel
from processing.tools.tool import OutputColumn, PointResult, Tool

COMPONENT_COLUMNS = frozenset({"segment"})
"""Results that number the parts of a recording instead of saying something about one point."""

POINTS_PER_BLOCK = 1_000_000


@dataclass(frozen=True)
class Block:
    """A stretch of rows.

    Attributes
    ----------
    rows : range
        Its own rows.
    rows_with_overlap : range
        With the rows beyond that the tool looks at.
    """

    rows: range
    rows_with_overlap: range


def blocks_of(
    row_starts: NDArray[np.int64], overlap_rows: int, points_per_block: int = POINTS_PER_BLOCK
) -> Iterator[Block]:
    """Blocks that own every row once.

    Parameters
    ----------
    row_starts : (rows + 1,) int64
    overlap_rows : int
        On either side; −1 gives one block with everything.
    points_per_block : int
        About how many points a block owns; at least as many rows as the overlap has.
    """
    rows = row_starts.size - 1
    first = 0
    while first < rows:
        end = rows
        if overlap_rows >= 0:
            wanted = np.searchsorted(row_starts, row_starts[first] + points_per_block, "right") - 1
            end = min(rows, max(first + 1, first + overlap_rows, int(wanted)))
        aside = max(overlap_rows, 0)
        yield Block(range(first, end), range(max(0, first - aside), min(rows, end + aside)))
        first = end


class JoinedResults:
    """Results of blocks, in order, as columns of the whole recording.

    Parameters
    ----------
    outputs : tuple of OutputColumn
        What the tool gives.
    row_starts : (rows + 1,) int64
    """

    def __init__(self, outputs: tuple[OutputColumn, ...], row_starts: NDArray[np.int64]) -> None:
        self._row_starts = row_starts
        count = int(row_starts[-1]) if row_starts.size else 0
        self._columns: dict[str, NDArray[Any]] = {
            output.name: np.zeros(
                (count,) if output.width == 1 else (count, output.width), output.dtype
            )
            for output in outputs
        }
        self._components = {
            output.name: _JoinedComponents(count)
            for output in outputs
            if output.name in COMPONENT_COLUMNS
        }

    def add(self, block: Block, result: PointResult) -> None:
        """Take in the next block's result."""
        start, stop = (int(self._row_starts[row]) for row in _ends(block.rows))
        first, end = (int(self._row_starts[row]) for row in _ends(block.rows_with_overlap))
        for name, column in self._columns.items():
            if name in self._components:
                self._components[name].add(result.columns[name], first, end)
            else:
                column[start:stop] = result.columns[name][start - first : stop - first]

    def finished(self) -> PointResult:
        """The columns of the whole recording."""
        whole = {name: joined.finished() for name, joined in self._components.items()}
        return PointResult({**self._columns, **whole})


class _JoinedComponents:
    """Components of blocks, united where they share points.

    Every component of every block gets a number of its own; ``roots`` say which are the same.
    """

    def __init__(self, count: int) -> None:
        self._numbers = np.zeros(count, np.int32)
        self._known_end = 0
        self._used = 0
        self._pairs: list[NDArray[np.int64]] = []

    def add(self, labels: NDArray[np.int32], first: int, end: int) -> None:
        """Take in the labels of the points ``first … end − 1``."""
        numbers = labels.astype(np.int64) + self._used
        self._used += int(labels.max(initial=-1)) + 1
        known = max(0, min(self._known_end, end) - first)
        if known:
            seam = np.stack([self._numbers[first : first + known], numbers[:known]])
            self._pairs.append(np.unique(seam, axis=1).astype(np.int64))
        self._numbers[first + known : end] = numbers[known:]
        self._known_end = max(self._known_end, end)

    def finished(self) -> NDArray[np.int32]:
        """(n,) int32: components numbered by their first points."""
        parents = np.arange(self._used, dtype=np.int64)
        for pair in self._pairs:
            unite_kernel(parents, np.ascontiguousarray(pair[0]), np.ascontiguousarray(pair[1]))
        roots_kernel(parents)
        order = np.full(self._used, -1, np.int32)
        renumber_kernel(self._numbers, parents, order)
        return self._numbers


def results_of(tool: Tool, row_starts: NDArray[np.int64]) -> JoinedResults:
    """Where a tool's results are gathered."""
    return JoinedResults(tool.outputs, row_starts)


def warm_up() -> None:
    """Compile the kernels."""
    joined = _JoinedComponents(2)
    joined.add(np.zeros(2, np.int32), 0, 2)
    joined.add(np.zeros(1, np.int32), 1, 2)
    joined.finished()


def _ends(rows: range) -> tuple[int, int]:
    return rows.start, rows.stop
