"""The lowest point of each cell: the published baseline, strict and with a tolerance."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.errors import OutOfRange
from processing.text import Text


def lowest_points(xyz: NDArray[np.float64], cell_m: float) -> NDArray[np.int64]:
    """Indices of the lowest point of each occupied cell, by cell; the first of equal ones.

    Parameters
    ----------
    xyz : (n, 3) float64
        m; rows that are not finite are passed over.

    References
    ----------
    Grid counted from the lowest easting and northing, so that large coordinates keep their digits.
    """
    finite = np.flatnonzero(np.isfinite(xyz).all(axis=1))
    if len(finite) == 0:
        return finite
    kept = xyz[finite]
    cells = np.floor((kept[:, :2] - kept[:, :2].min(axis=0)) / cell_m).astype(np.int64)
    order = np.lexsort((kept[:, 2], cells[:, 0], cells[:, 1]))
    changes = np.any(np.diff(cells[order], axis=0) != 0, axis=1)
    return finite[order[np.concatenate(([True], changes))]]


def lowest_point_ground(
    xyz: NDArray[np.float64], cell_m: float, tolerance_m: float = 0.0
) -> NDArray[np.bool_]:
    """Ground as each cell's lowest point, and what lies no more than ``tolerance_m`` above it.

    Parameters
    ----------
    tolerance_m : float
        0 keeps one point per cell, as the method is described; more keeps a band.

    Returns
    -------
    (n,) bool
    """
    is_ground = np.zeros(len(xyz), np.bool_)
    lowest = lowest_points(xyz, cell_m)
    is_ground[lowest] = True
    if tolerance_m <= 0.0 or len(lowest) == 0:
        return is_ground
    finite = np.flatnonzero(np.isfinite(xyz).all(axis=1))
    start = xyz[finite, :2].min(axis=0)
    cells = np.floor((xyz[finite, :2] - start) / cell_m).astype(np.int64)
    width = int(cells[:, 0].max()) + 1
    keys = cells[:, 1] * width + cells[:, 0]
    of_lowest = np.floor((xyz[lowest, :2] - start) / cell_m).astype(np.int64)
    place = np.searchsorted(of_lowest[:, 1] * width + of_lowest[:, 0], keys)
    is_ground[finite[xyz[finite, 2] <= xyz[lowest[place], 2] + tolerance_m]] = True
    return is_ground


def require_points(xyz: NDArray[np.float64], least: int) -> None:
    """Raise when there are too few points with finite coordinates.

    Raises
    ------
    OutOfRange
    """
    count = int(np.isfinite(xyz).all(axis=1).sum())
    if count < least:
        raise OutOfRange(
            Text(
                f"Ground needs at least {least} points at different places; there are {count}.",
                f"地面の抽出には位置の異なる{least}点以上が必要です（有効な点：{count}）。",
            ),
            Text("The whole cloud", "点群全体"),
            Text("Choose a cloud with more points.", "点数の多い点群を選んでください。"),
        )
