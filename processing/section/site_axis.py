"""The line that sections of a site stand on where nobody drove: its longer middle line."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from processing.core.arrays import Floats
from processing.core.errors import UserError
from processing.section.stations import Stations

if TYPE_CHECKING:  # processing.recording.drive makes images, so importing it here would be a circle
    from processing.recording.drive import Drive


_PIECES, _PIECE_POINTS = 64, 256
"""Of a drive that is sampled: some 16,000 points, by judgement enough for a middle line."""

_ENDS_PERCENT = 0.5, 99.5
"""What lies outside in any direction may be noise, however far off."""

_BESIDE_M = 2.0
"""Beyond the outermost points, so that the edge is seen as one; by judgement."""

_LEAST_HALF_M, _MOST_HALF_M = 15.0, 150.0
"""Of a section: that of a street's, and what can still be read on a screen. By judgement."""


@dataclass(frozen=True)
class SiteAxis:
    """A straight line through the middle of what was measured, along its longer side.

    Attributes
    ----------
    stations : Stations
        At about the height of the highest points.
    half_length_m : float
        So far a section across it reaches to either side.
    """

    stations: Stations
    half_length_m: float


def site_axis(drives: Iterable[Drive]) -> SiteAxis | None:
    """The axis of all drives together; None where they have no extent in plan.

    Taken from some thousand points from all over each drive, so it costs the same whatever their
    number.

    Raises
    ------
    BadFile
        A drive is damaged.
    """
    samples = [_sample(drive) for drive in drives if drive.count]
    xyz = np.concatenate([np.empty((0, 3)), *samples])
    if not len(xyz):
        return None
    middle = np.median(xyz, axis=0)
    low, high = np.percentile(xyz, _ENDS_PERCENT, axis=0)
    inside = ((xyz >= low) & (xyz <= high)).all(axis=1)
    local = (xyz[inside] if inside.any() else xyz)[:, :2] - middle[:2]
    _, directions = np.linalg.eigh(local.T @ local)
    along = directions[:, -1]
    # East or north first, so that the same site is always gone through alike.
    along = along * (1.0 if along[np.abs(along).argmax()] > 0 else -1.0)
    lengths = np.percentile(local @ along, _ENDS_PERCENT)
    aside = np.percentile(local @ np.array([-along[1], along[0]]), _ENDS_PERCENT)
    normal = np.array([-along[1], along[0]]) * aside.mean()
    ends = middle[:2] + normal + lengths[:, None] * along
    try:
        stations = Stations(np.column_stack([ends, [high[2], high[2]]]))
    except UserError:  # all points lie at one position
        return None
    half_m = float(np.ptp(aside)) / 2 + _BESIDE_M
    return SiteAxis(stations, min(max(half_m, _LEAST_HALF_M), _MOST_HALF_M))


def _sample(drive: Drive) -> Floats:
    """(n, 3) m: pieces of consecutive points from all over a drive."""
    last = max(0, drive.count - _PIECE_POINTS)
    starts = np.unique(np.linspace(0, last, _PIECES).astype(np.int64)).tolist()
    pieces = [drive.xyz(slice(start, min(start + _PIECE_POINTS, drive.count))) for start in starts]
    return np.concatenate(pieces)
