"""The files of one drive against their checksums, and what opening the drive says."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from processing.core.block_sums import (
    CHECK_REMEDY,
    BlockSums,
    DamagedBlock,
    damaged_blocks,
    kept_sums,
)
from processing.core.errors import BadFile, UserError, report_as_user_error
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.project.checking.findings import FileFinding, FindingState, finding_of
from processing.recording.drive import Drive
from processing.recording.drive_files import FileOrigin, missing_files, origin_of, summed_files

_ALTERED = Text(
    "Changed on the disk, bytes {spans}.", "ディスク上で変化しています（バイト {spans}）。"
)
_LENGTH = Text(
    "It has {size:,} bytes where {known:,} were written.",
    "{known:,}バイトのはずが{size:,}バイトです。",
)
_GONE = Text("The file is gone.", "ファイルがなくなっています。")
_RECORD = Text("Its checksums are damaged.", "チェックサムが壊れています。")
_UNKNOWN = Text("It has no checksums yet.", "まだチェックサムがありません。")
_ADD = Text(
    "Use --repair (File ▸ Check project ▸ Repair) to add them.",
    "--repair（「ファイル ▸ プロジェクトの検査 ▸ 修復」）で追加できます。",
)
_BY_HAND = Text(
    "No delivered file tells it: restore the file from a backup, or check the points by eye.",
    "納品ファイルからは復元できません。"
    "バックアップから戻すか、該当する点を目視で確認してください。",
)
_MOST_SPANS = 3


@dataclass(frozen=True)
class DamagedFile:
    """A file of a drive that is not what was written.

    Attributes
    ----------
    known : BlockSums or None
        What it should be; None where its record is damaged or there is none.
    blocks : tuple of DamagedBlock
        Which are wrong; all of them where the length is.
    """

    path: Path
    what: Text
    known: BlockSums | None
    blocks: tuple[DamagedBlock, ...] = ()

    @property
    def remedy(self) -> Text:
        """What can be done about it."""
        return _BY_HAND if origin_of(self.path) is FileOrigin.BY_HAND else CHECK_REMEDY

    def finding(self, project: Path) -> FileFinding:
        """What is said of it."""
        return FileFinding(self.path.relative_to(project).as_posix(), self.what, self.remedy)


@dataclass(frozen=True)
class CheckedDrive:
    """What the files of a drive are like.

    Attributes
    ----------
    unknown : tuple of Path
        Files without checksums.
    """

    folder: Path
    files: int
    damaged: tuple[DamagedFile, ...]
    unknown: tuple[Path, ...]


def check_files(folder: Path, monitor: Monitor) -> CheckedDrive:
    """Compare the files of a drive with their checksums.

    Raises
    ------
    Cancelled, MissingInput, NoSpace
    """
    files, gone = summed_files(folder), missing_files(folder)
    total = max(1, sum(path.stat().st_size for path in files))
    done, damaged, unknown = 0, [], []
    for path in files:
        monitor.report(done / total)
        done += path.stat().st_size
        try:
            with report_as_user_error(path):
                known = kept_sums(path)
                found = None if known is None else _compare(path, known, monitor)
        except BadFile as error:
            found, known = DamagedFile(path, _what_of(error), None), None
        else:
            if known is None:
                unknown.append(path)
        if found is not None:
            damaged.append(found)
    for path in gone:
        with report_as_user_error(path):
            damaged.append(_lacking(path))
    return CheckedDrive(folder, len(files) + len(gone), tuple(damaged), tuple(unknown))


def _what_of(error: BadFile) -> Text:
    return _RECORD if error.remedy == CHECK_REMEDY else error.what


def _compare(path: Path, known: BlockSums, monitor: Monitor) -> DamagedFile | None:
    size = path.stat().st_size
    if size != known.size:
        blocks = tuple(DamagedBlock(n, *span) for n, span in enumerate(known.spans()))
        return DamagedFile(path, _LENGTH.filled(size=size, known=known.size), known, blocks)
    blocks = tuple(damaged_blocks(path, known, monitor.check))
    if not blocks:
        return None
    spans = ", ".join(f"{one.start:,}–{one.stop:,}" for one in blocks[:_MOST_SPANS])
    more = " …" if len(blocks) > _MOST_SPANS else ""
    return DamagedFile(path, _ALTERED.filled(spans=spans + more), known, blocks)


def _lacking(path: Path) -> DamagedFile:
    try:
        known = kept_sums(path)
    except BadFile:
        known = None
    spans = [] if known is None else known.spans()
    return DamagedFile(path, _GONE, known, tuple(DamagedBlock(n, *s) for n, s in enumerate(spans)))


def opening_findings(folder: Path, project: Path) -> Iterator[FileFinding]:
    """What opening a drive says, beside what its checksums tell."""
    try:
        drive = Drive(folder)
        _ = drive.trajectory, drive.images
    except UserError as error:
        yield finding_of(folder.relative_to(project).as_posix(), error)


def unknown_findings(checked: CheckedDrive, project: Path) -> Iterator[FileFinding]:
    """Files without checksums: one line for a drive."""
    if checked.unknown:
        names = ", ".join(path.relative_to(checked.folder).as_posix() for path in checked.unknown)
        place = f"{checked.folder.relative_to(project).as_posix()}: {names}"
        yield FileFinding(place, _UNKNOWN, _ADD, FindingState.NOTED)
