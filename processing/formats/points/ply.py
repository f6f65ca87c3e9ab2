"""PLY: text and both binary orders, with the field names that laser programs give.

Read in blocks with every field; Open3D's readers hold the whole cloud in memory.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import BadFile, report_as_user_error
from processing.core.text import Text
from processing.formats.points.delivered.delivered_floats import ColumnBlock, FloatFile
from processing.formats.points.delivered.field_names import block_of, has_position
from processing.formats.points.las.las_header import damaged
from processing.formats.points.text.text_numbers import TextPart, number_blocks

_MAGIC = b"ply"
_LONGEST_HEADER = 1 << 16
_BLOCK_POINTS = 500_000
_TYPES = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4",
    "float": "f4", "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2",
    "int32": "i4", "uint32": "u4", "int64": "i8", "uint64": "u8", "float32": "f4",
    "float64": "f8",
}  # fmt: skip
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_OFFSET = re.compile(r"^comment\s+offset\s+pos\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)


@dataclass(frozen=True)
class _Element:
    name: str
    count: int
    fields: tuple[tuple[str, str], ...]
    has_list: bool


@dataclass(frozen=True)
class _Header:
    path: Path
    order: str
    elements: tuple[_Element, ...]
    offset: tuple[float, float, float]
    size: int

    @property
    def vertices(self) -> _Element:
        return next(element for element in self.elements if element.name == "vertex")


def open_ply(path: Path) -> FloatFile:
    """A PLY file's vertices; faces and other elements are passed over.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read; the header is damaged or contradicts the file's size.

    Notes
    -----
    The comment ``offset Pos X Y Z`` of the header is added to positions and origins.
    """
    header = _read_header(path)
    return FloatFile(path, "PLY", lambda: _blocks(header))


def _blocks(header: _Header) -> Iterator[ColumnBlock]:
    records = _text_records(header) if header.order == "" else _binary_records(header)
    for block in records:
        yield block_of(block, header.offset)


def _binary_records(header: _Header) -> Iterator[dict[str, NDArray[np.generic]]]:
    element = header.vertices
    dtype = np.dtype([(name, header.order + kind) for name, kind in element.fields])
    with report_as_user_error(header.path), header.path.open("rb") as file:
        file.seek(header.size + _bytes_before(header))
        for start in range(0, element.count, _BLOCK_POINTS):
            count = min(_BLOCK_POINTS, element.count - start)
            data = file.read(count * dtype.itemsize)
            if len(data) < count * dtype.itemsize:
                raise _ends_early(header, start + len(data) // dtype.itemsize)
            records = np.frombuffer(data, dtype)
            yield {name: records[name] for name, _ in element.fields}


def _text_records(header: _Header) -> Iterator[dict[str, NDArray[np.generic]]]:
    element = header.vertices
    names = [name for name, _ in element.fields]
    before = sum(other.count for other in _elements_before(header))
    part = TextPart(header.path, header.size, before, element.count)
    done = 0
    for numbers in number_blocks(part, len(names)):
        done += numbers.shape[0]
        yield {name: numbers[:, i] for i, name in enumerate(names)}
    if done < element.count:
        raise _ends_early(header, done)


def _elements_before(header: _Header) -> list[_Element]:
    return list(takewhile(lambda element: element.name != "vertex", header.elements))


def _bytes_before(header: _Header) -> int:
    size = 0
    for element in _elements_before(header):
        if element.has_list and element.count:
            raise _bad_header(header.path, "lists before the vertices", "頂点より前のリスト")
        size += element.count * sum(np.dtype(kind).itemsize for _, kind in element.fields)
    return size


def _read_header(path: Path) -> _Header:
    with report_as_user_error(path), path.open("rb") as file:
        start = file.read(_LONGEST_HEADER)
        file_size = path.stat().st_size
    end = re.search(rb"end_header[ \t]*(\r\n|\n|\r)", start)
    if not start.startswith(_MAGIC) or end is None:
        raise _bad_header(path, "no end_header", "end_headerがない")
    order: str | None = None
    offset = (0.0, 0.0, 0.0)
    elements: list[_Element] = []
    for line in start[: end.start()].decode("utf-8", "replace").splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] == "format" and len(words) > 1:
            order = _ORDERS.get(words[1])
        elif found := _OFFSET.match(line):
            offset = _read_offset(path, found)
        elif words[0] == "element":
            elements.append(_read_element(path, words))
        elif words[0] == "property":
            elements[-1:] = [_with_property(path, elements, words)]
    header = _Header(path, order or "", tuple(elements), offset, end.end())
    if order is None or not any(element.name == "vertex" for element in elements):
        raise _bad_header(path, "no known format or no vertices", "formatまたはvertexがない")
    _check_size(header, file_size)
    return header


def _read_offset(path: Path, found: re.Match[str]) -> tuple[float, float, float]:
    try:
        x, y, z = (float(word) for word in found.groups())
    except ValueError:
        raise _bad_header(path, "offset", "offset") from None
    if not np.isfinite([x, y, z]).all():
        raise _bad_header(path, "offset", "offset")
    return (x, y, z)


def _read_element(path: Path, words: list[str]) -> _Element:
    if len(words) != 3 or not words[2].isascii() or not words[2].isdigit() or len(words[2]) > 15:
        raise _bad_header(path, "element", "element")
    return _Element(words[1], int(words[2]), (), has_list=False)


def _with_property(path: Path, elements: list[_Element], words: list[str]) -> _Element:
    """The last element with one more property."""
    if not elements or len(words) < 3:
        raise _bad_header(path, "property", "property")
    last = elements[-1]
    if words[1] == "list":
        return _Element(last.name, last.count, last.fields, has_list=True)
    kind, name = _TYPES.get(words[1]), words[2].lower()
    if kind is None or any(name == other for other, _ in last.fields):
        raise _bad_header(path, f"property {name[:40]}", f"property {name[:40]}")
    return _Element(last.name, last.count, (*last.fields, (name, kind)), last.has_list)


def _check_size(header: _Header, file_size: int) -> None:
    """Held against the file, a count can't make anything be allocated."""
    element = header.vertices
    if element.has_list or not has_position(tuple(name for name, _ in element.fields)):
        raise _bad_header(header.path, "the properties of vertex", "vertexのproperty")
    left = file_size - header.size
    if header.order == "":
        least = 2 * len(element.fields)
    else:
        left -= _bytes_before(header)
        least = sum(np.dtype(kind).itemsize for _, kind in element.fields)
    # The last line of a text file may lack its end.
    if element.count * least > left + 1:
        raise _ends_early(header, max(left, 0) // least)


def _ends_early(header: _Header, whole: int) -> BadFile:
    count = header.vertices.count
    return damaged(
        header.path,
        Text(
            f"The file ends in the middle of point {whole + 1:,} of {count:,}.",
            f"{count:,}点のうち{whole + 1:,}点目の途中でファイルが終わっています。",
        ),
    )


def _bad_header(path: Path, en: str, ja: str) -> BadFile:
    return damaged(
        path,
        Text(f"The PLY header can't be read ({en}).", f"PLYヘッダーを読み取れません（{ja}）。"),
    )
