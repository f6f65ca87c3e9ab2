"""Writes through a compressor that hides why one failed (lazrs): the reason is kept and told."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import BinaryIO

import lazrs


class ReportedWrites:
    """A binary file as lazrs and laspy write to it; the last error of the system is kept.

    Parameters
    ----------
    file : BinaryIO
        Open for writing.
    """

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self.failure: OSError | None = None

    def write(self, data: bytes) -> int:
        """Write as the file does."""
        try:
            return self._file.write(data)
        except OSError as error:
            self.failure = error
            raise

    def flush(self) -> None:
        """Hand what is buffered to the system."""
        try:
            self._file.flush()
        except OSError as error:
            self.failure = error
            raise

    def seek(self, offset: int, whence: int = 0) -> int:
        """Go to another place."""
        try:
            return self._file.seek(offset, whence)
        except OSError as error:
            self.failure = error
            raise

    def tell(self) -> int:
        """Where the file stands."""
        return self._file.tell()

    def seekable(self) -> bool:
        """Whether it can go to another place."""
        return self._file.seekable()

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    @property
    def closed(self) -> bool:
        """Whether it is closed."""
        return self._file.closed


@contextmanager
def report_write_failures(file: ReportedWrites) -> Iterator[None]:
    """Raise what the system said in place of what the compressor made of it.

    Raises
    ------
    OSError
        A write of the body failed.
    """
    try:
        yield
    except lazrs.LazrsError as error:
        if file.failure is None:
            raise
        raise file.failure from error
