"""A copy of a project to measure on: its points are linked, all that may change is copied."""

from __future__ import annotations

import shutil
from pathlib import Path

from processing.project.store.project_lock import LOCK_FILES

_CHANGING = "label.bin"
_COMPUTED = "tile_bounds_*.npy"


def link_project(folder: Path, copy: Path) -> None:
    """Make a project beside another one, which stays as it is.

    Columns are hard links where the disk allows it, otherwise symbolic ones; nothing writes into
    a column. Facts on tiles are left out, so that the copy is opened as if for the first time.

    Parameters
    ----------
    folder : Path
        The project.
    copy : Path
        Does not exist.
    """

    def ignored(_: str, names: list[str]) -> list[str]:
        return [name for name in names if name in LOCK_FILES or Path(name).match(_COMPUTED)]

    shutil.copytree(folder, copy, ignore=ignored, copy_function=_link_or_copy)


def _link_or_copy(source: str, target: str) -> None:
    path, new = Path(source).resolve(), Path(target)
    if path.suffix != ".bin" or path.name == _CHANGING:
        shutil.copy2(path, new)
        return
    try:
        new.hardlink_to(path)
    except OSError:  # another disk, or one that knows no hard links
        new.symlink_to(path)
