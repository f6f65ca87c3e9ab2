"""The order in which a drive's points were measured, where it was kept in another one.

A cloud without revolutions is kept by cells of its top view; times, or else the order of the
delivered files, tell what was measured before what.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.recording.drive import Drive

_MOST_IN_A_FILE = 1 << 40
"""Keys of file and index in one number; no file has as many points."""


def delivered_order(drive: Drive) -> NDArray[np.int64]:
    """(n,) int64: the points of a drive as they were delivered, file after file.

    A drive that notes no file keeps its own order.

    Raises
    ------
    BadFile
        The columns that say where points were delivered are damaged.
    """
    if not drive.info.sources:
        return np.arange(drive.count)
    files, indices = drive.sources(0, drive.count)
    keys = files.astype(np.int64) * _MOST_IN_A_FILE + indices
    return np.asarray(np.argsort(keys, kind="stable"), np.int64)


def measured_times(drive: Drive) -> NDArray[np.float64] | None:
    """(n,) float64, s; None where points have none, or all the same."""
    times = np.asarray(drive.columns["time"], np.float64)
    if not times.size or not np.isfinite(times).all() or times.min() == times.max():
        return None
    return times


def measured_order(drive: Drive) -> NDArray[np.int64]:
    """(n,) int64: the points of a drive as they were measured, as far as is known.

    By time where there is one, and of points of one time, as returns of one pulse, as delivered.
    """
    order, times = delivered_order(drive), measured_times(drive)
    if times is None:
        return order
    own = times[order]
    if (np.diff(own) < 0).any():
        order = order[np.argsort(own, kind="stable")]
    return order
