"""What the fields of PLY, PCD and text files are, by the many names that programs give them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from processing.formats.delivered_floats import Block

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
    "classification": ("classification", "class"),
    "scan_angle_deg": ("scanangledeg", "scanangle", "scananglerank"),
}
_EIGHT_TO_SIXTEEN_BITS = 257


def has_position(names: tuple[str, ...]) -> bool:
    """Whether fields of these names give x, y and z."""
    known = {_plain(name) for name in names}
    return all(any(name in known for name in axis) for axis in _POSITION)


# A damaged file may hold signalling NaNs, at which any cast would warn.
@np.errstate(invalid="ignore")
def block_of(
    fields: Mapping[str, NDArray[np.generic]], offset: tuple[float, float, float] = (0, 0, 0)
) -> Block:
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
        As :class:`processing.formats.delivered_floats.FloatFile` says. ``theta`` (rad) is the
        scan angle where no other is. Colours of 8 bits become 16 bits, those of 0 to 1 too.
    """
    named = {_plain(name): values for name, values in fields.items()}
    shift = np.array(offset)
    position = _together(named, _POSITION)
    if position is None:
        message = f"no x, y, z among {list(fields)}"
        raise ValueError(message)
    block: Block = {"xyz": np.column_stack(position).astype(np.float64) + shift}
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
    return block


def _together(
    named: Mapping[str, NDArray[np.generic]], names: tuple[tuple[str, ...], ...]
) -> list[NDArray[np.generic]] | None:
    found = [next((named[name] for name in axis if name in named), None) for axis in names]
    values = [axis for axis in found if axis is not None]
    return values if len(values) == len(names) else None


def _plain(name: str) -> str:
    """CloudCompare writes ``scalar_GpsTime``, others ``gps_time`` or ``GPS time``; one form."""
    return name.lower().removeprefix("scalar_").replace("_", "").replace(" ", "").strip('"/#')


def _sixteen_bits(channel: NDArray[np.generic]) -> NDArray[np.uint16]:
    numbers = np.nan_to_num(channel.astype(np.float64))
    if channel.dtype == np.uint16:
        factor = 1.0
    elif channel.dtype == np.float32:
        factor = 65535.0
    else:
        is_eight_bits = numbers.size == 0 or numbers.max() < 256
        factor = float(_EIGHT_TO_SIXTEEN_BITS) if is_eight_bits else 1.0
    return np.clip(np.rint(numbers * factor), 0, 65535).astype(np.uint16)
