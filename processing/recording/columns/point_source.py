"""Points of one recording by stretches: arrays in memory, or the raw columns of a drive folder."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from processing.recording.columns.columns import column_path
from processing.recording.columns.ordering import read_chunk
from processing.recording.columns.quantisation import Quantisation

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class PointColumns:
    """What revolutions and pulses are found from: one scanner's points in acquisition order.

    Attributes
    ----------
    xyz : (n, 3) int32
        Delivered integers; metres = integers × scale + offset.
    time : (n,) float64
        s, not decreasing; the clock of the trajectory if there is one.
    return_number, number_of_returns : (n,) uint8
        1-based; 0 where the format has none.
    origin : (n, 3) float64, optional
        Where the scanner was, m, same frame as the points.
    scan_angle_deg : (n,) float32, optional
        Mirror angle as delivered.
    """

    xyz: NDArray[np.int32]
    scale: Triple
    offset: Triple
    time: NDArray[np.float64]
    return_number: NDArray[np.uint8]
    number_of_returns: NDArray[np.uint8]
    origin: NDArray[np.float64] | None = None
    scan_angle_deg: NDArray[np.float32] | None = None

    @property
    def quantisation(self) -> Quantisation:
        """What makes metres of the integers."""
        return Quantisation(self.scale, self.offset)

    @property
    def count(self) -> int:
        """Number of points."""
        return int(self.time.shape[0])

    @property
    def has_origins(self) -> bool:
        """Whether every point says where the scanner was."""
        return self.origin is not None

    @property
    def has_scan_angles(self) -> bool:
        """Whether every point says how the mirror stood."""
        return self.scan_angle_deg is not None

    def chunk(self, start: int, stop: int) -> PointColumns:
        """The points ``start … stop − 1``: views."""
        part = slice(start, stop)
        return replace(
            self,
            xyz=self.xyz[part],
            time=self.time[part],
            return_number=self.return_number[part],
            number_of_returns=self.number_of_returns[part],
            origin=None if self.origin is None else self.origin[part],
            scan_angle_deg=None if self.scan_angle_deg is None else self.scan_angle_deg[part],
        )


@dataclass(frozen=True)
class RecordedPoints:
    """The columns of a drive folder that is being made, read chunk by chunk.

    Attributes
    ----------
    folder : Path
        Has the columns ``xyz``, ``time``, ``return_number``, ``number_of_returns`` and may have
        ``origin`` and ``scan_angle_deg``, each of ``count`` points.
    """

    folder: Path
    count: int
    scale: Triple
    offset: Triple

    @property
    def has_origins(self) -> bool:
        """Whether every point says where the scanner was."""
        return column_path(self.folder, "origin").is_file()

    @property
    def has_scan_angles(self) -> bool:
        """Whether every point says how the mirror stood."""
        return column_path(self.folder, "scan_angle_deg").is_file()

    def chunk(self, start: int, stop: int) -> PointColumns:
        """The points ``start … stop − 1``, read into memory.

        Raises
        ------
        UserError
            A column can't be read.
        """

        def read(name: str) -> NDArray[np.generic]:
            values: NDArray[np.generic] = read_chunk(self.folder, name, start, stop)
            return values

        return PointColumns(
            xyz=read("xyz").astype(np.int32, copy=False),
            scale=self.scale,
            offset=self.offset,
            time=read("time").astype(np.float64, copy=False),
            return_number=read("return_number").astype(np.uint8, copy=False),
            number_of_returns=read("number_of_returns").astype(np.uint8, copy=False),
            origin=read("origin").astype(np.float64, copy=False) if self.has_origins else None,
            scan_angle_deg=read("scan_angle_deg").astype(np.float32, copy=False)
            if self.has_scan_angles
            else None,
        )


class PointSource(Protocol):
    """What `PointColumns` and `RecordedPoints` have in common."""

    @property
    def count(self) -> int:
        """Number of points."""

    @property
    def has_origins(self) -> bool:
        """Whether every point says where the scanner was."""

    @property
    def has_scan_angles(self) -> bool:
        """Whether every point says how the mirror stood."""

    def chunk(self, start: int, stop: int) -> PointColumns:
        """The points ``start … stop − 1``."""


def samples_of(points: PointSource, number: int, size: int) -> Iterator[PointColumns]:
    """Contiguous stretches, spread evenly over a recording; all of it when it is short."""
    if points.count <= number * size:
        yield points.chunk(0, points.count)
        return
    for start in np.linspace(0, points.count - size, number).astype(np.int64):
        yield points.chunk(int(start), int(start) + size)
