"""Arrays in files for the time of a run: room is taken at once; a full disk is met early."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import DTypeLike, NDArray

from processing.core.errors import report_as_user_error

_BLOCK = 1 << 24
"""Bytes written at a time, so that a full disk is met before the work begins: 16 MiB."""


# The type of the values is the caller's.
def scratch_array(file: Path, dtype: DTypeLike, count: int) -> NDArray[Any]:
    """A mapped array of zeros, (count,), that lives as long as its file.

    Raises
    ------
    NoSpace
        The disk can't hold it.
    """
    if count == 0:
        return np.zeros(0, dtype)
    with report_as_user_error(file):
        with file.open("wb") as made:
            _take_room(made, count * np.dtype(dtype).itemsize)
        return np.memmap(file, dtype, "r+", shape=(count,))


def nameless_array(folder: Path, dtype: DTypeLike, shape: tuple[int, ...]) -> NDArray[Any]:
    """The same in a file without a name, which is gone with the array, or with a killed process.

    Parameters
    ----------
    folder : Path
        On whose disk there is room for it.

    Raises
    ------
    NoSpace
        The disk can't hold it.
    """
    size = int(np.prod(shape, dtype=np.int64)) * np.dtype(dtype).itemsize
    if size == 0:
        return np.zeros(shape, dtype)
    with report_as_user_error(folder), tempfile.TemporaryFile(dir=folder) as made:
        _take_room(made, size)
        # A plain array: each little part of a memmap costs as much as work on it.
        return np.asarray(np.memmap(made, dtype, "r+", shape=shape))


def _take_room(made: BinaryIO, size: int) -> None:
    if hasattr(os, "posix_fallocate"):
        os.posix_fallocate(made.fileno(), 0, size)
    else:
        for start in range(0, size, _BLOCK):
            made.write(bytes(min(_BLOCK, size - start)))
        made.flush()
