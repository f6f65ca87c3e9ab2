"""Checksums of a file, block by block, in a record beside it: damage on the disk is seen.

The one owner of that record. A file without one is not judged: it is of an older project, or a kill
came between the file and its record, which is therefore taken away first and written last. Of a
small file the record keeps the content as well.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from processing.core.errors import BadFile, report_as_user_error
from processing.core.owned_files import is_link, new_file
from processing.core.text import Text

SUFFIX = ".sums"
BLOCK = 1 << 20
"""Bytes of a block: its checksum takes half a millisecond, which a stroke of the brush has."""

_MOST_COPIED = 1 << 20
_MAGIC = b"zuka sums 1\n"
_HEAD = struct.Struct("<QI?")  # bytes of the file, of a block, and whether a copy follows
_PAIR = struct.Struct("<II")
_END = struct.Struct("<I")
_OTHER = 0xFFFFFFFF


@dataclass(frozen=True)
class BlockSum:
    """CRC-32 of a block and, to be sure of what is mended by it, its Adler-32."""

    crc: int
    adler: int


@dataclass(frozen=True)
class BlockSums:
    """What a file is known by.

    Attributes
    ----------
    size : int
        Bytes of the file.
    sums : tuple of BlockSum
        Of the blocks, in their order; the last may be short.
    copy : bytes or None
        The content, of a small file.
    """

    size: int
    sums: tuple[BlockSum, ...]
    copy: bytes | None = None

    def spans(self) -> list[tuple[int, int]]:
        """First byte and end of each block."""
        return [(start, min(start + BLOCK, self.size)) for start in range(0, self.size, BLOCK)]


@dataclass(frozen=True)
class DamagedBlock:
    """A block that is not what was written: its number, and its bytes ``start … stop − 1``."""

    number: int
    start: int
    stop: int


def record_of(file: Path) -> Path:
    """Where the record of a file is."""
    return file.with_name(file.name + SUFFIX)


def sum_of(block: bytes | bytearray | memoryview) -> BlockSum:
    """The checksums of some bytes."""
    return BlockSum(zlib.crc32(block), zlib.adler32(block))


def sums_of(file: Path, check: Callable[[], object] | None = None) -> BlockSums:
    """The checksums of a file as it is now.

    Parameters
    ----------
    check : callable, optional
        Called between blocks; may raise to stop.

    Raises
    ------
    OSError
    """
    found: list[BlockSum] = []
    size, kept = 0, b""
    with file.open("rb") as opened:
        while block := opened.read(BLOCK):
            if check is not None:
                check()
            found.append(sum_of(block))
            kept = block
            size += len(block)
    is_small = size <= _MOST_COPIED and len(found) <= 1
    return BlockSums(size, tuple(found), kept if is_small and file.suffix != ".bin" else None)


def keep_sums(file: Path, sums: BlockSums | None = None) -> None:
    """Write the record of a file that is whole; of a link nothing is written.

    Parameters
    ----------
    sums : BlockSums, optional
        Of the file as it is; worked out where they aren't given.

    Raises
    ------
    OSError
    """
    if is_link(file):
        return
    known = sums_of(file) if sums is None else sums
    content = _MAGIC + _HEAD.pack(known.size, len(known.sums), known.copy is not None)
    content += b"".join(_PAIR.pack(one.crc, one.adler) for one in known.sums)
    content += known.copy or b""
    record = record_of(file)
    temporary = record.with_name(f"{record.name}-part")
    with new_file(temporary) as made:
        made.write(content + _END.pack(zlib.crc32(content)))
    temporary.replace(record)


def write_with_sums(file: Path, content: bytes) -> None:
    """Write a small file and its record, each whole or not at all; links are not written through.

    Raises
    ------
    OSError
        The file is as it was.
    """
    temporary = file.with_suffix(".part")
    try:
        with new_file(temporary) as made:
            made.write(content)
        place_with_sums(temporary, file)
    finally:
        temporary.unlink(missing_ok=True)
    keep_sums(file)


def forget_sums(file: Path) -> None:
    """Take the record of a file away: the file is going to be another.

    Raises
    ------
    OSError
    """
    record_of(file).unlink(missing_ok=True)


def place_with_sums(file: Path, place: Path) -> None:
    """Give a file its place by a rename, with its record if it has one.

    Raises
    ------
    OSError
    """
    forget_sums(place)
    file.replace(place)
    bring_sums(file, place)


def bring_sums(file: Path, place: Path) -> None:
    """Bring the record after a file that was renamed; does nothing where it has none.

    Raises
    ------
    OSError
    """
    with suppress(FileNotFoundError):
        record_of(file).replace(record_of(place))


def kept_sums(file: Path) -> BlockSums | None:
    """What the record of a file says; None where there is none, or none that can be read.

    Raises
    ------
    BadFile
        The record itself is damaged.
    OSError
    """
    record = record_of(file)
    try:
        content = record.read_bytes()
    except FileNotFoundError:
        return None
    at = len(_MAGIC) + _HEAD.size
    if len(content) < at + _END.size or not content.startswith(_MAGIC):
        raise _damaged_record(record)
    body, (end,) = content[: -_END.size], _END.unpack(content[-_END.size :])
    size, blocks, has_copy = _HEAD.unpack_from(body, len(_MAGIC))
    pairs = body[at : at + blocks * _PAIR.size]
    if zlib.crc32(body) != end or len(pairs) != blocks * _PAIR.size:
        raise _damaged_record(record)
    copy = body[at + len(pairs) :] if has_copy else None
    return BlockSums(size, tuple(BlockSum(*pair) for pair in _PAIR.iter_unpack(pairs)), copy)


def damaged_blocks(
    file: Path, known: BlockSums, check: Callable[[], object] | None = None
) -> list[DamagedBlock]:
    """The blocks of a file of the right size that are not what was written.

    Parameters
    ----------
    check : callable, optional
        Called between blocks; may raise to stop.

    Raises
    ------
    OSError
    """
    found = []
    with file.open("rb") as opened:
        for number, (start, stop) in enumerate(known.spans()):
            if check is not None:
                check()
            if not _is_whole(opened, known, number):
                found.append(DamagedBlock(number, start, stop))
    return found


def refuse_damaged(file: Path, start: int = 0, stop: int | None = None) -> None:
    """Refuse a file that has another length than it was written with, or damaged blocks.

    Parameters
    ----------
    start, stop : int
        Bytes that are read now; the blocks they lie in are checked.

    Raises
    ------
    BadFile
        Names the file and the bytes.
    MissingInput, NoSpace
    """
    with report_as_user_error(file):
        known = kept_sums(file)
        if known is None:
            return
        size = file.stat().st_size
        if size != known.size:
            raise changed_file(file, f"{size:,} ≠ {known.size:,}")
        end = size if stop is None else min(stop, size)
        with file.open("rb") as opened:
            for number in range(start // BLOCK, -(-end // BLOCK)):
                if not _is_whole(opened, known, number):
                    first, last = known.spans()[number]
                    raise changed_file(file, f"{first:,}–{last:,}")


def changed_file(file: Path, bytes_: str) -> BadFile:
    """The error for a file that is not what was written.

    Parameters
    ----------
    bytes_ : str
        Which bytes, or how many there are and should be.
    """
    return BadFile(
        Text(
            "A file of the project is not what Zuka wrote: the disk, or a copy, changed it.",
            "プロジェクトのファイルの内容が、書き込んだ時と変わっています"
            "（ディスクの故障、またはコピー時の破損）。",
        ),
        Text("{file}, bytes {bytes}", "{file}、バイト {bytes}").filled(file=file, bytes=bytes_),
        CHECK_REMEDY,
    )


CHECK_REMEDY = Text(
    "Use File ▸ Check project, or zuka check PROJECT --repair, which makes again what it can.",
    "「ファイル ▸ プロジェクトの検査」または zuka check PROJECT --repair を実行してください。"
    "作り直せるものは作り直されます。",
)
"""What to do about a damaged file of a project."""


def begin_writing(file: Path) -> BlockSums | None:
    """Put the record of a file aside while blocks of it are written in place.

    After a kill it lies there: what was being written is not judged, and :func:`settle_sums` tells
    the rest by it.

    Returns
    -------
    BlockSums or None
        What the record said.

    Raises
    ------
    OSError
    """
    try:
        known = kept_sums(file)
    except BadFile:
        return None
    if known is not None:
        record_of(file).replace(_aside(file))
    return known


def end_writing(file: Path, known: BlockSums | None, written: Mapping[int, bool]) -> None:
    """Write the record of a file anew after some of its blocks were written.

    Parameters
    ----------
    known : BlockSums or None
        What :func:`begin_writing` gave.
    written : mapping of int to bool
        By number of the block, whether it was what it should be before: one that was not stays
        damaged.

    Raises
    ------
    OSError
    """
    if known is None:
        return
    sums = list(known.sums)
    with file.open("rb") as opened:
        for number, was_whole in written.items():
            opened.seek(number * BLOCK)
            found = sum_of(opened.read(BLOCK))
            sums[number] = found if was_whole else BlockSum(found.crc ^ _OTHER, found.adler)
    keep_sums(file, BlockSums(known.size, tuple(sums)))
    _aside(file).unlink(missing_ok=True)


def settle_sums(file: Path, blocks: Iterable[int]) -> None:
    """Bring the record back that a kill left aside while these blocks were written.

    Raises
    ------
    OSError
    """
    aside = _aside(file)
    if is_link(aside) or not aside.is_file():
        return
    if not record_of(file).exists():
        aside.replace(record_of(file))
        with suppress(BadFile):
            end_writing(file, kept_sums(file), dict.fromkeys(blocks, True))
    aside.unlink(missing_ok=True)


def _aside(file: Path) -> Path:
    return file.with_name(f"{file.name}{SUFFIX}-writing")


def is_whole(block: bytes | bytearray, known: BlockSums, number: int) -> bool:
    """Whether a block is what was written."""
    return number < len(known.sums) and zlib.crc32(block) == known.sums[number].crc


def _is_whole(opened: BinaryIO, known: BlockSums, number: int) -> bool:
    opened.seek(number * BLOCK)
    return is_whole(opened.read(BLOCK), known, number)


def _damaged_record(record: Path) -> BadFile:
    return BadFile(
        Text(
            "The checksums of a file of the project are damaged.",
            "プロジェクトのファイルのチェックサムが壊れています。",
        ),
        Text.same(str(record)),
        CHECK_REMEDY,
    )
