"""TileFiles: the facts on tiles in a drive's folder, whole or as far as they were worked out."""

from __future__ import annotations

import threading
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

import numpy as np

from processing.core.arrays import Flags, Floats
from processing.core.owned_files import new_file
from processing.image.tiles.tile_kernels import COUNT, HIGHEST, LOWEST
from processing.recording.columns.array_files import read_array, read_arrays
from processing.recording.kinds import ImageKind


class TileFiles:
    """Two files that may be lost, damaged or unwritable: what they hold can be made again.

    Parameters
    ----------
    folder : Path or None
        The drive's; None: nothing is kept.
    kind : ImageKind
    shape : tuple of int
        Of the whole table.
    key : str
        What tells the coordinates from others of the recording.
    """

    def __init__(
        self, folder: Path | None, kind: ImageKind, shape: tuple[int, int], key: str = ""
    ) -> None:
        self._shape = shape
        name = f"tile_bounds_{kind.value}" + (f"_{key}" if key else "")
        self._whole = None if folder is None else folder / f"{name}.npy"
        self._begun = None if folder is None else folder / f"{name}.begun.npz"

    def whole(self) -> Floats | None:
        """The table; None where there is none of this shape."""
        if self._whole is None:
            return None
        try:
            table: Floats = read_array(self._whole)
        except (OSError, ValueError, EOFError):
            return None
        is_table = table.shape == self._shape and table.dtype == np.float64
        return table if is_table and _are_facts(table) else None

    def begun(self, sums: tuple[int, int], rows: tuple[int, ...]) -> tuple[Floats, Flags] | None:
        """Sums and which rows of tiles they hold; None where none of these shapes were kept."""
        if self._begun is None:
            return None
        try:
            kept = read_arrays(self._begun)
            found: tuple[Floats, Flags] = kept["sums"], kept["done"]
        except (OSError, ValueError, EOFError, KeyError, zipfile.BadZipFile):
            return None
        is_such = found[0].shape == sums and found[1].shape == rows
        is_such &= found[0].dtype == np.float64 and found[1].dtype == np.bool_
        return found if is_such and _are_facts(found[0]) else None

    def keep_whole(self, table: Floats) -> None:
        """Write the table, which makes what was begun useless."""
        if self._whole is not None and self._begun is not None:
            _write(self._whole, lambda file: np.save(file, table))
            self._begun.unlink(missing_ok=True)

    def keep_begun(self, sums: Floats, done: Flags) -> None:
        """Write what was worked out so far."""
        if self._begun is not None:
            _write(self._begun, lambda file: np.savez(file, sums=sums, done=done))


def _are_facts(table: Floats) -> bool:
    """Whether places are known or there are none, and counts and distances are numbers."""
    low, high, rest = table[:, LOWEST], table[:, HIGHEST], table[:, COUNT:]
    is_empty = (low == np.inf).all(axis=1) & (high == -np.inf).all(axis=1)
    is_box = np.isfinite(low).all(axis=1) & np.isfinite(high).all(axis=1)
    are_boxes = is_box & (low <= high).all(axis=1) | is_empty
    return bool(are_boxes.all() and ((rest >= 0) & (rest < np.inf)).all())


def _write(path: Path, write: Callable[[BinaryIO], None]) -> None:
    temporary = path.with_suffix(f".{threading.get_ident()}.part")
    try:
        with new_file(temporary) as file:
            write(file)
        temporary.replace(path)
    except OSError:
        # A read-only or full disk: it is made again next time.
        temporary.unlink(missing_ok=True)
