"""The volumes of a project, each with its map.

Each has a folder of its own below ``results/volumes``, which comes and goes by one rename, with a
step of the history: it is there whole or not at all. Its numbers are read when they are listed,
its map only when it is shown.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from processing.core.errors import BadFile, MissingInput, UserError, report_as_user_error
from processing.core.owned_files import is_link, make_marked, remove_folder
from processing.core.stored_json import json_of
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.volumes.volume_result import VolumeResult
from processing.methods.ground.filters.cells import CellGrid
from processing.project.volumes.volume import KeptVolume
from processing.project.volumes.volume_facts import (
    VolumeRecord,
    damaged,
    grid_of,
    kept_of,
    values_of,
)
from processing.project.volumes.volume_sections import read_sections, write_sections
from processing.recording.columns.array_files import map_array

VOLUMES = "results/volumes"
"""Folder of a project: a folder for each volume."""

_FACTS, _SECTIONS = "volume.json", "sections.npz"
_ARRAYS = {
    "before": np.dtype(np.float32),
    "after": np.dtype(np.float32),
    "is_measured": np.dtype(np.bool_),
    "inside": np.dtype(np.float32),
}


def volume_name(id_: str) -> str:
    """Where a volume lies in its project's folder, with slashes."""
    return f"{VOLUMES}/{id_}"


def write_volume(kept: KeptVolume, result: VolumeResult, folder: Path) -> None:
    """Write a volume into a new folder, which a step of the project takes in.

    Raises
    ------
    NoSpace, MissingInput, BadFile
        What the operating system says; what was written so far is removed.
    """
    with report_as_user_error(folder):
        make_marked(folder)
        try:
            for name, dtype in _ARRAYS.items():
                values = np.ascontiguousarray(getattr(result.change, name), dtype)
                with (folder / f"{name}.npy").open("wb") as file:
                    np.save(file, values)
                    _flush(file.fileno())
            if result.line is not None:
                write_sections(folder / _SECTIONS, result.line, result.between)
            with (folder / _FACTS).open("w", encoding="utf-8") as text:
                json.dump(values_of(kept, result.change.grid), text, ensure_ascii=False)
                text.flush()
                _flush(text.fileno())
        except BaseException:
            remove_folder(folder)
            raise


class VolumeStore:
    """The volumes of a project.

    Parameters
    ----------
    project : Path
        Its folder.
    """

    def __init__(self, project: Path) -> None:
        self._home = project / VOLUMES

    def all(self) -> tuple[KeptVolume, ...]:
        """All volumes, the first one first; what can't be read is left out."""
        folders = self._home.iterdir() if self._home.is_dir() else ()
        found = []
        for folder in folders:
            with suppress(BadFile, MissingInput):
                found.append(kept_of(_read_facts(folder), folder))
        return tuple(sorted(found, key=lambda one: (one.made, one.id)))

    def damage(self) -> Iterator[tuple[str, UserError]]:
        """Names of volumes that can't be read, and why."""
        for folder in sorted(self._home.iterdir()) if self._home.is_dir() else ():
            if folder.is_dir() and not is_link(folder):
                try:
                    self.read_result(kept_of(_read_facts(folder), folder))
                except UserError as error:
                    yield folder.name, error

    def read_map(self, id_: str) -> ChangeGrid:
        """The map of a volume; its arrays stay on the disk until they are looked at.

        Raises
        ------
        MissingInput, BadFile
            It is gone or damaged.
        """
        folder = self._home / id_
        facts = _read_facts(folder)
        try:
            grid = grid_of(facts["grid"])
        except (KeyError, TypeError, ValueError) as error:
            raise damaged(folder / _FACTS) from error
        arrays = {name: _map_grid(folder / f"{name}.npy", grid) for name in _ARRAYS}
        return ChangeGrid(grid, **arrays)

    def read_result(self, kept: KeptVolume) -> VolumeResult:
        """A volume as it was computed, with its map and its sections.

        Raises
        ------
        MissingInput, BadFile
            It is gone or damaged.
        """
        path = self._home / kept.id / _SECTIONS
        line, between = read_sections(path) if path.exists() else (None, ())
        return VolumeResult(
            kept.volumes,
            kept.method,
            kept.grid_m,
            self.read_map(kept.id),
            kept.registration,
            kept.notes,
            line,
            between,
        )


def _flush(file: int) -> None:
    # Renamed before its content is on the disk, a file could be empty after a power cut.
    os.fsync(file)


def _map_grid(path: Path, grid: CellGrid) -> Any:  # each array has its own dtype
    with report_as_user_error(path):
        try:
            values = map_array(path)
        except (ValueError, EOFError) as error:
            raise damaged(path) from error
    if values.shape != (grid.rows, grid.columns) or values.dtype != _ARRAYS[path.stem]:
        raise damaged(path)
    return values


def _read_facts(folder: Path) -> VolumeRecord:  # what JSON holds
    path = folder / _FACTS
    with report_as_user_error(path):
        text = path.read_bytes()
    try:
        facts = json_of(text)
    except ValueError as error:
        raise damaged(path) from error
    if not isinstance(facts, dict):
        raise damaged(path)
    return facts
