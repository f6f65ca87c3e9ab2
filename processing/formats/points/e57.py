"""E57 (ASTM E2807): the scans of a terrestrial scanner, each moved to where it stood."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import UNCHANGED, BadFile, report_as_user_error
from processing.core.text import Text
from processing.formats.points.delivered.delivered_floats import ColumnBlock, FloatFile
from processing.formats.points.las.las_header import damaged

if TYPE_CHECKING:
    from pye57 import E57, ScanHeader

_BLOCK_POINTS = 500_000
_MOST_POINTS_A_BYTE = 8
_CARTESIAN = ("cartesianX", "cartesianY", "cartesianZ")
_SPHERICAL = ("sphericalRange", "sphericalAzimuth", "sphericalElevation")
_INVALID = ("cartesianInvalidState", "sphericalInvalidState")
_COLOR = ("colorRed", "colorGreen", "colorBlue")
_INTENSITY = "intensity"
_COLUMN, _ROW = "columnIndex", "rowIndex"
_RETURN, _RETURNS = "returnIndex", "returnCount"
_SWEEP_NAMED = "pointGroupingSchemes/groupingByLine/idElementName"
_LARGEST_INDEX = 2**31 - 1
_BAD_CHECKSUM = Text("a checksum is wrong", "チェックサムが一致しません")
_EIGHT_BITS = 255.0
_FULL = 65535.0


def open_e57(path: Path) -> FloatFile:
    """The points of all scans of an E57 file, poses applied, with their cells of the scan's grid.

    Points that the scanner marked invalid are left out. Where only some scans have intensities
    or colours, the others' are 0. A sweep of the grid is what the file groups points by; where it
    doesn't say, a column.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read; a checksum or a section of it is damaged.
    """
    with report_as_user_error(path), path.open("rb"):
        return FloatFile(path, "E57", lambda: _blocks(path))


def _blocks(path: Path) -> Iterator[ColumnBlock]:
    import pye57

    with _damage_told(path):
        file = pye57.E57(str(path))
    try:
        with _damage_told(path):
            scans = [file.get_header(i) for i in range(file.scan_count)]
        known = {field for scan in scans for field in scan.point_fields}
        for number, scan in enumerate(scans):
            yield from _scan_blocks(path, file, scan, number, known)
    finally:
        file.close()


def _scan_blocks(
    path: Path, file: E57, scan: ScanHeader, number: int, known: set[str]
) -> Iterator[ColumnBlock]:
    with _damage_told(path):
        position = next(
            (p for p in (_CARTESIAN, _SPHERICAL) if set(p) <= set(scan.point_fields)), ()
        )
        if not position or scan.point_count > _MOST_POINTS_A_BYTE * path.stat().st_size:
            raise _bad_scan(path, number)
        wanted = (*position, *_INVALID, _INTENSITY, *_COLOR, _COLUMN, _ROW, _RETURN, _RETURNS)
        fields = [field for field in wanted if field in scan.point_fields]
        data, buffers = _buffers(file, fields, min(_BLOCK_POINTS, max(scan.point_count, 1)))
        turn, shift = scan.rotation_matrix, scan.translation
        facts = _ScanFacts(number + 1, known, _brightest(scan), _grid_fields(scan))
        reader = scan.points.reader(buffers)
    while True:
        with _damage_told(path):
            count = reader.read()
        if not count:
            return
        values = {name: column[:count] for name, column in data.items()}
        valid = np.ones(count, dtype=np.bool_)
        for name in _INVALID:
            if name in values:
                valid &= values[name] == 0
        block = _block({name: v[valid] for name, v in values.items()}, facts)
        # Not @: on some builds of the linear algebra library it warns about unused lanes.
        block["xyz"] = np.einsum("ij,nj->ni", turn, block["xyz"].astype(np.float64)) + shift
        block["scanner_position"] = np.broadcast_to(
            np.asarray(shift, dtype=np.float64), block["xyz"].shape
        )
        yield block


@dataclass(frozen=True)
class _ScanFacts:
    """A scan's number in the file, what any scan has, its highest colour, and its grid's fields."""

    number: int
    known: set[str]
    brightest: float
    grid_fields: tuple[str, str] | None


def _grid_fields(scan: ScanHeader) -> tuple[str, str] | None:
    """The indices of a point's sweep and of its place in it; None where a scan lacks them."""
    if not {_COLUMN, _ROW} <= set(scan.point_fields):
        return None
    named = scan.node[_SWEEP_NAMED].value() if scan.node.isDefined(_SWEEP_NAMED) else _COLUMN
    return (_ROW, _COLUMN) if named == _ROW else (_COLUMN, _ROW)


def _buffers(
    file: E57, fields: list[str], capacity: int
) -> tuple[dict[str, NDArray[np.float64]], Any]:
    """Arrays that the reader fills, and what it wants to know of them (a C++ vector: Any)."""
    from pye57 import libe57

    buffers = libe57.VectorSourceDestBuffer()
    data = {field: np.zeros(capacity) for field in fields}
    for field, values in data.items():
        buffers.append(
            libe57.SourceDestBuffer(file.image_file, field, values, capacity, True, True)  # noqa: FBT003 - C++ takes no names
        )
    return data, buffers


def _block(values: dict[str, NDArray[np.float64]], facts: _ScanFacts) -> ColumnBlock:
    if _CARTESIAN[0] in values:
        xyz = np.column_stack([values[name] for name in _CARTESIAN])
    else:
        distance, azimuth, elevation = (values[name] for name in _SPHERICAL)
        level = distance * np.cos(elevation)
        xyz = np.column_stack(
            [level * np.cos(azimuth), level * np.sin(azimuth), distance * np.sin(elevation)]
        )
    known, count = facts.known, xyz.shape[0]
    block: ColumnBlock = {"xyz": xyz, "scan": np.full(count, facts.number)}
    nothing = np.zeros(count)
    if _INTENSITY in known:
        block["intensity"] = values.get(_INTENSITY, nothing)
    if set(_COLOR) <= known:
        channels = np.column_stack([values.get(name, nothing) for name in _COLOR])
        color = np.nan_to_num(channels * (_FULL / facts.brightest))
        block["color"] = np.clip(np.rint(color), 0, _FULL).astype(np.uint16)
    if {_RETURN, _RETURNS} <= known:
        block["return_number"] = values.get(_RETURN, nothing) + 1
        block["number_of_returns"] = np.maximum(values.get(_RETURNS, nothing), 1)
    if {_COLUMN, _ROW} <= known:
        block["grid"] = np.full((count, 2), -1)
    if facts.grid_fields is not None:
        indices = np.column_stack([values[name] for name in facts.grid_fields])
        is_index = (indices >= 0) & (indices <= _LARGEST_INDEX)
        block["grid"] = np.where(is_index, indices, -1).astype(np.int64)
    return block


def _brightest(scan: ScanHeader) -> float:
    """The highest value of a colour, 255 where the file doesn't say."""
    node = scan.node
    if not node.isDefined("colorLimits/colorRedMaximum"):
        return _EIGHT_BITS
    limit = node["colorLimits"]["colorRedMaximum"]
    value = float(limit.value()) if hasattr(limit, "value") else _EIGHT_BITS
    return value if value > 0 else _EIGHT_BITS


@contextmanager
def _damage_told(path: Path) -> Iterator[None]:
    from pye57 import libe57

    try:
        with report_as_user_error(path):
            yield
    except libe57.E57Exception as error:
        # "checksum mismatch, file is corrupted (ErrorBadChecksum)", then pages of debugging.
        reason = str(error).split("\n", 1)[0].strip()
        known = _BAD_CHECKSUM if "ErrorBadChecksum" in reason else Text.same(reason)
        raise damaged(
            path,
            Text("The E57 file is damaged: {why}.", "E57ファイルが壊れています（{why}）。").filled(
                why=known
            ),
        ) from error


def _bad_scan(path: Path, number: int) -> BadFile:
    return BadFile(
        Text(
            "A scan has no coordinates, or more points than the file can hold.",
            "スキャンに座標がないか、点数がファイルの大きさに合いません。",
        ),
        Text(f"{path}, scan {number + 1}", f"{path}、スキャン{number + 1}"),
        Text(
            "Export the file again from the scanner's program. {unchanged}",
            "スキャナのソフトからもう一度書き出してください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )
