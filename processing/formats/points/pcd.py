"""PCD, the Point Cloud Library's format: ascii and binary, organised as an image or not.

Read in blocks with every field; Open3D's readers hold the whole cloud in memory.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import UNCHANGED, BadFile, report_as_user_error
from processing.core.text import Text
from processing.formats.points.delivered.delivered_floats import ColumnBlock, FloatFile
from processing.formats.points.delivered.field_names import block_of, has_position
from processing.formats.points.las.las_header import damaged
from processing.formats.points.text.text_numbers import TextPart, number_blocks

_LONGEST_HEADER = 1 << 16
_BLOCK_POINTS = 500_000
_KINDS = {"F": "f", "I": "i", "U": "u"}
_PACKED_COLORS = ("rgb", "rgba")


@dataclass(frozen=True)
class _Header:
    path: Path
    names: tuple[str, ...]
    dtype: np.dtype[np.void]
    columns: tuple[int, ...]
    count: int
    is_text: bool
    size: int
    grid: tuple[int, int] | None


def is_pcd(start: bytes) -> bool:
    """Whether a file's first bytes are those of a PCD header."""
    lines = [line for line in start.split(b"\n") if line.strip() and not line.startswith(b"#")]
    return bool(lines) and lines[0].split()[0] in (b"VERSION", b"FIELDS")


def open_pcd(path: Path) -> FloatFile:
    """A PCD file; where it is organised as an image, each point has its cell.

    A column of the image is taken as a sweep.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read; the header is damaged or contradicts the file's size; its points are
        compressed.
    """
    header = _read_header(path)
    return FloatFile(path, "PCD", lambda: _blocks(header))


def _blocks(header: _Header) -> Iterator[ColumnBlock]:
    done = 0
    for fields in _text_fields(header) if header.is_text else _binary_fields(header):
        block = block_of(_with_colors(fields))
        count = block["xyz"].shape[0]
        if header.grid is not None:
            rows, columns = np.divmod(np.arange(done, done + count), header.grid[0])
            block["grid"] = np.column_stack([columns, rows])
        yield block
        done += count


def _with_colors(fields: dict[str, NDArray[np.generic]]) -> dict[str, NDArray[np.generic]]:
    """One packed number in three channels: blue in the lowest byte."""
    name = next((name for name in _PACKED_COLORS if name in fields), None)
    if name is None:
        return fields
    values = fields[name]
    is_float = values.dtype.kind == "f"
    packed = values.astype(np.float32).view(np.uint32) if is_float else values.astype(np.uint32)
    channels = {
        channel: ((packed >> np.uint32(shift)) & np.uint32(255)).astype(np.uint8)
        for channel, shift in (("red", 16), ("green", 8), ("blue", 0))
    }
    return fields | channels


def _text_fields(header: _Header) -> Iterator[dict[str, NDArray[np.generic]]]:
    part = TextPart(header.path, header.size, limit=header.count)
    positions = np.concatenate([[0], np.cumsum(header.columns)])
    done = 0
    for numbers in number_blocks(part, int(positions[-1])) if header.count else ():
        done += numbers.shape[0]
        fields: dict[str, NDArray[np.generic]] = {
            name: numbers[:, positions[i]] for i, name in enumerate(header.names)
        }
        # Packed colours need the type that they were packed in; coordinates lose nothing as text.
        for i, name in enumerate(header.names):
            if name in _PACKED_COLORS:
                fields[name] = fields[name].astype(header.dtype[i].base)
        yield fields
    if done < header.count:
        raise _ends_early(header, done)


def _binary_fields(header: _Header) -> Iterator[dict[str, NDArray[np.generic]]]:
    with report_as_user_error(header.path), header.path.open("rb") as file:
        file.seek(header.size)
        for start in range(0, header.count, _BLOCK_POINTS):
            count = min(_BLOCK_POINTS, header.count - start)
            data = file.read(count * header.dtype.itemsize)
            if len(data) < count * header.dtype.itemsize:
                raise _ends_early(header, start + len(data) // header.dtype.itemsize)
            records = np.frombuffer(data, header.dtype)
            fields = {name: records[f"{i}"] for i, name in enumerate(header.names)}
            yield {name: v if v.ndim == 1 else v[:, 0] for name, v in fields.items()}


def _read_header(path: Path) -> _Header:
    with report_as_user_error(path), path.open("rb") as file:
        start = file.read(_LONGEST_HEADER)
        file_size = path.stat().st_size
    said: dict[str, list[str]] = {}
    size = 0
    for line in start.splitlines(keepends=True):
        size += len(line)
        words = line.decode("ascii", "replace").split()
        if words and not words[0].startswith("#"):
            said[words[0]] = words[1:]
        if words and words[0] == "DATA":
            break
    storage = (said.get("DATA") or [""])[0]
    if storage == "binary_compressed":
        raise _make_compression_error(path)
    try:
        header = _header_of(path, said, size)
    except (KeyError, ValueError, IndexError, TypeError) as error:
        raise _bad_header(path) from error
    least = 2 * sum(header.columns) if header.is_text else header.dtype.itemsize
    if header.count * least > file_size - size + 1:
        raise _ends_early(header, (file_size - size) // least)
    return header


def _header_of(path: Path, said: dict[str, list[str]], size: int) -> _Header:
    names = tuple(name.lower() for name in said["FIELDS"])
    widths = [int(word) for word in said["SIZE"]]
    columns = tuple(int(word) for word in said.get("COUNT", ["1"] * len(names)))
    kinds = [_KINDS[word] for word in said["TYPE"]]
    fields = [
        (f"{i}", f"<{kind}{width}", (count,))
        for i, (kind, width, count) in enumerate(zip(kinds, widths, columns, strict=True))
    ]
    is_whole = len(fields) == len(names) and min(columns) >= 1 and max(columns) < 10_000
    count = int(said["POINTS"][0])
    if not is_whole or count < 0 or not has_position(names) or said["DATA"][0] not in _STORAGES:
        raise ValueError(said["DATA"])
    is_text = said["DATA"][0] == "ascii"
    grid = _grid_of(said, count)
    return _Header(path, names, np.dtype(fields), columns, count, is_text, size, grid)


def _grid_of(said: dict[str, list[str]], count: int) -> tuple[int, int] | None:
    """Width and height of an organised cloud; None where it is a mere list of points."""
    width, height = (int((said.get(word) or ["0"])[0]) for word in ("WIDTH", "HEIGHT"))
    return (width, height) if min(width, height) > 1 and width * height == count else None


_STORAGES = ("ascii", "binary")


def _bad_header(path: Path) -> BadFile:
    return damaged(path, Text("The PCD header can't be read.", "PCDヘッダーを読み取れません。"))


def _ends_early(header: _Header, whole: int) -> BadFile:
    return damaged(
        header.path,
        Text(
            f"The file ends in the middle of point {whole + 1:,} of {header.count:,}.",
            f"{header.count:,}点のうち{whole + 1:,}点目の途中でファイルが終わっています。",
        ),
    )


def _make_compression_error(path: Path) -> BadFile:
    return BadFile(
        Text("Compressed PCD files can't be read.", "圧縮されたPCDファイルには対応していません。"),
        Text.same(str(path)),
        Text(
            "Save it as binary PCD, PLY or LAS. {unchanged}",
            "バイナリPCD、PLY、LASのいずれかで保存し直してください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )
