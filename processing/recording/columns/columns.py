"""Columns: the points of one recording as memory-mapped arrays in acquisition order.

A column is a raw little-endian file, one value or vector per point; LAS integers stay integers.
"""

from __future__ import annotations

import mmap
import threading
import weakref
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, BinaryIO, Self

import numpy as np
from numpy.typing import NDArray

from processing.core.block_sums import (
    CHECK_REMEDY,
    forget_sums,
    keep_sums,
    place_with_sums,
    record_of,
    refuse_damaged,
)
from processing.core.errors import BadFile, UserError, report_as_user_error
from processing.core.owned_files import new_file
from processing.core.text import Text
from processing.recording.columns.mapped_pages import MappedPages
from processing.recording.columns.point_features import POINT_FEATURES

COLUMN_TYPES: Mapping[str, tuple[str, int]] = {
    "xyz": ("<i4", 3),
    "time": ("<f8", 1),
    "intensity": ("<u2", 1),
    "return_number": ("u1", 1),
    "number_of_returns": ("u1", 1),
    "classification": ("u1", 1),
    "source_index": ("<i8", 1),
    "source_file": ("<u2", 1),
    "pulse": ("<i8", 1),
    "color": ("<u2", 3),
    "scan_angle_deg": ("<f4", 1),
    "origin": ("<f8", 3),
    "grid": ("<i4", 2),
    "place_before": ("<i8", 1),
    "wave_packet": ("<i8", 1),
    "wave_descriptor": ("u1", 1),
    "wave_location": ("<f4", 1),
    "wave_direction": ("<f4", 3),
    "normal": ("i1", 3),
    "shape": ("u1", 3),
    "segment": ("<i4", 1),
    "seen_color": ("u1", 3),
    "is_seen": ("u1", 1),
    "label": ("u1", 1),
    "truth": ("u1", 1),
    "judged": ("u1", 1),
    "height_above_ground": ("<f4", 1),
    "confidence": ("<f4", 1),
    **dict.fromkeys(POINT_FEATURES, ("<f4", 1)),
}
"""Column name to dtype and values per point."""

_CHECKED_AT_ONCE = 1 << 26
"""Bytes whose checksums are compared before a column is handed out: 30 ms, no wait for a hand."""

_one_column_at_a_time = threading.Lock()


def column_path(folder: Path, name: str) -> Path:
    """Where a column of a drive folder lies."""
    return folder / f"{name}.bin"


def wrong_length(path: Path) -> BadFile:
    """The error for a column that is not as long as its drive has points."""
    size = path.stat().st_size if path.is_file() else 0
    return BadFile(
        Text(
            "A column of the drive is not as long as the drive has points.",
            "走行データの列データの長さが点数と一致しません。",
        ),
        Text.same(f"{path}, byte {size}"),
        CHECK_REMEDY,
    )


class ColumnWriter:
    """Appends points to the columns of a drive folder that is being made.

    Parameters
    ----------
    folder : Path
        Exists, belongs to this writer alone.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._files: dict[str, BinaryIO] = {}
        self._count = 0

    @property
    def count(self) -> int:
        """Points appended so far."""
        return self._count

    def append(self, columns: Mapping[str, NDArray[Any]]) -> None:
        """Append the same number of points to each column.

        Parameters
        ----------
        columns : mapping of str to array
            Name to (n,) or (n, k); every call names the same columns.

        Raises
        ------
        NoSpace
            The disk is full or refuses the write.
        """
        with report_as_user_error(self._folder):
            for name, values in columns.items():
                if name not in self._files:
                    self._files[name] = column_path(self._folder, name).open("wb")
                dtype, _ = COLUMN_TYPES[name]
                self._files[name].write(np.ascontiguousarray(values, dtype=dtype).data)
        self._count += next(iter(columns.values())).shape[0]

    def close(self) -> None:
        """Close the files; may be called again."""
        with report_as_user_error(self._folder):
            for file in self._files.values():
                file.close()
        self._files.clear()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


class Columns:
    """The columns of a drive folder, read only, mapped when first asked for; thread-safe.

    Parameters
    ----------
    folder : Path
    count : int
        Number of points.
    pages : MappedPages, optional
        Bounds what maps hold of the memory, those of several drives together.
    """

    def __init__(self, folder: Path, count: int, pages: MappedPages | None = None) -> None:
        self._pages = pages or MappedPages()
        self._folder = folder
        self._count = count
        self._maps: dict[str, NDArray[Any]] = {}
        self._files: dict[str, mmap.mmap] = {}
        self._held: dict[str, NDArray[Any]] = {}
        self._damage: dict[str, UserError] = {}
        self._opening = threading.Lock()

    @property
    def count(self) -> int:
        """Number of points."""
        return self._count

    @property
    def folder(self) -> Path:
        """Where the columns lie."""
        return self._folder

    def has(self, name: str) -> bool:
        """Whether the recording has this column."""
        return name in self._maps or column_path(self._folder, name).is_file()

    def __getitem__(self, name: str) -> NDArray[Any]:
        """A whole column: (n,) or (n, k), mapped, not to be written.

        Its checksums are compared when it is first asked for; those of a large one beside what is
        done with it, so that damage may be refused only when it is asked for again.

        Raises
        ------
        BadFile
            The file is not as long as the drive has points, or is damaged.
        MissingInput
            There is no such column.
        """
        self._pages.look()
        known = self._maps.get(name)
        if known is not None:
            return known
        with self._opening:
            if name not in self._maps:
                self._maps[name] = self._map_column(name)
            return self._maps[name]

    def expect(self, name: str, starts: NDArray[np.int64], stops: NDArray[np.int64]) -> None:
        """Tell the system which points of a column are read next, so that the disk begins now.

        Parameters
        ----------
        starts, stops : (k,) int64
            The points ``starts[i] … stops[i] − 1``.
        """
        values = self[name]
        mapped = self._files.get(name)
        if mapped is None or not hasattr(mmap, "MADV_WILLNEED"):
            return
        item = values.itemsize * (values.size // self._count)
        begins = starts * item // mmap.PAGESIZE * mmap.PAGESIZE
        lengths = stops * item - begins
        # Advice that isn't taken does no harm: the points are read when they are asked for.
        with suppress(OSError):
            for begin, length in zip(begins.tolist(), lengths.tolist(), strict=True):
                if length > 0:
                    mapped.madvise(mmap.MADV_WILLNEED, begin, length)

    def add(self, name: str, values: NDArray[Any]) -> None:
        """Store a column that a tool or a hand made; replaces an older one, whole or not at all.

        Raises
        ------
        NoSpace
            The disk is full or refuses the write; the older column stays.
        """
        dtype, width = COLUMN_TYPES[name]
        shape = (self._count,) if width == 1 else (self._count, width)
        if values.shape != shape:
            message = f"column {name}: {values.shape} where {shape} belongs"
            raise ValueError(message)
        path = column_path(self._folder, name)
        temporary = path.with_suffix(".part")
        with report_as_user_error(path):
            try:
                with new_file(temporary) as part:
                    part.write(np.ascontiguousarray(values, dtype=dtype).data)
                keep_sums(temporary)
                with self.replacing(name):
                    place_with_sums(temporary, path)
            finally:
                temporary.unlink(missing_ok=True)
                forget_sums(temporary)

    def take_over(self, name: str, file: Path) -> None:
        """Let a finished file be a column, by a rename; replaces an older one.

        Parameters
        ----------
        file : Path
            A value for each point, as `COLUMN_TYPES` says, on the folder's own disk.

        Raises
        ------
        MissingInput, InUse
            The file is gone, or a program holds the older column; that one stays.
        """
        dtype, width = COLUMN_TYPES[name]
        path = column_path(self._folder, name)
        with report_as_user_error(path):
            if file.stat().st_size != self._count * width * np.dtype(dtype).itemsize:
                message = f"column {name}: a file for other points than {self._count}"
                raise ValueError(message)
            with self.replacing(name):
                place_with_sums(file, path)

    def hold(self, name: str, values: NDArray[Any]) -> None:
        """Let a column be these values, in memory only: (n,) or (n, k), not to be changed."""
        self._maps[name] = self._held[name] = values

    def held(self, name: str) -> NDArray[Any] | None:
        """The values that :meth:`hold` keeps in place of the file's, or None."""
        return self._held.get(name)

    def give_back(self) -> None:
        """Let maps hold no more memory than they should; for long work, between its stretches."""
        self._pages.look()

    @contextmanager
    def replacing(self, name: str) -> Iterator[None]:
        """While the file of a column gives way to another one: its map is forgotten.

        Nobody maps a column meanwhile: a thread that did so just before the new file is in place
        would go on reading the old one. Arrays already handed out stay valid.
        """
        with self._opening:
            self._maps.pop(name, None)
            self._files.pop(name, None)
            self._damage.pop(name, None)
            yield

    def refuse(self, name: str, error: UserError) -> None:
        """Let a column be refused from now on: it was found to be damaged."""
        with self._opening:
            self._damage[name] = error
            self._maps.pop(name, None)
            self._files.pop(name, None)

    def _map_column(self, name: str) -> NDArray[Any]:
        dtype, width = COLUMN_TYPES[name]
        shape = (self._count,) if width == 1 else (self._count, width)
        path = column_path(self._folder, name)
        if name in self._damage:
            raise self._damage[name]
        with report_as_user_error(path):
            size = path.stat().st_size
            if size != self._count * width * np.dtype(dtype).itemsize:
                raise wrong_length(path)
            if self._count == 0:
                return np.empty(shape, dtype=dtype)
            self._check_sums(name, path, size)
            with path.open("rb") as file:
                mapped = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
            self._pages.add(mapped)
            self._files[name] = mapped
            return np.frombuffer(mapped, dtype=dtype).reshape(shape)

    def _check_sums(self, name: str, path: Path, size: int) -> None:
        if size <= _CHECKED_AT_ONCE:
            refuse_damaged(path)
        elif record_of(path).exists():
            threading.Thread(
                target=_check_beside,
                args=(weakref.ref(self), name, path, size),
                name=f"checksums of {name}",
                daemon=True,
            ).start()


def _check_beside(columns: weakref.ref[Columns], name: str, path: Path, size: int) -> None:
    """Compare the checksums of a large column while it is used; ends when nobody has it open."""
    for start in range(0, size, _CHECKED_AT_ONCE):
        with _one_column_at_a_time:
            if columns() is None:
                return
            try:
                refuse_damaged(path, start, start + _CHECKED_AT_ONCE)
            except BadFile as error:
                still = columns()
                if still is not None:
                    still.refuse(name, error)
                return
            except UserError:
                return  # it went meanwhile: whoever reads it is told
