"""Which low shafts carry a reflector: bands and discs that shine back as the faces of signs do.

Delineators have one by definition (視線誘導標設置基準), posts against parking mostly none. What is
bright is told by what else the same head measured about shafts at that range
(:mod:`processing.methods.road.signs.brightness`).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats, Integers
from processing.core.kernels import kernel
from processing.core.worked_ahead import in_order
from processing.methods.road.objects.column_points import ColumnPoints
from processing.methods.road.poles.carried import PIECE_M, is_short
from processing.methods.road.poles.shafts import Shaft
from processing.methods.road.signs.brightness import CLASSES, brightness_of
from processing.methods.road.signs.piece_kernels import range_classes
from processing.recording.drive import Drive

_SAMPLE = 20_000
"""Points of a drive from which its brightness follows: 400 and more in each class of ranges that
matters."""

_UPRIGHT_M, _LEAST_HIGH = 0.3, 0.1
"""Above the foot of a shaft things stand; the ground, seen askew, is darker. Share of the points
from which they tell what is bright; on open land, where fewer rise, the ground tells it too."""

_NEAR_M, _ABOVE_M = 0.08, 0.1
"""From a shaft's surface and above its top to a reflector's points: discs stand off by up to 3 cm
and are 7 to 10 cm wide (視線誘導標設置基準)."""

_FACE_M, _FEWEST_OF_FACE = 1.0, 10
"""The same from a post to points of a sign's face, and bright points that are one."""

_FACE_SHARE = 0.2
"""Of the points about a piece of a post, those that shine where a face is. Of 60 posts of signs on
six streets all had 0.35 and more in some piece; lamps and trunks, about which thousands of leaves
shine now and then, 0.18 at most."""

_LOOKED_AT = 4_000_000
"""Points at most, of all about shafts, that tell what is bright: more say the same."""

_FEWEST = 2
"""Bright points that are a reflector: one may be a mixed return."""


class ReflectorSearch:
    """Tells which shafts carry a reflector.

    Parameters
    ----------
    drives : sequence of Drive
    shafts : sequence of Shaft
    around : ColumnPoints
        The points about each shaft.
    origin : (3,) float64
        Of the plan, m, project CRS.
    """

    def __init__(
        self,
        drives: Sequence[Drive],
        shafts: Sequence[Shaft],
        around: ColumnPoints,
        origin: Floats,
    ) -> None:
        self._drives, self._around, self._origin = drives, around, origin
        feet = np.array([one.foot[2] for one in shafts])
        step = len(around.local) // _LOOKED_AT + 1
        is_high = np.zeros(-(-len(around.local) // step), np.bool_)
        upright_kernel(around.local, around.starts, feet, step, is_high)

        def bounds_of(drive: int) -> Floats:
            mine = around.drives[::step] == drive
            high = np.flatnonzero(mine & is_high)
            return self._bounds_of(drive, step * np.flatnonzero(mine), step * high)

        self._bounds = list(in_order(bounds_of, range(len(drives))))

    def shines(self, number: int, shaft: Shaft) -> float:
        """Whether a reflector is on the upper half of a shaft, by its number, or a face on it.

        1 or 0; 0.5 where no intensity tells.
        """
        if not any(np.isfinite(self._bounds[drive]).any() for drive in np.unique(shaft.drives)):
            return 0.5
        part = self._around.of(number)
        local = self._around.local[part] - shaft.foot
        up = local[:, 2]
        beside = local[:, :2] - up[:, None] * shaft.lean
        away = np.hypot(beside[:, 0], beside[:, 1]) - shaft.radius_m + shaft.taper * up
        near, above = (_NEAR_M, _ABOVE_M) if is_short(shaft) else (_FACE_M, _FACE_M)
        is_on = (away < near) & (up > shaft.top_m / 2) & (up < shaft.top_m + above)
        lines = part.start + np.flatnonzero(is_on)
        is_bright = np.zeros(lines.size, np.bool_)
        for drive, bounds in enumerate(self._bounds):
            own = np.flatnonzero(self._around.drives[lines] == drive)
            mine = lines[own]
            is_bright[own] = self._intensity(drive, mine) >= bounds[self._classes(drive, mine)]
        bright = int(np.count_nonzero(is_bright))
        if is_short(shaft):
            return float(bright >= _FEWEST)
        return float(bright >= _FEWEST_OF_FACE and _has_face(up[is_on], is_bright))

    def _bounds_of(self, drive: int, mine: Integers, high: Integers) -> Floats:
        """The least intensity of a bright point of a drive, for each class of ranges.

        Parameters
        ----------
        mine, high : (n,) int64
            Lines of its points that are looked at, and those of them that are above the ground.
        """
        chosen = high if high.size >= _LEAST_HIGH * mine.size else mine
        chosen = chosen[:: chosen.size // _SAMPLE + 1]
        brightness = brightness_of(self._intensity(drive, chosen), self._classes(drive, chosen))
        return brightness.bounds()

    def _intensity(self, drive: int, lines: Integers) -> NDArray[np.uint16]:
        column = self._drives[drive].columns["intensity"]
        return np.asarray(column[self._around.points[lines]], np.uint16)

    def _classes(self, drive: int, lines: Integers) -> Integers:
        """(n,) range class of points; the vehicle's place is near enough to the head's."""
        trajectory = self._drives[drive].trajectory
        if trajectory is None or lines.size == 0:
            return np.zeros(lines.size, np.int64)
        times = np.asarray(self._drives[drive].columns["time"][self._around.points[lines]])
        times = np.clip(np.nan_to_num(times), trajectory.time[0], trajectory.time[-1])
        is_known = trajectory.covers(times)
        times = np.where(is_known, times, trajectory.time[0])
        off = self._around.local[lines] + self._origin - trajectory.positions_at(times)
        ranges = np.where(is_known, np.linalg.norm(off, axis=1), 0.0)
        return range_classes(ranges, CLASSES)


@kernel
def upright_kernel(
    local: Floats, starts: Integers, feet: Floats, step: int, is_high: Flags
) -> None:
    """Mark, of every so many points about shafts, those above the ground about the foot."""
    shaft = 0
    for number in range(is_high.size):
        while number * step >= starts[shaft + 1]:
            shaft += 1
        is_high[number] = local[number * step, 2] - feet[shaft] > _UPRIGHT_M


def _has_face(heights: Floats, is_bright: NDArray[np.bool_]) -> bool:
    """Whether a good share of the points of some piece of a post shine."""
    piece = np.floor(heights / PIECE_M).astype(np.int64)
    piece -= piece.min()
    number, shining = np.bincount(piece), np.bincount(piece, is_bright)
    return bool((shining > _FACE_SHARE * np.maximum(number, _FEWEST_OF_FACE)).any())
