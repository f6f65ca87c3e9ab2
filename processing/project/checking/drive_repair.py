"""Damaged files of a drive made again: from their records, bit by bit, or from what was delivered.

The order of the points stays, so the map and the labels that rest on them stay as well: of what an
import gives anew only blocks are taken whose checksums are those of the damaged ones.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path
from uuid import uuid4

from processing.core.block_sums import (
    BlockSums,
    DamagedBlock,
    forget_sums,
    keep_sums,
    sum_of,
    sums_of,
)
from processing.core.errors import UserError, report_as_user_error
from processing.core.monitor import Monitor
from processing.core.owned_files import make_marked, remove_folder
from processing.core.safe_write import write_safely
from processing.core.text import Text
from processing.project.checking.bit_mending import with_bit_mended
from processing.project.checking.drive_check import DamagedFile
from processing.project.checking.findings import FileFinding, FindingState
from processing.project.checking.rebuilt_drive import (
    Rebuilding,
    RebuiltDrive,
    rebuild_drive,
)
from processing.project.importing.unfinished_imports import TEMPORARY
from processing.recording.drive_files import FileOrigin, origin_of

_BY_COPY = Text("Made again from its second copy.", "控えから復元しました。")
_BY_BIT = Text("The bit that turned over was turned back.", "反転したビットを元に戻しました。")
_BY_DELIVERY = Text("Made again from the delivered files.", "納品ファイルから作り直しました。")
_REMOVED = Text(
    "Removed: it is made again when it is needed, by its tool or by itself.",
    "削除しました。必要なときに自動で、または該当するツールで作り直されます。",
)
_RECORDED = Text(
    "Its checksums were made again from the file as it is.",
    "現在のファイルからチェックサムを作り直しました。",
)


def repair_drive(
    project: Path, damaged: Sequence[DamagedFile], rebuilding: Rebuilding
) -> Iterator[FileFinding]:
    """Make damaged files of a drive again, as far as it can be done.

    Yields
    ------
    FileFinding
        One for each of them.

    Raises
    ------
    Cancelled, NoSpace
    """
    rest, monitor = [], rebuilding.monitor
    for one in damaged:
        monitor.check()
        done = _repair_at_hand(one)
        if done is None:
            rest.append(one)
        else:
            yield _repaired(project, one, done)
    if not rest:
        return
    wanted = [one for one in rest if origin_of(one.path) is FileOrigin.DELIVERED]
    reason: UserError | None = None
    into = project / TEMPORARY / uuid4().hex
    try:
        if wanted:
            with report_as_user_error(into):
                make_marked(into)
            try:
                rebuilt = rebuild_drive(rebuilding, into / "import")
            except UserError as error:
                reason = error
            else:
                for one in wanted:
                    if _take_rebuilt(one, rebuilt, monitor):
                        rest.remove(one)
                        yield _repaired(project, one, _BY_DELIVERY)
    finally:
        remove_folder(into)
    for one in rest:
        is_told = reason is not None and one in wanted
        remedy = _why_not(reason) if is_told and reason is not None else one.remedy
        yield FileFinding(_name(project, one.path), one.what, remedy)


def _repair_at_hand(one: DamagedFile) -> Text | None:
    """Mend a file without the delivered ones; how, or None where that can't be done."""
    with report_as_user_error(one.path):
        if one.known is None:
            if one.path.is_file():
                forget_sums(one.path)
                keep_sums(one.path)
                return _RECORDED
            return None
        if one.known.copy is not None:
            with write_safely(one.path) as made:
                made.write_bytes(one.known.copy)
            return _BY_COPY
        if one.path.is_file() and one.path.stat().st_size == one.known.size:
            mended = {block.number: _mended(one.path, one.known, block) for block in one.blocks}
            if all(block is not None for block in mended.values()):
                _write_blocks(one.path, one.known, mended)
                return _BY_BIT
        if origin_of(one.path) is FileOrigin.DERIVED:
            one.path.unlink(missing_ok=True)
            forget_sums(one.path)
            return _REMOVED
    return None


def _mended(path: Path, known: BlockSums, block: DamagedBlock) -> bytes | None:
    return with_bit_mended(_read(path, block), known.sums[block.number])


def _take_rebuilt(one: DamagedFile, rebuilt: RebuiltDrive, monitor: Monitor) -> bool:
    """Take from the rebuilt drive what the damaged blocks were; whether all of it was there."""
    monitor.check()
    candidate = rebuilt.folder / one.path.name
    with report_as_user_error(one.path):
        if one.known is None:
            return _take_unknown(one.path, candidate, rebuilt)
        if candidate.is_file() and sums_of(candidate, monitor.check).sums == one.known.sums:
            with write_safely(one.path) as made:
                shutil.copyfile(candidate, made)
            return True
    if one.path.suffix != ".bin":
        return False
    blocks: dict[int, bytes | None] = {}
    for block in one.blocks:
        monitor.check()
        found = rebuilt.bytes_at_old_places(one.path.stem, block.start, block.stop)
        is_it = found is not None and sum_of(found) == one.known.sums[block.number]
        blocks[block.number] = found if is_it else None
    if not blocks or any(found is None for found in blocks.values()):
        return False
    with report_as_user_error(one.path):
        _write_blocks(one.path, one.known, blocks)
    return True


def _take_unknown(path: Path, candidate: Path, rebuilt: RebuiltDrive) -> bool:
    """Take a file whose checksums nobody knows, where all others say that the order is the same."""
    if not candidate.is_file() or not rebuilt.has_same_order:
        return False
    with write_safely(path) as made:
        shutil.copyfile(candidate, made)
    forget_sums(path)
    keep_sums(path)
    return True


def _write_blocks(path: Path, known: BlockSums, blocks: dict[int, bytes | None]) -> None:
    """Let a file be the same with other blocks, whole or not at all."""
    with write_safely(path) as made, made.open("wb") as new:
        old = path.open("rb") if path.is_file() else None
        try:
            for number, (start, stop) in enumerate(known.spans()):
                block = blocks.get(number)
                if block is None and old is not None:
                    old.seek(start)
                    block = old.read(stop - start)
                new.write(block or b"")
        finally:
            if old is not None:
                old.close()


def _read(path: Path, block: DamagedBlock) -> bytes:
    with path.open("rb") as file:
        file.seek(block.start)
        return file.read(block.stop - block.start)


def _repaired(project: Path, one: DamagedFile, how: Text) -> FileFinding:
    return FileFinding(_name(project, one.path), one.what, how, FindingState.REPAIRED)


def _why_not(reason: UserError) -> Text:
    words = Text("{what} ({where}) {remedy}", "{what}（{where}）{remedy}")
    return words.filled(what=reason.what, where=reason.where, remedy=reason.remedy)


def _name(project: Path, path: Path) -> str:
    return path.relative_to(project).as_posix()
