"""LabelChange: the labels of some points of a drive before and after, as a small value."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.labels.packing import (
    pack_codes,
    pack_points,
    unpack_codes,
    unpack_points,
)

MOST_POINTS = 1_000_000
"""Points of one change; of more several are made, so that never all are in memory at once."""


@dataclass(frozen=True)
class LabelChange:
    """Labels of points that become others; made by :meth:`of`.

    Attributes
    ----------
    drive : str
    count : int
        Number of points.
    points, before, after : bytes
        Packed by :mod:`processing.labels.packing`: a stroke stays small in memory and on disk.
    """

    drive: str
    count: int
    points: bytes
    before: bytes
    after: bytes

    @staticmethod
    def of(
        drive: str,
        points: NDArray[np.int64],
        before: NDArray[np.uint8],
        after: NDArray[np.uint8],
    ) -> LabelChange:
        """Pack a change.

        Parameters
        ----------
        points : (n,) int64
            Rising strictly.
        before, after : (n,) uint8
            Codes of the points; 0 is no label.

        Raises
        ------
        ValueError
            The points don't rise, or there are not as many codes.
        """
        if not points.shape == before.shape == after.shape:
            message = f"{points.shape} points have {before.shape} and {after.shape} codes"
            raise ValueError(message)
        return LabelChange(
            drive, points.size, pack_points(points), pack_codes(before), pack_codes(after)
        )

    def inverse(self) -> LabelChange:
        """The change that takes this one back."""
        return LabelChange(self.drive, self.count, self.points, self.after, self.before)

    def unpacked_points(self) -> NDArray[np.int64]:
        """(n,) int64: its points, rising.

        Raises
        ------
        ValueError
            It is damaged.
        """
        points = unpack_points(self.points)
        if points.size != self.count:
            message = f"{points.size} of {self.count} points"
            raise ValueError(message)
        return points

    def codes_before(self) -> NDArray[np.uint8]:
        """(n,) uint8: what the points had; ValueError where it is damaged."""
        return self._codes(self.before)

    def codes_after(self) -> NDArray[np.uint8]:
        """(n,) uint8: what the points get; ValueError where it is damaged."""
        return self._codes(self.after)

    def _codes(self, packed: bytes) -> NDArray[np.uint8]:
        codes = unpack_codes(packed)
        if codes.size != self.count:
            message = f"{codes.size} codes for {self.count} points"
            raise ValueError(message)
        return codes


def label_changes(
    drive: str, points: NDArray[np.int64], before: NDArray[np.uint8], code: int
) -> tuple[LabelChange, ...]:
    """The changes that give points a label; points that have it already are left out.

    Parameters
    ----------
    points : (n,) int64
        Rising strictly.
    before : (n,) uint8
        What they have now.
    code : int
        0 takes labels away.
    """
    others = before != code
    points, before = points[others], before[others]
    return tuple(
        LabelChange.of(
            drive,
            points[start : start + MOST_POINTS],
            before[start : start + MOST_POINTS],
            np.full(points[start : start + MOST_POINTS].size, code, np.uint8),
        )
        for start in range(0, points.size, MOST_POINTS)
    )
