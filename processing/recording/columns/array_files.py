"""Arrays in numpy's files, read one at a time.

Python 3.11 counts the depth of what it parses for all threads together (python/cpython issue
106905): a file's header, read while another thread parses too, may end in a ``SystemError``.
"""

from __future__ import annotations

import struct
import tokenize
import zlib
from collections.abc import Callable
from pathlib import Path
from threading import Lock
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

# What the parsers of headers and archives raise beside what they are documented to raise.
_DAMAGE = (
    ArithmeticError,
    MemoryError,
    RuntimeError,
    SyntaxError,
    TypeError,
    struct.error,
    tokenize.TokenError,
    zlib.error,
)

_TRIES = 5
_reading = Lock()
_Found = TypeVar("_Found")


def read_array(path: Path) -> NDArray[Any]:
    """The array of a ``.npy`` file.

    Raises
    ------
    OSError, ValueError, EOFError
        The file is missing or damaged.
    """

    def read() -> NDArray[Any]:
        found: NDArray[Any] = np.load(path, allow_pickle=False)
        return found

    return _try_reading(read)


def map_array(path: Path) -> NDArray[Any]:
    """The array of a ``.npy`` file, read where it is looked at.

    Raises
    ------
    OSError, ValueError, EOFError
        The file is missing or damaged.
    """

    def read() -> NDArray[Any]:
        found: NDArray[Any] = np.load(path, mmap_mode="r", allow_pickle=False)
        return found

    return _try_reading(read)


def read_arrays(path: Path) -> dict[str, NDArray[Any]]:
    """The arrays of a ``.npz`` file, by name.

    Raises
    ------
    OSError, ValueError, EOFError, zipfile.BadZipFile
        The file is missing or damaged.
    """

    def read() -> dict[str, NDArray[Any]]:
        # Opened here, as numpy leaves a file open that is no whole archive.
        with path.open("rb") as file, np.load(file, allow_pickle=False) as kept:
            return {name: kept[name] for name in kept.files}

    return _try_reading(read)


def _try_reading(read: Callable[[], _Found]) -> _Found:
    with _reading:
        try:
            for _ in range(_TRIES - 1):
                try:
                    return read()
                except SystemError:  # other threads may parse too; the next time goes well
                    continue
            return read()
        except _DAMAGE as error:
            raise ValueError(str(error)) from error
