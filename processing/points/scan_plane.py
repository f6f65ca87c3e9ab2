"""The plane in which a line scanner's beams turn, and the angle of a point in it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_ROUNDS = 8
_UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class ScanPlane:
    """A plane with axes.

    Attributes
    ----------
    axes : (2, 3) float64
        Unit vectors in the plane; the first points as far down as the plane allows.
    normal : (3,) float64
        The spin axis.
    flatness : float
        Median distance of points from the plane, as a share of their median distance from each
        other's middle.
    knows_down : bool
        False for a plane so level that no direction in it is down.
    """

    axes: Floats
    normal: Floats
    flatness: float
    knows_down: bool

    def project(self, places: Floats) -> Floats:
        """(n, 3) to (n, 2) coordinates in the plane, m."""
        flat: Floats = places @ self.axes.T
        return flat


def find_plane(places: Floats, along: Floats, *, through_origin: bool = False) -> ScanPlane:
    """The plane of points that may move steadily along its normal.

    Parameters
    ----------
    places : (n, 3) float64
    along : (n, k) float64
        What the plane may shift with, one column each: time, or membership of a window; it must
        hold the constant unless ``through_origin``.
    through_origin : bool
        The plane does not shift.

    Notes
    -----
    Least squares with points weighted by 1 / distance², so that far ones don't rule, trimmed and
    repeated.
    """
    spread = places - np.median(places, axis=0)
    if through_origin:
        spread = places
    distance = np.maximum(np.linalg.norm(spread, axis=1), 0.5)
    weight = 1.0 / distance**2
    normal = _UP
    miss = np.zeros(distance.size)
    for _ in range(_ROUNDS):
        centred = places
        if not through_origin:
            normal_matrix = (along * weight[:, None]).T @ along
            trend = np.linalg.lstsq(normal_matrix, (along * weight[:, None]).T @ places)[0]
            centred = places - along @ trend
        moments = (centred * weight[:, None]).T @ centred
        normal = np.linalg.eigh(moments)[1][:, 0]
        miss = np.abs(centred @ normal)
        limit = max(3.0 * float(np.median(miss)), 1e-3)
        weight = np.where(miss < limit, 1.0, (limit / np.maximum(miss, 1e-12)) ** 2) / distance**2
    normal = normal if normal[np.argmax(np.abs(normal))] > 0 else -normal
    down = -_UP + normal * normal[2]
    steep = float(np.linalg.norm(down))
    knows_down = steep > 0.3
    if not knows_down:
        down = np.cross(normal, [0.0, 1.0, 0.0])
        steep = float(np.linalg.norm(down))
    first = down / steep
    return ScanPlane(
        axes=np.stack([first, np.cross(normal, first)]),
        normal=normal,
        flatness=float(np.median(miss / distance)),
        knows_down=knows_down,
    )
