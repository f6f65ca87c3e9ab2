"""Points that were not delivered, written as LAS 1.4 or LAZ."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import laspy
import numpy as np
from laspy.header import GpsTimeType
from numpy.typing import NDArray
from pyproj import CRS

from processing.core.monitor import Monitor
from processing.core.safe_write import write_safely

_FORMAT = 6
_SCALE_M = 0.001

# Any: the columns differ in type. Places, columns that LAS has, extra dimensions.
Part = tuple[NDArray[np.float64], Mapping[str, NDArray[Any]], Mapping[str, NDArray[Any]]]


def write_new_points(
    path: Path,
    parts: Iterable[Part],
    crs: str,
    monitor: Monitor,
    *,
    never: Iterable[Path] = (),
    is_adjusted_standard: bool = True,
) -> int:
    """Write points of format 6, some at a time; says how many.

    Parameters
    ----------
    path : Path
        ``.las`` or ``.laz``.
    parts : iterable of (xyz, columns, extra)
        ``xyz`` (n, 3) float64, m; columns by the names that laspy gives LAS's own; extra dimensions
        by name, the same in each part.
    crs : str
        ``EPSG:n``, or empty.
    is_adjusted_standard : bool
        Whether times are GPS seconds less 1e9; else seconds of the week.

    Raises
    ------
    NoSpace, InUse, Cancelled
        Nothing is left behind.
    """
    count = 0
    with write_safely(path, never=never) as temporary:
        writer: laspy.LasWriter | None = None
        try:
            for xyz, columns, extra in parts:
                monitor.check()
                if writer is None:
                    header = _header(xyz, extra, crs, is_adjusted_standard=is_adjusted_standard)
                    writer = laspy.open(temporary, "w", header=header)
                writer.write_points(_records(writer.header, xyz, columns, extra))
                count += len(xyz)
            if writer is None:
                none = np.empty((0, 3))
                header = _header(none, {}, crs, is_adjusted_standard=is_adjusted_standard)
                writer = laspy.open(temporary, "w", header=header)
        finally:
            if writer is not None:
                writer.close()
    return count


def _header(
    xyz: NDArray[np.float64],
    extra: Mapping[str, NDArray[Any]],
    crs: str,
    *,
    is_adjusted_standard: bool,
) -> laspy.LasHeader:
    header = laspy.LasHeader(version="1.4", point_format=_FORMAT)
    header.scales = np.full(3, _SCALE_M)
    header.offsets = np.floor(xyz.mean(axis=0)) if len(xyz) else np.zeros(3)
    if is_adjusted_standard:
        header.global_encoding.gps_time_type = GpsTimeType.STANDARD
    for name, values in extra.items():
        header.add_extra_dim(laspy.ExtraBytesParams(name, values.dtype))
    if crs:
        header.add_crs(CRS(crs))
    header.generating_software = "Zuka"
    return header


def _records(
    header: laspy.LasHeader,
    xyz: NDArray[np.float64],
    columns: Mapping[str, NDArray[Any]],
    extra: Mapping[str, NDArray[Any]],
) -> laspy.ScaleAwarePointRecord:
    records = laspy.ScaleAwarePointRecord.zeros(len(xyz), header=header)
    records.x, records.y, records.z = xyz.T
    for name, values in {**columns, **extra}.items():
        records[name] = values
    return records
