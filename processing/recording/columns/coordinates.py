"""Coordinates: the integers of a recording with what makes metres of them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.recording.columns.ordering import read_chunk


@dataclass(frozen=True)
class Coordinates:
    """Where the points of a recording are.

    Attributes
    ----------
    xyz : (n, 3) int32
        As delivered; metres = integers × scale + offset.
    folder : Path or None
        The drive's folder: what can be computed again is kept there, and long stretches are read
        from its files so that they don't stay in memory.
    """

    xyz: NDArray[np.int32]
    scale: tuple[float, float, float]
    offset: tuple[float, float, float]
    folder: Path | None = None

    def chunk(self, start: int, stop: int) -> NDArray[np.int32]:
        """Integers of the points ``start … stop − 1``: (k, 3) int32."""
        if self.folder is None:
            return np.ascontiguousarray(self.xyz[start:stop])
        integers: NDArray[np.int32] = read_chunk(self.folder, "xyz", start, stop)
        return integers
