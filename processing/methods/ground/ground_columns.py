"""What a search for ground says of every point, written into column files part by part."""

from __future__ import annotations

import os
from collections.abc import Sequence
from io import BufferedRandom
from pathlib import Path
from threading import Lock
from types import TracebackType
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import report_as_user_error
from processing.core.monitor import Monitor
from processing.methods.ground.drive_points import NOISE_CODES, Chunk, DrivePoints
from processing.recording.columns.columns import COLUMN_TYPES, column_path

CLASS, HEIGHT = "classification", "height_above_ground"
GROUND, OTHER = 2, 1
"""Classes: 2 as LAS 1.4 numbers them, 1 as everything that is not ground is written."""


class GroundColumns:
    """Classes and heights above ground of the points of several drives; may be filled by threads.

    Parameters
    ----------
    points : DrivePoints
    folders : sequence of Path
        One for each drive; they exist.
    monitor : Monitor
        All points are gone through once: they are no ground, noise keeps its code, heights are NaN.

    Raises
    ------
    NoSpace, Cancelled
    """

    def __init__(self, points: DrivePoints, folders: Sequence[Path], monitor: Monitor) -> None:
        self._lock = Lock()
        self._points = points
        self._files: list[dict[str, BufferedRandom]] = []
        try:
            for folder in folders:
                with report_as_user_error(folder):
                    opened = {n: column_path(folder, n).open("wb+") for n in (CLASS, HEIGHT)}
                self._files.append(opened)
            for chunk in points.chunks:
                monitor.check()
                classes = np.full(chunk.stop - chunk.start, OTHER, np.uint8)
                if chunk.has_noise:
                    codes = points.codes(chunk)
                    classes = np.where(np.isin(codes, NOISE_CODES), codes, classes)
                self._write(chunk, CLASS, classes)
                self._write(chunk, HEIGHT, np.full(classes.shape, np.nan, np.float32))
        except BaseException:
            self.close()
            raise

    def put(
        self,
        chunk: Chunk,
        own: NDArray[np.bool_],
        is_ground: NDArray[np.bool_],
        heights: NDArray[np.float64],
    ) -> None:
        """Note what was found of some points of a chunk.

        Parameters
        ----------
        own : (n,) bool
            Which points of the chunk are meant; noise among them keeps its class.
        is_ground : (n,) bool
        heights : (n,) float64
            Above ground, m; NaN where no ground is known.
        """
        with self._lock:
            classes = self._read(chunk, CLASS)
            can_be = own & is_ground
            if chunk.has_noise:
                can_be &= ~np.isin(classes, NOISE_CODES)
            classes[can_be] = GROUND
            self._write(chunk, CLASS, classes)
            above = self._read(chunk, HEIGHT)
            above[own] = heights[own]
            self._write(chunk, HEIGHT, above)

    def close(self) -> None:
        """Close the files; may be called again."""
        for opened in self._files:
            for file in opened.values():
                with report_as_user_error(Path(file.name)):
                    file.close()
        self._files.clear()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    # The type of a column's values is the column's own.
    def _read(self, chunk: Chunk, name: str) -> NDArray[Any]:
        file = self._files[chunk.drive][name]
        dtype = np.dtype(COLUMN_TYPES[name][0])
        values = np.empty(chunk.stop - chunk.start, dtype)
        with report_as_user_error(Path(file.name)):
            file.seek(chunk.start * dtype.itemsize)
            file.readinto(values.data)
        return values

    def _write(self, chunk: Chunk, name: str, values: NDArray[Any]) -> None:
        file = self._files[chunk.drive][name]
        with report_as_user_error(Path(file.name)):
            file.seek(chunk.start * values.itemsize, os.SEEK_SET)
            file.write(values.data)
            file.flush()
