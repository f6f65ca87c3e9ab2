"""OffsetColumnWriter: points written to their place in columns, by several processes if need be."""

from __future__ import annotations

import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import report_as_user_error
from processing.recording.columns.columns import COLUMN_TYPES, column_path


class OffsetColumnWriter:
    """Writes points to columns of a drive folder that is being made; what is there may be replaced.

    Parameters
    ----------
    folder : Path
        Exists.
    first : int
        The place that :meth:`write` counts from.
    """

    def __init__(self, folder: Path, first: int = 0) -> None:
        self._folder = folder
        self._first = first
        self._files: dict[str, int] = {}

    def write(self, at: int, columns: Mapping[str, NDArray[Any]]) -> None:
        """Write points from a place on.

        Parameters
        ----------
        at : int
            Points between ``first`` and the first of these.
        columns : mapping of str to array
            Name to (n,) or (n, k).

        Raises
        ------
        NoSpace
            The disk is full or refuses the write.
        """
        for name, values in columns.items():
            dtype, width = COLUMN_TYPES[name]
            item = np.dtype(dtype).itemsize * width
            path = column_path(self._folder, name)
            with report_as_user_error(path):
                if name not in self._files:
                    binary = getattr(os, "O_BINARY", 0)
                    self._files[name] = os.open(path, os.O_RDWR | os.O_CREAT | binary, 0o666)
                data = np.ascontiguousarray(values, dtype=dtype).reshape(-1).view(np.uint8)
                _write_at(self._files[name], (self._first + at) * item, data)

    def close(self) -> None:
        """Close the files; may be called again."""
        for number in self._files.values():
            with suppress(OSError):
                os.close(number)
        self._files.clear()


def _write_at(number: int, position: int, data: NDArray[np.uint8]) -> None:
    os.lseek(number, position, os.SEEK_SET)
    left = memoryview(data.data)
    while left:
        left = left[os.write(number, left) :]
