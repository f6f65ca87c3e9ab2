"""What the fields of PLY, PCD and text files are, by the many names that programs give them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from processing.formats.points.delivered.delivered_floats import ColumnBlock

_POSITION = (
    ("x", "easting", "eastingm", "east"),
    ("y", "northing", "northingm", "north"),
    ("z", "height", "heightm", "elevation"),
)
_ORIGIN = (("xorigin",), ("yorigin",), ("zorigin",))
_COLOR = (("red", "r", "diffusered"), ("green", "g", "diffusegreen"), ("blue", "b", "diffuseblue"))
_SINGLE = {
    "time": ("gpstime", "time", "times", "timestamp"),
    "intensity": ("intensity", "reflectance", "amplitude", "i"),
    "return_number": ("returnnumber", "numecho"),
    "number_of_returns": ("numberofreturns", "nbofecho"),
    "classification": ("classification", "class", "semclass"),
    "scan_angle_deg": ("scanangledeg", "scanangle", "scananglerank"),
}
GRID_NAMES = (("columnindex", "column", "col"), ("rowindex", "row"))
"""A structured scan's column, which is taken as a sweep, and row: plain names."""

_ALL = (*_POSITION, *_ORIGIN, *_COLOR, *_SINGLE.values(), *GRID_NAMES, ("theta",))
FIELD_NAMES = {names[0]: names for names in _ALL}
"""The plain names of each field that :func:`block_of` knows, by the first of them."""

_EIGHT_TO_SIXTEEN_BITS = 257
_FULL = 65535.0


def has_position(names: tuple[str, ...]) -> bool:
    """Whether fields of these names give x, y and z."""
    known = {plain_name(name) for name in names}
    return all(any(name in known for name in axis) for axis in _POSITION)


# A damaged file may hold signalling NaNs, at which any cast would warn.
@np.errstate(invalid="ignore")
def block_of(
    fields: Mapping[str, NDArray[np.generic]], offset: tuple[float, float, float] = (0, 0, 0)
) -> ColumnBlock:
    """Columns of points out of named fields.

    Parameters
    ----------
    fields : mapping
        Name to (n,) numbers; x, y and z among them (:func:`has_position`).
    offset : tuple of float
        To be added to positions and origins, m.

    Returns
    -------
    Block
        As :class:`processing.formats.points.delivered.delivered_floats.FloatFile` says.
        ``theta`` (rad) is the scan angle where no other is. Colours of 8 bits become 16 bits,
        those of 0 to 1 too. A column of a scan's grid is a sweep.
    """
    named = {plain_name(name): values for name, values in fields.items()}
    shift = np.array(offset)
    position = _together(named, _POSITION)
    if position is None:
        message = f"no x, y, z among {list(fields)}"
        raise ValueError(message)
    block: ColumnBlock = {"xyz": np.column_stack(position).astype(np.float64) + shift}
    for column, names in _SINGLE.items():
        values = next((named[name] for name in names if name in named), None)
        if values is not None:
            block[column] = values
    if "scan_angle_deg" not in block and "theta" in named:
        block["scan_angle_deg"] = np.degrees(named["theta"].astype(np.float64))
    color = _together(named, _COLOR)
    if color is not None:
        block["color"] = np.column_stack([_sixteen_bits(channel) for channel in color])
    origin = _together(named, _ORIGIN)
    if origin is not None:
        block["origin"] = np.column_stack(origin).astype(np.float64) + shift
    grid = _together(named, GRID_NAMES)
    if grid is not None:
        block["grid"] = np.column_stack([whole_numbers(values) for values in grid])
    return block


def _together(
    named: Mapping[str, NDArray[np.generic]], names: tuple[tuple[str, ...], ...]
) -> list[NDArray[np.generic]] | None:
    found = [next((named[name] for name in axis if name in named), None) for axis in names]
    values = [axis for axis in found if axis is not None]
    return values if len(values) == len(names) else None


def plain_name(name: str) -> str:
    """CloudCompare writes ``scalar_GpsTime``, others ``gps_time`` or ``GPS time``; one form."""
    return name.lower().removeprefix("scalar_").replace("_", "").replace(" ", "").strip('"/#')


def whole_numbers(values: NDArray[np.generic]) -> NDArray[np.int64]:
    """Indices: (n,) int64 below 2³¹, −1 for what can't be one."""
    numbers = values.astype(np.float64)
    is_whole = (numbers >= 0) & (numbers < 2**31) & (numbers == np.floor(numbers))
    return np.where(is_whole, numbers, -1).astype(np.int64)


def _sixteen_bits(channel: NDArray[np.generic]) -> NDArray[np.uint16]:
    numbers = np.nan_to_num(channel.astype(np.float64))
    highest = float(numbers.max(initial=0.0))
    is_share = channel.dtype.kind == "f" and highest <= 1.0
    if channel.dtype == np.uint16:
        factor = 1.0
    elif is_share and (channel.dtype == np.float32 or (numbers != np.rint(numbers)).any()):
        factor = _FULL
    else:
        factor = float(_EIGHT_TO_SIXTEEN_BITS) if highest < 256 else 1.0
    return np.clip(np.rint(numbers * factor), 0, _FULL).astype(np.uint16)
