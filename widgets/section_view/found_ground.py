"""FoundGround: reads the surfaces that drives keep of the tool “ground”, for one worker."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from processing.errors import UserError
from processing.ground.stored_surface import FILE_NAME, StoredSurface, ground_surface_of
from processing.points.drive import Drive
from processing.section.cut import Cut
from processing.section.surface_line import SurfaceLine, surface_lines, without_doubles

_Stamp = tuple[int, int]


class FoundGround:
    """Keeps surfaces open as long as they are the ones on the disk."""

    def __init__(self) -> None:
        self._opened: dict[str, tuple[_Stamp, StoredSurface]] = {}

    def lines(self, drives: Sequence[Drive], cut: Cut) -> tuple[SurfaceLine, ...]:
        """Where the ground of some drives lies in a section; a damaged surface shows nothing."""
        found = []
        for drive in drives:
            try:
                surface = self._surface_of(drive)
                found.append(() if surface is None else surface_lines(surface, cut))
            except UserError:  # who makes volumes of it is told; here it is just not there
                self._opened.pop(drive.id, None)
        return without_doubles(one for one in found if one)

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
