"""Coordinates: the one owner of where the points of a recording are.

Delivered integers become metres here and nowhere else. A correction moves points by whole steps of
the grid on which they were delivered. So integers and metres, kernels and tables, pictures and
exported files all tell the same place, and what works on integers works on corrected ones.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.errors import Unsuitable
from processing.core.kernels import kernel
from processing.core.text import Text
from processing.recording.columns.ordering import read_chunk
from processing.recording.columns.quantisation import Quantisation

PointSelection = NDArray[np.int64] | slice

_INT32 = np.iinfo(np.int32)
_NO_ORIGIN = np.zeros(3)


class ColumnSource(Protocol):
    """Gives the columns ``xyz``, (n, 3) int32 as delivered, and ``time`` where one corrects."""

    # The type of a column's values is the column's own.
    def __getitem__(self, name: str, /) -> NDArray[Any]:
        """A whole column."""


class Correction(Protocol):
    """How far points lie from where they were delivered, by when they were measured."""

    @property
    def key(self) -> str:
        """Another one for any other correction; fit for a file's name, not empty."""

    @property
    def reach_m(self) -> float:
        """No coordinate changes by more."""

    def shifts(self, time: Floats, xyz: Floats) -> Floats:
        """What to add: (n, 3) m.

        Parameters
        ----------
        time : (n,) float64
            s, as the drive has it.
        xyz : (n, 3) float64
            As delivered, m, project CRS.
        """


@dataclass(frozen=True, eq=False)
class StretchedIntegers:
    """Integers of stretches of a recording, for kernels that go through them.

    Attributes
    ----------
    integers : (m, 3) int32
        Read only.
    stretches : (k, 2) int64
        First and end lines in ``integers`` of each stretch.
    """

    integers: NDArray[np.int32]
    stretches: Integers
    _firsts: Integers | None = None

    def points(self, lines: Integers) -> Integers:
        """The points of the recording that lines of ``integers`` are."""
        if self._firsts is None:
            return lines
        of = np.searchsorted(self.stretches[:, 0], lines, side="right") - 1
        return np.asarray(lines - self.stretches[of, 0] + self._firsts[of])


@dataclass(frozen=True, eq=False)
class Coordinates:
    """Where the points of a recording are.

    Attributes
    ----------
    columns : ColumnSource
        What was delivered.
    quantisation : Quantisation
        Of the delivered integers and of the corrected ones.
    folder : Path or None
        The drive's folder: what can be computed again is kept there, and long stretches are read
        from its files so that they don't stay in memory.
    correction : Correction or None
        Moves the points.
    """

    columns: ColumnSource
    quantisation: Quantisation
    folder: Path | None = None
    correction: Correction | None = None

    @property
    def key(self) -> str:
        """What tells these places from others of the same recording; empty for the delivered."""
        return "" if self.correction is None else self.correction.key

    @property
    def delivered(self) -> NDArray[np.int32]:
        """(n, 3) int32 as delivered, mapped.

        Only for steps between points that were measured in the same moment, as a correction moves
        them alike.
        """
        integers: NDArray[np.int32] = self.columns["xyz"]
        return integers

    def integers(self, points: PointSelection) -> NDArray[np.int32]:
        """Integers of points: (n, 3) int32."""
        delivered: NDArray[np.int32] = self.columns["xyz"][points]
        if self.correction is None:
            return delivered
        moved = self._correct_points(delivered, self.columns["time"][points])
        # Kernels are compiled for mapped columns, which are read-only.
        moved.flags.writeable = False
        return moved

    def xyz(self, points: PointSelection) -> Floats:
        """Coordinates of points: (n, 3) float64, m, project CRS, a copy."""
        return self._metres(self.integers(points))

    def about(self, points: PointSelection, origin: Floats) -> Floats:
        """Metres about an origin of points: (n, 3) float64, a copy; mapped, for few of them."""
        return self._metres(self.integers(points), origin)

    def local_xyz(self, points: PointSelection, origin: Floats) -> NDArray[np.float32]:
        """Coordinates about a local origin, exact enough for drawing: (n, 3) float32.

        Parameters
        ----------
        origin : (3,) float64
            m, project CRS; subtracted before rounding to float32.
        """
        return self.about(points, origin).astype(np.float32)

    def chunk(self, start: int, stop: int) -> NDArray[np.int32]:
        """Integers of the points ``start … stop − 1``: (k, 3) int32, read into memory."""
        delivered: NDArray[np.int32] = self._read("xyz", start, stop)
        if self.correction is None:
            return delivered
        return self._correct_points(delivered, self._read("time", start, stop))

    def chunk_xyz(self, start: int, stop: int) -> Floats:
        """As :meth:`xyz` of the points ``start … stop − 1``, read into memory."""
        return self._metres(self.chunk(start, stop))

    def chunk_about(self, start: int, stop: int, origin: Floats) -> Floats:
        """Metres about an origin of the points ``start … stop − 1``: (k, 3) float64."""
        return self._metres(self.chunk(start, stop), origin)

    def stretched(self, stretches: Integers) -> StretchedIntegers:
        """Integers of stretches that follow each other; nothing is copied where none is moved.

        Parameters
        ----------
        stretches : (k, 2) int64
            The points ``stretches[i, 0] … stretches[i, 1] − 1``.
        """
        if self.correction is None:
            return StretchedIntegers(np.asarray(self.delivered), stretches)
        sizes = np.maximum(0, stretches[:, 1] - stretches[:, 0])
        ends = np.cumsum(sizes)
        integers = np.empty((int(sizes.sum()), 3), np.int32)
        for (first, _), size, end in zip(
            stretches.tolist(), sizes.tolist(), ends.tolist(), strict=True
        ):
            integers[end - size : end] = self.integers(slice(first, first + size))
        # Kernels are compiled for mapped columns, which are read-only.
        integers.flags.writeable = False
        return StretchedIntegers(integers, np.column_stack([ends - sizes, ends]), stretches[:, 0])

    def moved_m(self, start: int, stop: int) -> Floats:
        """How far the points ``start … stop − 1`` lie from where they were delivered: (k, 3) m."""
        delivered = self._read("xyz", start, stop)
        steps = self.chunk(start, stop).astype(np.int64) - delivered
        return np.asarray(steps * np.array(self.quantisation.scale))

    def _metres(self, integers: NDArray[np.int32], origin: Floats = _NO_ORIGIN) -> Floats:
        # NumPy takes ten times as long over rows of three.
        flat = np.ascontiguousarray(integers, np.int32).reshape(-1, 3)
        flat.flags.writeable = False
        metres = np.empty(flat.shape)
        metres_kernel(flat, *self.quantisation.about(origin), metres)
        return metres.reshape(integers.shape)

    # The type of a column's values is the column's own.
    def _read(self, name: str, start: int, stop: int) -> NDArray[Any]:
        if self.folder is None:
            return np.ascontiguousarray(self.columns[name][start:stop])
        return read_chunk(self.folder, name, start, stop)

    def _correct_points(self, delivered: NDArray[np.int32], time: Floats) -> NDArray[np.int32]:
        if self.correction is None or not delivered.size:
            return delivered
        flat = delivered.reshape(-1, 3)
        shifts = self.correction.shifts(time.reshape(-1), self._metres(flat))
        moved = flat + self.quantisation.steps(shifts)
        if not ((moved >= _INT32.min) & (moved <= _INT32.max)).all():
            raise Unsuitable(
                Text(
                    "A correction moves points to where the drive can't hold them.",
                    "補正後の点が走行データの座標範囲に収まりません。",
                ),
                Text.same(str(self.folder or self.key)),
                Text(
                    "Take the correction back, or register the drives again.",
                    "補正を取り消すか、走行データの位置合わせをやり直してください。",
                ),
            )
        return moved.astype(np.int32).reshape(delivered.shape)


@kernel
def metres_kernel(
    integers: NDArray[np.int32], scale: Floats, shift: Floats, metres: Floats
) -> None:
    """Write integers × scale + shift, (n, 3) each, as :class:`Quantisation` tells them."""
    for point in range(len(integers)):
        for axis in range(3):
            metres[point, axis] = integers[point, axis] * scale[axis] + shift[axis]
