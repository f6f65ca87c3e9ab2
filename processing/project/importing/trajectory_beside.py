"""Trajectories that lie beside point files and were not chosen with them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import UserError, report_as_user_error
from processing.formats.format import Content
from processing.formats.points.point_files import read_info, read_sample
from processing.formats.registry import FORMATS
from processing.project.importing.dropped_files import content_of
from processing.project.importing.trajectory_choice import match_trajectory, read_trajectories

_FOLDER = re.compile(r"traj|sbet|pos|nav|gnss|軌跡", re.IGNORECASE)
_SAMPLE_POINTS = 2_000
_MOST_FILES = 50


def trajectories_beside(inputs: Sequence[Path], crs: str) -> tuple[Path, ...]:
    """The trajectories in the folders of point files, or in folders for such, that cover them.

    Parameters
    ----------
    crs : str
        ``EPSG:n`` of the project; empty to take the files' own.

    Returns
    -------
    tuple of Path
        As many as it takes; none where one of the files with times would stay without.
    """
    files = [times for path in inputs if (times := _times_of(path)) is not None]
    if not files:
        return ()
    chosen: dict[Path, None] = {}
    found = list(_candidates(inputs))
    system = crs or _system_of(inputs)
    for times in files:
        covering = next((path for path in found if _covers(path, times, system)), None)
        if covering is None:
            return ()
        chosen[covering] = None
    return tuple(chosen)


def images_beside(inputs: Sequence[Path]) -> tuple[Path, ...]:
    """The image lists in the folders of point files."""
    homes = dict.fromkeys(path.resolve().parent for path in inputs)
    files = [path for home in homes for path in _list_files(home)[:_MOST_FILES]]
    return tuple(path for path in files if _holds(path, Content.IMAGES))


def wants_trajectory(inputs: Sequence[Path]) -> bool:
    """Whether a scanner that moved recorded one of the point files, as far as their times tell."""
    return any(_times_of(path) is not None for path in inputs)


def _times_of(path: Path) -> NDArray[np.float64] | None:
    """Some times of a file whose scanner moved; None where no trajectory belongs to it."""
    with suppress(UserError):
        sample = read_sample(path, _SAMPLE_POINTS)
        times = np.asarray(sample.get("time", np.empty(0)), np.float64)
        times = times[np.isfinite(times)]
        if times.size and "origin" not in sample and "grid" not in sample:
            return times
    return None


def _system_of(inputs: Sequence[Path]) -> str:
    with suppress(UserError):
        return next((crs for path in inputs if (crs := read_info(path).crs)), "")
    return ""


def _candidates(inputs: Sequence[Path]) -> Iterator[Path]:
    """Files that hold trajectories: those in the same folder first."""
    seen: set[Path] = set()
    for home in dict.fromkeys(path.resolve().parent for path in inputs):
        for folder in (home, *_folders_in(home), *_folders_in(home.parent)):
            for path in _list_files(folder)[: 4 * _MOST_FILES]:
                if (
                    len(seen) < _MOST_FILES
                    and path not in seen
                    and _holds(path, Content.TRAJECTORY)
                ):
                    seen.add(path)
                    yield path


def _folders_in(folder: Path) -> list[Path]:
    return [path for path in _list_files(folder) if _FOLDER.search(path.name) and path.is_dir()]


def _list_files(folder: Path) -> list[Path]:
    try:
        return sorted(folder.iterdir())
    except OSError:  # a folder that nobody may read offers nothing
        return []


def _holds(path: Path, content: Content) -> bool:
    if path.suffix.lower() not in FORMATS.endings_read(content):
        return False
    with suppress(UserError), report_as_user_error(path):
        return path.is_file() and content_of(path) is content
    return False


def _covers(path: Path, times: NDArray[np.float64], crs: str) -> bool:
    # What can't be read, or lacks its reference system, is not offered.
    with suppress(UserError):
        read = read_trajectories((path,), crs)
        return match_trajectory(times, read, path.name, is_adjusted_standard=None) is not None
    return False
