"""Which delivered files a project has already: the same content, wherever they lie now."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.project.importing.file_recorder import checksum_of
from processing.project.importing.import_request import FileMark, mark_of
from processing.recording.drive import Drive

_COMPARING = Text("Comparing {name}", "{name} を照合中")


@dataclass(frozen=True)
class KnownFiles:
    """Point files, sorted by whether a project has them.

    Attributes
    ----------
    new, known : tuple of Path
        In the order in which they were given.
    drives : tuple of Drive
        Those that have points of the known ones.
    """

    new: tuple[Path, ...]
    known: tuple[Path, ...]
    drives: tuple[Drive, ...]


def known_files(inputs: Sequence[Path], drives: Sequence[Drive], monitor: Monitor) -> KnownFiles:
    """Find the files that were imported before.

    A file that is as it was when it was imported is told at a glance; another one of the same
    size is read for its checksum.

    Raises
    ------
    UserError
        A file can't be read.
    """
    known, of_known = [], dict.fromkeys(drives, False)
    for path in inputs:
        monitor.check()
        having = _having(path, drives, monitor)
        of_known.update(dict.fromkeys(having, True))
        if having:
            known.append(path)
    return KnownFiles(
        new=tuple(path for path in inputs if path not in known),
        known=tuple(known),
        drives=tuple(drive for drive in drives if of_known[drive]),
    )


def _having(path: Path, drives: Sequence[Drive], monitor: Monitor) -> list[Drive]:
    mark = mark_of(path)
    sources = [
        (source, drive)
        for drive in drives
        for source in drive.info.sources
        if source.size == mark.size and source.points
    ]
    unchanged = [
        drive
        for source, drive in sources
        if FileMark(source.path, source.size, source.modified_ns) == mark
    ]
    if unchanged or not sources or path.is_dir():
        return unchanged
    monitor.report(0.0, _COMPARING.filled(name=path.name))
    checksum = checksum_of(path)
    return [drive for source, drive in sources if source.sha256 == checksum]
