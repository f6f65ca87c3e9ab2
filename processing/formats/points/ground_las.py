"""The ground points of an epoch as LAS or LAZ, for whoever computes with them elsewhere."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from pyproj import CRS
from pyproj.exceptions import CRSError

from processing.core.monitor import Monitor
from processing.core.safe_write import write_safely
from processing.formats.format import Content
from processing.formats.registry import FORMATS
from processing.methods.earthwork.surfaces.sides import EpochGround

if TYPE_CHECKING:  # imported where it is used: it takes its time
    import laspy

_GROUND = 2
_SCALE_M = 0.001


def write_ground_las(
    path: Path, ground: EpochGround, monitor: Monitor, *, never: Iterable[Path] = ()
) -> int:
    """Write the ground points of an epoch, in its order, to whole millimetres.

    Parameters
    ----------
    path : Path
        ``.las`` or ``.laz``.
    never : iterable of Path
        Files that must not be overwritten.

    Returns
    -------
    int
        How many there are.

    Raises
    ------
    OutOfRange
        The ending says another format.
    UserError
        What :func:`processing.core.safe_write.write_safely` raises; `Cancelled`.

    References
    ----------
    ASPRS, LAS 1.4 R15: point format 6, class 2 (ground); the station is the point source id.
    """
    import laspy

    is_compressed = FORMATS.format_to_write(path, Content.POINTS).id == "laz"
    count = 0
    with (
        write_safely(path, never=never) as temporary,
        laspy.open(
            temporary, mode="w", header=_header_of(ground), do_compress=is_compressed
        ) as writer,
    ):
        for block in ground.blocks():
            monitor.check()
            if not len(block.xyz):
                continue
            points = laspy.ScaleAwarePointRecord.zeros(len(block.xyz), header=writer.header)
            points.x, points.y, points.z = block.xyz.T
            points.classification[:] = _GROUND
            points.return_number[:] = 1
            points.number_of_returns[:] = 1
            points.point_source_id[:] = block.station + 1
            writer.write_points(points)
            count += len(block.xyz)
    return count


def _header_of(ground: EpochGround) -> laspy.LasHeader:
    import laspy

    header = laspy.LasHeader(version="1.4", point_format=6)
    header.scales = np.full(3, _SCALE_M)
    header.offsets = np.floor(ground.low)
    header.generating_software = "zuka"
    if ground.crs:
        try:
            header.add_crs(CRS.from_user_input(ground.crs))
        except CRSError:  # a name that nobody knows helps no reader
            return header
    return header
