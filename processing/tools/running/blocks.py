"""Blocks: a recording cut into stretches of rows, and their results joined as if never cut.

A block brings the rows beyond its own that the tool asked for. Values of single points are taken
from the block that owns the point; numbers of components are joined through the points that two
blocks share. Results go to column files as they come: nothing the size of the recording is held.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor, SilentMonitor
from processing.core.text import Text
from processing.image.neighbourhoods.component_column import ComponentColumn
from processing.recording.columns.columns import ColumnWriter
from processing.tools.tool import FinishedColumns, OutputColumn, PointResult

COMPONENT_COLUMNS = frozenset({"segment"})
"""Results that number the parts of a recording instead of saying something about one point."""

POINTS_PER_BLOCK = 1_000_000


@dataclass(frozen=True)
class RowBlock:
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
) -> Iterator[RowBlock]:
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
        yield RowBlock(range(first, end), range(max(0, first - aside), min(rows, end + aside)))
        first = end


class JoinedResults:
    """Results of blocks, in order, as column files of the whole recording.

    Parameters
    ----------
    outputs : tuple of OutputColumn
        What the tool gives.
    row_starts : (rows + 1,) int64
    folder : Path
        Where the columns are written; exists.
    """

    def __init__(
        self, outputs: tuple[OutputColumn, ...], row_starts: NDArray[np.int64], folder: Path
    ) -> None:
        self._row_starts = row_starts
        self._folder = folder
        self._outputs = outputs
        self._columns = ColumnWriter(folder)
        self._components = {
            output.name: ComponentColumn(folder, output.name)
            for output in outputs
            if output.name in COMPONENT_COLUMNS
        }

    def add(self, block: RowBlock, result: PointResult) -> None:
        """Take in the next block's result.

        Raises
        ------
        NoSpace
        """
        start, stop = (int(self._row_starts[row]) for row in _ends(block.rows))
        first, end = (int(self._row_starts[row]) for row in _ends(block.rows_with_overlap))
        for name, joined in self._components.items():
            joined.add(result.columns[name], first, end)
        self._append(
            {
                name: values[start - first : stop - first]
                for name, values in result.columns.items()
                if name not in self._components
            }
        )

    def finished(self, monitor: Monitor) -> FinishedColumns:
        """The columns of the whole recording.

        Raises
        ------
        NoSpace, Cancelled
        """
        if self._row_starts.size < 2:
            self._append(
                {
                    output.name: np.empty((0, output.width), output.dtype)
                    for output in self._outputs
                    if output.name not in self._components
                }
            )
        for joined in self._components.values():
            joined.finish(monitor)
        self.close()
        count = int(self._row_starts[-1]) if self._row_starts.size else 0
        return FinishedColumns(self._folder, tuple(one.name for one in self._outputs), count)

    def close(self) -> None:
        """Close the files; may be called again."""
        self._columns.close()
        for joined in self._components.values():
            joined.close()

    # The type of a column's values is the column's own.
    def _append(self, values: Mapping[str, NDArray[Any]]) -> None:
        if values:
            self._columns.append(values)


def warm_up() -> None:
    """Compile the kernels."""
    row_starts = np.arange(5, dtype=np.int64)
    outputs = (OutputColumn("segment", "int32", 1, Text("", "")),)
    with TemporaryDirectory() as folder:
        joined = JoinedResults(outputs, row_starts, Path(folder))
        # Two points that only the last block joins.
        for block, labels in zip(
            blocks_of(row_starts, 1, 1), ([0, 1], [0, 1, 2], [0, 1, 0], [0, 0]), strict=True
        ):
            joined.add(block, PointResult({"segment": np.array(labels, np.int32)}))
        joined.finished(SilentMonitor())


def _ends(rows: range) -> tuple[int, int]:
    return rows.start, rows.stop
