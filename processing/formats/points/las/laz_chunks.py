"""Compressed LAS: the chunks of a LAZ file, checked before the decoder sees them.

The decoder (lazrs) believes sizes that it reads, and a damaged one makes it allocate gigabytes or
end in a Rust panic, which prints to the terminal. So the compressor's record, the chunk table and
the sizes of the layers in every chunk are held against the file first.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import BinaryIO

import lazrs
import numpy as np
from numpy.typing import NDArray

from processing.core.errors import UNCHANGED, BadFile
from processing.core.text import Text
from processing.formats.points.las.decoder_panics import is_panic, panics_unprinted
from processing.formats.points.las.las_header import LasHeader, damaged

_VLR_USER, _VLR_ID = "laszip encoded", 22204
_VLR_HEAD = struct.Struct("<HHBBHIIqqH")
_ITEM = struct.Struct("<HHH")
_ITEM_SIZES = {0: -1, 6: 20, 7: 8, 8: 6, 9: 29, 10: 30, 11: 6, 12: 8, 13: 29, 14: -1}
_LAYERS = {10: 9, 11: 1, 12: 2, 13: 1}
_BYTES_ITEM = 14
_POINTWISE_CHUNKED, _LAYERED_CHUNKED = 2, 3
_VARIABLE = 0xFFFFFFFF
_LARGEST_CHUNK_BYTES = 1 << 29
_SMALLEST_CHUNK_BYTES = 20


@dataclass(frozen=True)
class LazChunks:
    """Where the chunks of a LAZ file lie.

    Attributes
    ----------
    record : bytes
        The LASzip record that the decoder needs.
    first : (k + 1,) int64
        Number of the first point of each chunk; the last one is the number of points.
    at : (k + 1,) int64
        Byte where each chunk starts; the last one is where the last chunk ends.
    layer_count : int
        Layers of a chunk; 0 for formats 0 to 5, which have none.
    """

    header: LasHeader
    record: bytes
    first: NDArray[np.int64]
    at: NDArray[np.int64]
    layer_count: int

    def groups(self, points: int) -> Iterator[tuple[int, int]]:
        """Runs of chunks ``[begin, end)`` of at most so many points, one chunk at least."""
        begin, last = 0, self.first.size - 1
        while begin < last:
            end = int(np.searchsorted(self.first, self.first[begin] + points, side="right")) - 1
            end = min(max(end, begin + 1), last)
            yield begin, end
            begin = end

    def decoded(
        self, file: BinaryIO, begin: int, end: int, selection: int | None = None
    ) -> NDArray[np.uint8]:
        """The points of chunks ``[begin, end)``.

        Parameters
        ----------
        selection : int or None
            Which layers to decode, as lazrs counts them; None for all.

        Returns
        -------
        (n, point_size) uint8
            Records as an uncompressed file holds them; layers not selected are 0.

        Raises
        ------
        BadFile
            The chunks can't be decoded: names their points and bytes.
        """
        file.seek(int(self.at[begin]))
        data = file.read(int(self.at[end] - self.at[begin]))
        self._check_layers(data, begin, end)
        counts, sizes = np.diff(self.first[begin : end + 1]), np.diff(self.at[begin : end + 1])
        table = list(zip(counts.tolist(), sizes.tolist(), strict=True))
        points = np.zeros((int(counts.sum()), self.header.point_size), dtype=np.uint8)
        chosen = None if selection is None else lazrs.DecompressionSelection(selection)
        with _damage_told(self._undecodable(begin, end)):
            lazrs.decompress_points_with_chunk_table(
                data, self.record, points.reshape(-1), table, chosen
            )
        return points

    def decoded_span(
        self, file: BinaryIO, start: int, end: int, selection: int | None = None
    ) -> NDArray[np.uint8]:
        """Points ``[start, end)``; decodes the chunks that hold them. As :meth:`decoded`."""
        begin = int(np.searchsorted(self.first, start, side="right")) - 1
        stop = int(np.searchsorted(self.first, end))
        shift = int(self.first[begin])
        return self.decoded(file, begin, stop, selection)[start - shift : end - shift]

    def _check_layers(self, data: bytes, begin: int, end: int) -> None:
        """Formats 6 to 10: each chunk says how many points and how long layers it has."""
        head = 4 * (1 + self.layer_count)
        for chunk in range(begin, end) if self.layer_count else ():
            position = int(self.at[chunk] - self.at[begin]) + self.header.point_size
            size = int(self.at[chunk + 1] - self.at[chunk]) - self.header.point_size - head
            if size < 0:
                raise self._undecodable(chunk, chunk + 1)
            numbers = struct.unpack_from(f"<{1 + self.layer_count}I", data, position)
            if numbers[0] != self.first[chunk + 1] - self.first[chunk] or sum(numbers[1:]) > size:
                raise self._undecodable(chunk, chunk + 1)

    def _undecodable(self, begin: int, end: int) -> BadFile:
        first, last = self.first[begin] + 1, self.first[end]
        return damaged(
            self.header.path,
            Text(
                f"Points {first:,} to {last:,} can't be decompressed.",
                f"{first:,}～{last:,}点目を展開できません。",
            ),
            int(self.at[begin]),
        )


def read_chunk_table(header: LasHeader, file: BinaryIO) -> LazChunks:
    """Find the chunks of a LAZ file.

    Parameters
    ----------
    header : LasHeader
        Of a compressed file.

    Raises
    ------
    BadFile
        The compression is unknown or too old; the chunk table is damaged or contradicts the
        header or the file's size.
    """
    record, chunk_points, layer_count = _checked_record(header)
    if header.count == 0:
        nothing = np.zeros(1, dtype=np.int64)
        return LazChunks(header, record, nothing, nothing + header.points_at, layer_count)
    table_at = _table_position(header, file)
    start = header.points_at + 8
    file.seek(table_at)
    version, chunk_count = struct.unpack("<II", file.read(8))
    most = min(header.count, (table_at - start) // _SMALLEST_CHUNK_BYTES)
    needed = 1 if chunk_points == _VARIABLE else -(-header.count // chunk_points)
    fits = chunk_count == needed or chunk_points == _VARIABLE
    if version != 0 or not fits or not 0 < chunk_count <= most:
        raise _bad_table(header, table_at)
    counts, sizes = _read_table(header, file, record, (table_at, chunk_count))
    if chunk_points != _VARIABLE:
        counts[-1] = header.count - chunk_points * (counts.size - 1)
    first = np.concatenate([[0], np.cumsum(counts)])
    at = start + np.concatenate([[0], np.cumsum(sizes)])
    is_whole = (counts > 0).all() and (sizes >= _SMALLEST_CHUNK_BYTES).all()
    if not is_whole or first[-1] != header.count or at[-1] > table_at:
        raise _bad_table(header, table_at)
    if counts.max() * header.point_size > _LARGEST_CHUNK_BYTES:
        raise _too_large_chunks(header, int(counts.max()))
    return LazChunks(header, record, first, at, layer_count)


def _read_table(
    header: LasHeader, file: BinaryIO, record: bytes, table: tuple[int, int]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Points and bytes of each chunk, as far as the table says (its last count may be nominal)."""
    file.seek(header.points_at)
    with _damage_told(_bad_table(header, table[0])):
        entries = lazrs.read_chunk_table(file, lazrs.LazVlr(record))
    if len(entries) != table[1]:
        raise _bad_table(header, table[0])
    numbers = np.array(entries, dtype=np.uint64)
    if numbers.max() > np.uint64(1 << 40):
        raise _bad_table(header, table[0])
    counts, sizes = numbers.astype(np.int64).T
    return counts.copy(), sizes.copy()


def _table_position(header: LasHeader, file: BinaryIO) -> int:
    """Byte of the chunk table; a writer that could not go back noted it in the last 8 bytes."""
    file.seek(header.points_at)
    head = file.read(8)
    position = struct.unpack("<q", head)[0] if len(head) == 8 else 0
    if position == -1:
        file.seek(header.file_size - 8)
        position = struct.unpack("<q", file.read(8))[0]
    if not header.points_at + 8 <= position <= header.file_size - 8:
        raise damaged(
            header.path,
            Text(
                "The file ends before its chunk table.",
                "チャンクテーブルの前でファイルが終わっています。",
            ),
            header.file_size,
        )
    return int(position)


def _checked_record(header: LasHeader) -> tuple[bytes, int, int]:
    """The LASzip record, points in a chunk, layers in a chunk."""
    vlr = header.vlr(_VLR_USER, _VLR_ID)
    if vlr is None or len(vlr.data) < _VLR_HEAD.size:
        raise _unknown_compression(header)
    head = _VLR_HEAD.unpack_from(vlr.data)
    compressor, coder, chunk_points, item_count = head[0], head[1], head[6], head[9]
    wanted = _LAYERED_CHUNKED if header.point_format >= 6 else _POINTWISE_CHUNKED
    if compressor != wanted or coder != 0 or chunk_points == 0:
        raise _unknown_compression(header)
    if len(vlr.data) < _VLR_HEAD.size + item_count * _ITEM.size:
        raise _unknown_compression(header)
    size, layers = 0, 0
    for i in range(item_count):
        kind, item_size, version = _ITEM.unpack_from(vlr.data, _VLR_HEAD.size + i * _ITEM.size)
        is_layered = kind >= 10
        fits = _ITEM_SIZES.get(kind, 0) in (-1, item_size) and item_size > 0
        known = version in ((3, 4) if is_layered else (1, 2))
        if not fits or not known or is_layered != (wanted == _LAYERED_CHUNKED):
            raise _unknown_compression(header)
        size += item_size
        layers += item_size if kind == _BYTES_ITEM else _LAYERS.get(kind, 0)
    if size != header.point_size:
        raise _unknown_compression(header)
    return vlr.data, chunk_points, layers


@contextmanager
def _damage_told(reported: BadFile) -> Iterator[None]:
    """Raise ``reported`` for what the decoder raises; a panic is no Exception, by pyo3's choice."""
    with panics_unprinted():
        try:
            yield
        except BaseException as error:
            if not isinstance(error, lazrs.LazrsError) and not is_panic(error):
                raise
            raise reported from error


def _bad_table(header: LasHeader, table_at: int) -> BadFile:
    return damaged(
        header.path,
        Text(
            "The chunk table of the LAZ file is damaged.",
            "LAZファイルのチャンクテーブルが壊れています。",
        ),
        table_at,
    )


def _unknown_compression(header: LasHeader) -> BadFile:
    return BadFile(
        Text(
            "The compression of the points can't be read (damaged, or LASzip before 2.0).",
            "点の圧縮形式を読み取れません（破損、またはLASzip 2.0より前の形式）。",
        ),
        Text(f"{header.path}, LASzip record", f"{header.path}、LASzipレコード"),
        Text(
            "Copy the file again, or convert it to LAS with the program that wrote it. {unchanged}",
            "コピーし直すか、作成したソフトでLASに変換してください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )


def _too_large_chunks(header: LasHeader, points: int) -> BadFile:
    return BadFile(
        Text(
            f"The file is compressed in chunks of {points:,} points, too large to be decoded.",
            f"1チャンクが{points:,}点あり、大きすぎて展開できません。",
        ),
        Text(f"{header.path}, LASzip record", f"{header.path}、LASzipレコード"),
        Text(
            "Write it again with chunks of 50,000 points, or as LAS. {unchanged}",
            "1チャンク5万点のLAZか、LASとして保存し直してください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )
