"""Point records of LAS as bytes: from the old formats to the new ones, and extra dimensions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import OutOfRange
from processing.core.text import Text
from processing.formats.points.delivered.point_chunk import PointChunk
from processing.formats.points.las.las_header import RECORD_SIZES

PROMOTED = {0: 6, 1: 6, 2: 7, 3: 7, 4: 9, 5: 10}
"""The format of LAS 1.4 that takes all that an older one holds, and 8 bits of class."""

HIGHEST_OLD_CLASS = 31
_ANGLE_STEP_DEG = 0.006
_TIME_FORMATS = frozenset({1, 3, 4, 5})
COLORED = {0: 2, 1: 3, 4: 5, 6: 7, 9: 10}
"""The format that holds the same and a colour."""

_COLOR_AT = {2: 20, 3: 28, 5: 28, 7: 30, 8: 30, 10: 30}
_WAVE_AT = {4: (28, 30), 5: (34, 38)}
_WAVE_SIZE = 29

_ENTRY = np.dtype(
    [
        ("reserved", "<u2"),
        ("type", "u1"),
        ("options", "u1"),
        ("name", "S32"),
        ("unused", "<u4"),
        ("values", "<u8", (15,)),
        ("description", "S32"),
    ]
)
_TYPES = ("u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f4", "f8")
_UNDOCUMENTED_MOST = 255
_NAME_BYTES = 32


@dataclass(frozen=True)
class ExtraDimension:
    """One value more for each point.

    Attributes
    ----------
    at : int
        Byte behind the standard part of the record.
    dtype : str
        As numpy writes it; empty for bytes that nobody described.
    """

    name: str
    at: int
    size: int
    dtype: str


def promote_records(records: NDArray[np.uint8], point_format: int) -> NDArray[np.uint8]:
    """Records of formats 0 to 5 as records of the format in :data:`PROMOTED`.

    Parameters
    ----------
    records : (n, size) uint8
        Extra bytes may follow the standard part; they are kept.

    Returns
    -------
    (n, new size) uint8
        A copy. Scan angles of whole degrees become multiples of 0.006 degrees.
    """
    target = PROMOTED[point_format]
    old_size, new_size = RECORD_SIZES[point_format], RECORD_SIZES[target]
    extra = records.shape[1] - old_size
    new = np.zeros((records.shape[0], new_size + extra), dtype=np.uint8)
    returns, classes = records[:, 14], records[:, 15]
    new[:, :14] = records[:, :14]
    new[:, 14] = (returns & 7) | ((returns >> 3) & 7) << 4
    new[:, 15] = (classes >> 5) | (returns & 0xC0)
    new[:, 16] = classes & HIGHEST_OLD_CLASS
    new[:, 17] = records[:, 17]
    angle = np.rint(records[:, 16].view(np.int8) / _ANGLE_STEP_DEG).astype("<i2")
    new[:, 18:20] = angle.view(np.uint8).reshape(-1, 2)
    new[:, 20:22] = records[:, 18:20]
    if point_format in _TIME_FORMATS:
        new[:, 22:30] = records[:, 20:28]
    if point_format in _COLOR_AT:
        start = _COLOR_AT[point_format]
        new[:, 30:36] = records[:, start : start + 6]
    if point_format in _WAVE_AT:
        old, wave = _WAVE_AT[point_format]
        new[:, wave : wave + _WAVE_SIZE] = records[:, old : old + _WAVE_SIZE]
    if extra:
        new[:, new_size:] = records[:, old_size:]
    return new


def set_classes(
    records: NDArray[np.uint8], point_format: int, classes: NDArray[np.uint8]
) -> NDArray[np.uint8]:
    """The records, changed in place, with these (n,) classes and all flags as they were."""
    if point_format >= 6:
        records[:, 16] = classes
    else:
        records[:, 15] = (records[:, 15] & np.uint8(0xE0)) | classes
    return records


def positions_in(records: NDArray[np.uint8]) -> NDArray[np.int32]:
    """The integers of the coordinates of records: (n, 3) int32, a copy."""
    return np.ascontiguousarray(records[:, :12]).view("<i4")


def move_records(records: NDArray[np.uint8], steps: NDArray[np.float64]) -> NDArray[np.uint8]:
    """The records, changed in place, moved by whole steps of their integers, (n, 3).

    Raises
    ------
    OutOfRange
        A file with this scale and offset can't hold the moved points.
    """
    moved, held = positions_in(records) + steps, np.iinfo(np.int32)
    if not ((moved >= held.min) & (moved <= held.max)).all():
        raise OutOfRange(
            Text(
                "Corrected points lie where the delivered file's scale and offset don't reach.",
                "補正後の点が納品ファイルのスケールとオフセットで表せる範囲を超えています。",
            ),
            Text.same(f"{np.nanmax(np.abs(steps)):g}"),
            Text("Check the correction of the drive.", "走行データの補正を確認してください。"),
        )
    records[:, :12] = np.ascontiguousarray(moved.astype("<i4")).view(np.uint8)
    return records


def add_color_fields(records: NDArray[np.uint8], point_format: int) -> NDArray[np.uint8]:
    """Records of a format without colour as records of its sister in :data:`COLORED`, black."""
    room = RECORD_SIZES[COLORED[point_format]] - RECORD_SIZES[point_format]
    at = _COLOR_AT[COLORED[point_format]]
    black = np.zeros((records.shape[0], room), np.uint8)
    return np.concatenate([records[:, :at], black, records[:, at:]], axis=1)


def set_colors(
    records: NDArray[np.uint8], point_format: int, colors: NDArray[np.uint16]
) -> NDArray[np.uint8]:
    """The records, changed in place, with these (n, 3) red, green, blue."""
    at = _COLOR_AT[point_format]
    own = np.ascontiguousarray(colors, dtype="<u2").view(np.uint8).reshape(-1, 6)
    records[:, at : at + 6] = own
    return records


def records_of(chunk: PointChunk, point_format: int) -> NDArray[np.uint8]:
    """Records of format 6, 7 or 9 for points of a file that is not LAS; without their waveforms."""
    columns = chunk.columns
    records = np.zeros((chunk.count, RECORD_SIZES[point_format]), dtype=np.uint8)
    # The format has four bits for each.
    returns = np.minimum(columns["return_number"], 15)
    of_pulse = np.minimum(columns["number_of_returns"], 15)
    fields = {
        0: columns["xyz"].astype("<i4"),
        12: columns["intensity"].astype("<u2"),
        14: (returns | (of_pulse << 4)).astype(np.uint8),
        16: columns["classification"],
        17: columns["user_data"],
        20: columns["scanner"].astype("<u2"),
    }
    if "scan_angle_deg" in columns:
        angle = np.clip(np.rint(columns["scan_angle_deg"] / _ANGLE_STEP_DEG), -30000, 30000)
        fields[18] = np.nan_to_num(angle).astype("<i2")
    if "time" in columns:
        fields[22] = columns["time"].astype("<f8")
    if "color" in columns and point_format == 7:
        fields[30] = columns["color"].astype("<u2")
    for byte, values in fields.items():
        own = np.ascontiguousarray(values).view(np.uint8).reshape(chunk.count, -1)
        records[:, byte : byte + own.shape[1]] = own
    return records


def extra_dimensions(described: bytes, size: int) -> tuple[ExtraDimension, ...]:
    """What the extra bytes of a record are.

    Parameters
    ----------
    described : bytes
        Content of the extra bytes record; empty without.
    size : int
        Extra bytes that the record has; what is not described comes last, without a name.
    """
    found = []
    at = 0
    for entry in np.frombuffer(described[: len(described) // 192 * 192], _ENTRY):
        kind = int(entry["type"])
        plain = 1 <= kind <= len(_TYPES)
        dtype = _TYPES[kind - 1] if plain else ""
        # Types 11 to 30 are two or three values of a plain type, no longer in the standard.
        width = int(entry["options"]) if kind == 0 else 1 + (kind - 1) // len(_TYPES)
        each = 1 if kind == 0 else np.dtype(_TYPES[(kind - 1) % len(_TYPES)]).itemsize
        if at + width * each > size:
            break
        name = bytes(entry["name"]).decode("utf-8", "replace").strip()
        found.append(ExtraDimension(name, at, width * each, dtype))
        at += width * each
    if at < size:
        found.append(ExtraDimension("", at, size - at, ""))
    return tuple(found)


def description_of(dimension: ExtraDimension) -> bytes:
    """The 192-byte entries that describe a dimension: one, or several for undescribed bytes."""
    entries = bytearray()
    left = dimension.size
    while left:
        entry = np.zeros(1, _ENTRY)
        if dimension.dtype:
            entry["type"] = 1 + _TYPES.index(dimension.dtype)
            entry["name"] = dimension.name.encode("utf-8")[:_NAME_BYTES]
            left = 0
        else:
            part = min(left, _UNDOCUMENTED_MOST)
            entry["options"] = part
            entry["name"] = f"undocumented_{dimension.at + dimension.size - left}".encode()
            left -= part
        entries += entry.tobytes()
    return bytes(entries)
