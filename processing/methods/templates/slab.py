"""Points around a moving cut, read a stretch of street at a time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.methods.templates.fit_kernels import slab_kernel
from processing.recording.drive import Drive
from processing.section.cut import Cut
from processing.section.points_in_cut import points_in_cut

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

STRETCH_M = 8.0
"""Length of street that is read at a time: sixteen steps. It changes the time only."""

_MOST_PER_SLAB = 2500
"""More points than this make a fit slower, not better; by trial."""

_READ_BESIDE_M = 0.5
"""Beyond a slab's ends, so that the next ones along a bend are read with it."""


class SlabBox(NamedTuple):
    """Least and largest offset and height about a frame that a slab holds, m."""

    left: float
    right: float
    low: float
    high: float


@dataclass(frozen=True)
class SectionFrame:
    """Where a section is taken.

    Attributes
    ----------
    position : (3,) float64
        Where the anchor is expected, m, project CRS.
    heading_rad : float
        Direction in which one looks along the line, counter-clockwise from the easting.
    """

    position: _Floats
    heading_rad: float

    @property
    def along(self) -> _Floats:
        """(3,) level unit vector along the line."""
        return np.array([math.cos(self.heading_rad), math.sin(self.heading_rad), 0.0])

    @property
    def right(self) -> _Floats:
        """(3,) level unit vector to the right of it."""
        return np.array([math.sin(self.heading_rad), -math.cos(self.heading_rad), 0.0])

    def in_space(self, offset: float, height: float) -> _Floats:
        """(3,) a position in the section, m, project CRS."""
        found: _Floats = self.position + offset * self.right + np.array([0.0, 0.0, height])
        return found


@dataclass(frozen=True)
class SlabPoints:
    """Points of a section.

    Attributes
    ----------
    local : (n, 3) float64
        Offset to the right, height, distance along, about the frame's position, m.
    points : (n,) int64
        Their indices in the drive.
    """

    local: _Floats
    points: _Integers


class SlabReader:
    """Gives slabs of a drive one beside the other without reading it anew for each.

    Parameters
    ----------
    drive : Drive
    width_m : float
        Thickness of a slab.
    box : SlabBox
    stretch_m : float
        Length of street that is read at a time.
    """

    def __init__(
        self,
        drive: Drive,
        width_m: float,
        box: SlabBox,
        stretch_m: float = STRETCH_M,
    ) -> None:
        self._drive = drive
        self._width_m = width_m
        self._box = box
        self._stretch_m = stretch_m
        self._cut: Cut | None = None
        self._origin = np.zeros(3)
        self._points: _Integers = np.empty(0, np.int64)
        self._local: _Floats = np.empty((0, 3))

    def slab(self, frame: SectionFrame, direction: int = 1) -> SlabPoints:
        """The points about a frame.

        Parameters
        ----------
        direction : {1, -1}
            Where the next frames are expected: ahead or behind.
        """
        if not self._holds(frame):
            self._read(frame, direction)
        count = self._points.size
        local, chosen = np.empty((count, 3)), np.empty(count, np.int64)
        along = frame.along
        found = slab_kernel(
            self._local,
            np.array([*(frame.position - self._origin), along[0], along[1]]),
            np.array([*self._box, self._width_m / 2]),
            local,
            chosen,
        )
        thin = slice(0, found, max(1, found // _MOST_PER_SLAB))
        return SlabPoints(np.ascontiguousarray(local[thin]), self._points[chosen[thin]])

    def _corners(self, frame: SectionFrame) -> _Floats:
        """(4, 3) the corners of a slab seen from above."""
        half = self._width_m / 2
        return np.array(
            [
                frame.position + offset * frame.right + along * frame.along
                for offset in (self._box.left, self._box.right)
                for along in (-half, half)
            ]
        )

    def _holds(self, frame: SectionFrame) -> bool:
        return self._cut is not None and bool(
            self._cut.holds(self._cut.to_section(self._corners(frame))).all()
        )

    def _read(self, frame: SectionFrame, direction: int) -> None:
        half = max(-self._box.left, self._box.right) + _READ_BESIDE_M
        length = self._stretch_m + self._width_m
        middle = frame.position + direction * (self._stretch_m / 2 - self._width_m) * frame.along
        cut = Cut(
            (float(middle[0]), float(middle[1]), float(middle[2])),
            (float(frame.right[0]), float(frame.right[1])),
            width_m=length,
            half_length_m=half,
        )
        self._cut, self._origin = cut, middle
        self._points = points_in_cut(self._drive, cut, most=np.iinfo(np.int64).max)
        self._local = self._drive.xyz(self._points) - middle
