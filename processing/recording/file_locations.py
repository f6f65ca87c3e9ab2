"""Where noted files are now: paths of this and of other machines, by text alone, without looking.

A drive notes the paths of its delivered files and camera images as they were on the machine that
imported it. When folders have moved since, a few :class:`FolderMove` say where to.
"""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path, PurePath, PurePosixPath, PureWindowsPath

_WINDOWS = re.compile(r"[A-Za-z]:[\\/]|\\\\")


@dataclass(frozen=True)
class FolderMove:
    """A folder whose files are in another one now.

    Attributes
    ----------
    noted : str
        As it was noted, in the writing of the machine that noted it.
    now : str
        On this machine.
    """

    noted: str
    now: str


def as_noted(path: str) -> PurePath:
    """A noted path with the separators of the system that noted it."""
    return PureWindowsPath(path) if _WINDOWS.match(path) else PurePosixPath(path)


def folder_of(path: str) -> str:
    """The folder of a noted file, as noted."""
    return _folder_and_name(path)[0]


def name_of(path: str) -> str:
    """The name of a noted file without its folder."""
    return _folder_and_name(path)[1]


def path_now(path: str, moves: Sequence[FolderMove]) -> Path:
    """Where a noted file is, if what is said of its folder is true.

    Parameters
    ----------
    path : str
        As noted.
    moves : sequence of FolderMove
        The first one for the file's own folder counts.
    """
    if moves:
        folder, name = _folder_and_name(path)
        for move in moves:
            if move.noted == folder:
                return Path(move.now) / name
    return Path(path)


def beside(folder: str, base: str, base_now: Path) -> Path | None:
    """Where a folder is if it went along when another one moved.

    Parameters
    ----------
    folder : str
        As noted.
    base, base_now : str, Path
        A folder as it was noted then, and where it is now.

    Returns
    -------
    Path or None
        None where the two had nothing in common, as on two drives of Windows.
    """
    noted, start = as_noted(folder), as_noted(base)
    if type(noted) is not type(start) or noted.anchor.lower() != start.anchor.lower():
        return None
    common = 1
    for one, other in zip(noted.parts[1:], start.parts[1:], strict=False):
        if one != other and not (_is_windows(noted) and one.lower() == other.lower()):
            break
        common += 1
    ups = len(start.parts) - common
    vehicle_path = [".."] * ups + list(noted.parts[common:])
    return Path(os.path.normpath(base_now.joinpath(*vehicle_path)))


def below(folder: str, chosen: Path) -> tuple[Path, ...]:
    """Where a noted folder may be below a chosen one: with its whole way first, without it last."""
    parts = as_noted(folder).parts[1:]
    return tuple(chosen.joinpath(*parts[first:]) for first in range(len(parts) + 1))


def _folder_and_name(path: str) -> tuple[str, str]:
    """By hand: a drive has tens of thousands of images, and paths as objects take their time."""
    cut = path.rfind("/")
    if _WINDOWS.match(path):
        cut = max(cut, path.rfind("\\"))
    folder = path[:cut]
    is_root = cut < 1 or folder.endswith(":")
    return path[: cut + 1] if is_root else folder, path[cut + 1 :]


def _is_windows(path: PurePath) -> bool:
    return isinstance(path, PureWindowsPath)
