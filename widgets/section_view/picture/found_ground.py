"""FoundGround: reads the surfaces that drives keep of the tool “ground”, for one worker."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np

from processing.core.errors import UserError
from processing.methods.ground.edited_ground import update_ground_lines
from processing.methods.ground.stored_surface import FILE_NAME, StoredSurface, ground_surface_of
from processing.methods.ground.surface_line import SurfaceLine, remove_doubles, surface_lines
from processing.project.results.run_findings import finding_of, newest_run
from processing.project.volumes.epochs import Epoch, epochs_of
from processing.recording.columns.counted_classes import class_columns
from processing.recording.drive import Drive
from processing.scoring.points.asked_classes import GROUND_ASKED
from processing.scoring.points.confusion_matrix import is_one_of
from processing.section.cut import Cut
from processing.section.points_in_cut import SectionPoints

_Stamp = tuple[int, int]
_GROUND = "ground"
_NONE = np.empty(0, np.bool_)


class FoundGround:
    """Keeps surfaces open as long as they are the ones on the disk."""

    def __init__(self) -> None:
        self._opened: dict[str, tuple[_Stamp, StoredSurface]] = {}
        self._epochs: tuple[tuple[Drive, ...], tuple[Epoch, ...]] = ((), ())

    def epochs(self, drives: Sequence[Drive]) -> tuple[Epoch, ...]:
        """The surveys that drives are of, the older ones first."""
        if self._epochs[0] != tuple(drives):
            self._epochs = tuple(drives), epochs_of(drives)
        return self._epochs[1]

    def lines(self, drives: Sequence[Drive], cut: Cut) -> tuple[SurfaceLine, ...]:
        """Where the ground of some drives lies in a section; a damaged surface shows nothing."""
        found = []
        for drive in drives:
            try:
                surface = self._surface_of(drive)
                found.append(() if surface is None else surface_lines(surface, cut))
            except UserError:  # who makes volumes of it is told; here it is just not there
                self._opened.pop(drive.id, None)
        return remove_doubles(one for one in found if one)

    def lines_now(
        self, drives: Sequence[Drive], cut: Cut, parts: Sequence[SectionPoints]
    ) -> tuple[SurfaceLine, ...]:
        """The same of each epoch, but for what points were made ground since, or are it no longer.

        Parameters
        ----------
        parts : sequence of SectionPoints
            The points of the slab, drive by drive.
        """
        found: list[SurfaceLine] = []
        points = {drive.id: part for drive, part in zip(drives, parts, strict=True)}
        for number, epoch in enumerate(self.epochs(drives)):
            own = [points[drive.id] for drive in epoch.drives]
            lines = self._lines_of_epoch(epoch.drives, cut, own)
            found += [replace(line, epoch=number) for line in lines]
        return tuple(found)

    def _lines_of_epoch(
        self, drives: Sequence[Drive], cut: Cut, parts: Sequence[SectionPoints]
    ) -> tuple[SurfaceLine, ...]:
        lines = self.lines(drives, cut)
        if not lines:
            return lines
        sections, is_ground, was_ground = [np.empty((0, 3))], [_NONE], [_NONE]
        for drive, part in zip(drives, parts, strict=True):
            with suppress(UserError):  # what isn't known of a drive changes nothing
                run = newest_run(drive, _GROUND)
                if run and drive.id in self._opened:
                    said = finding_of(drive, _GROUND, run, part.points)
                    codes = class_columns(drive.columns).codes_of(part.points)
                    sections.append(part.section)
                    is_ground.append(is_one_of(codes, GROUND_ASKED.codes))
                    was_ground.append(said)
        return update_ground_lines(
            lines, np.concatenate(sections), np.concatenate(is_ground), np.concatenate(was_ground)
        )

    def _surface_of(self, drive: Drive) -> StoredSurface | None:
        stamp = _stamp_of(drive.folder / FILE_NAME)
        if stamp is None:
            self._opened.pop(drive.id, None)
            return None
        known = self._opened.get(drive.id)
        if known is None or known[0] != stamp:
            surface = ground_surface_of(drive)
            if surface is None:
                return None
            known = self._opened[drive.id] = stamp, surface
        return known[1]


def _stamp_of(path: Path) -> _Stamp | None:
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size
