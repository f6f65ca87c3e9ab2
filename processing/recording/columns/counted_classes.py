"""The class of a point that counts: its label, by hand or by a tool, over the delivered one."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.recording.columns.columns import Columns

Codes = NDArray[np.uint8]
PointIndices = NDArray[np.int64]

NOISE_CODES = 7, 18
"""Noise below the ground, and elsewhere."""

_DELIVERED, _LABEL = "classification", "label"


class ClassColumns(NamedTuple):
    """The columns from which the class of a point follows, as kernels take them.

    Attributes
    ----------
    delivered, labels : (n,) uint8
        Read-only; of length 0 where a drive lacks one.
    """

    delivered: Codes
    labels: Codes

    def codes_of(self, points: PointIndices) -> Codes:
        """The classes that count of points of any shape, a copy; 0 where nothing was said."""
        codes = np.zeros(points.shape, np.uint8)
        if self.delivered.size:
            codes = self.delivered[points]
        if self.labels.size:
            given = self.labels[points]
            codes = np.where(given > 0, given, codes)
        return np.asarray(codes)

    def codes_between(self, start: int, stop: int) -> Codes:
        """The classes that count of the points ``start … stop − 1``: (n,); 0: nothing was said."""
        codes: Codes = np.zeros(stop - start, np.uint8)
        if self.delivered.size:
            codes = self.delivered[start:stop]
        if self.labels.size:
            given = self.labels[start:stop]
            codes = np.where(given > 0, given, codes)
        return codes

    def noise_between(self, start: int, stop: int) -> NDArray[np.bool_]:
        """Which of the points ``start … stop − 1`` are noise: (n,)."""
        return _are_noise(self.codes_between(start, stop))

    def are_noise(self, points: PointIndices) -> NDArray[np.bool_]:
        """Which points are noise, of the points' shape."""
        return _are_noise(self.codes_of(points))


def _are_noise(codes: Codes) -> NDArray[np.bool_]:
    low, high = NOISE_CODES
    are_noise: NDArray[np.bool_] = (codes == low) | (codes == high)
    return are_noise


def class_columns(columns: Columns) -> ClassColumns:
    """The two columns of a drive as they are now; what is painted later shows in them.

    Raises
    ------
    BadFile
        A column is not as long as the drive has points.
    """
    return ClassColumns(_column(columns, _DELIVERED), _column(columns, _LABEL))


def seen_points(columns: Columns, points: PointIndices, *, hides_noise: bool) -> PointIndices:
    """The points that are seen: all of them, or those that are no noise where noise is hidden.

    Parameters
    ----------
    points : (n,) int64

    Returns
    -------
    (k,) int64
        In their order.
    """
    if not hides_noise or not points.size:
        return points
    return points[~class_columns(columns).are_noise(points)]


def _column(columns: Columns, name: str) -> Codes:
    if columns.has(name):
        return np.asarray(columns[name])
    nothing = np.empty(0, np.uint8)
    nothing.flags.writeable = False
    return nothing
