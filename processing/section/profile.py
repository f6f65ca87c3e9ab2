"""SectionProfile: what a section shows, reduced to its ground line and what crosses it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from processing.core.arrays import Floats
from processing.core.text import Text
from processing.section.cut import Cut
from processing.section.points_in_cut import section_points

if TYPE_CHECKING:  # processing.recording.drive makes images, so importing it here would be a circle
    from processing.recording.drive import Drive


BIN_M = 0.05
"""The ground line has a vertex for each so many metres: fine enough for a curb's face."""

_LAYER_M = 0.05
"""Points up to this above the lowest of their bin are the same surface: a scanner's noise, and the
fall of a road within a bin. By trial."""

_LOWEST_SHARE = 0.05
"""Share of the points of a bin that may be strays below the ground; by trial."""

_BINS_BESIDE, _SPIKE_M = 5, 0.3
"""A bin so far above the median of so many on either side is no ground, but a wheel or a post: more
than a curb is high. By trial."""

_GAP_M = 0.5
"""Over wider gaps the ground line is interrupted: what lies in them isn't known. By judgement."""

_MOST_POINTS = 20_000
"""Of a drawing: more make a file that drawing programs open slowly, and no clearer picture."""


@dataclass(frozen=True)
class DrawnLine:
    """A line of the map that may cross a section.

    Attributes
    ----------
    name : Text
        What it is.
    layer : str
        Of the drawing.
    aci : int
        AutoCAD colour index.
    xyz : (n, 3) float64
        Its vertices, m, project CRS; one for a point.
    is_closed : bool
        Whether it leads back to the first.
    """

    name: Text
    layer: str
    aci: int
    xyz: Floats
    is_closed: bool = False


@dataclass(frozen=True)
class Crossing:
    """Where a line of the map passes through a section.

    Attributes
    ----------
    offset_m : float
        To the right of the section's middle.
    height_m : float
        As in the project.
    """

    name: Text
    layer: str
    aci: int
    offset_m: float
    height_m: float


@dataclass(frozen=True)
class SectionProfile:
    """A section to be drawn.

    Attributes
    ----------
    cut : Cut
    ground : tuple of (k, 2) float64
        Offsets and heights of the ground line, from left to right; a part for each stretch
        without gap.
    points : (n, 2) float64
        Offsets and heights of measured points in the slab, thinned.
    crossings : tuple of Crossing
        From left to right.
    station_m : float or None
        Along the line that the section belongs to.
    title : Text
    """

    cut: Cut
    ground: tuple[Floats, ...]
    points: Floats
    crossings: tuple[Crossing, ...] = ()
    station_m: float | None = None
    title: Text = Text("", "")

    def ground_at(self, offset_m: float) -> float | None:
        """Height of the ground line; None in its gaps and beyond its ends."""
        for part in self.ground:
            if part[0, 0] <= offset_m <= part[-1, 0]:
                return float(np.interp(offset_m, part[:, 0], part[:, 1]))
        return None


def profile_of(
    cut: Cut,
    drives: Iterable[Drive],
    lines: Sequence[DrawnLine] = (),
    *,
    station_m: float | None = None,
    title: Text = Text.same(""),
) -> SectionProfile:
    """What a cut shows of some drives, but for noise, and of the map.

    Parameters
    ----------
    lines : sequence of DrawnLine
        Of the whole map, or those near the cut.
    """
    found = [section_points(drive, cut, hides_noise=True).section for drive in drives]
    section = np.concatenate([np.empty((0, 3)), *found])
    stride = max(1, -(-len(section) // _MOST_POINTS))
    crossings = [crossing for line in lines for crossing in crossings_of(cut, line)]
    return SectionProfile(
        cut=cut,
        ground=ground_line(section[:, 0], section[:, 1]),
        points=section[::stride, :2].copy(),
        crossings=tuple(sorted(crossings, key=lambda one: one.offset_m)),
        station_m=station_m,
        title=title,
    )


def ground_line(offsets_m: ArrayLike, heights_m: ArrayLike) -> tuple[Floats, ...]:
    """The lower surface of points in a section.

    Parameters
    ----------
    offsets_m, heights_m : (n,) float64

    Returns
    -------
    tuple of (k, 2) float64
        One position per bin of ``BIN_M`` that holds points; a part for each stretch whose gaps are
        at most half a metre.

    Notes
    -----
    1. Of each bin the lowest twentieth of the points is left out as stray.
    2. The median of what lies within 5 cm above the lowest that is left is the bin's height, and
       so is the median of the offsets of these points.
    3. A bin that stands out of the median of those around it is what hides the ground there: a
       leaf, a thin pole.
    """
    offsets = np.asarray(offsets_m, dtype=np.float64)
    if not offsets.size:
        return ()
    heights = np.asarray(heights_m, dtype=np.float64)
    numbers = np.floor(offsets / BIN_M).astype(np.int64)
    order = np.lexsort((heights, numbers))
    numbers, offsets, heights = numbers[order], offsets[order], heights[order]
    firsts = np.flatnonzero(np.diff(numbers, prepend=numbers[:1] - 1))
    positions = []
    for start, stop in zip(firsts, [*firsts[1:], numbers.size], strict=True):
        lowest = start + int((stop - start) * _LOWEST_SHARE)
        end = int(np.searchsorted(heights[lowest:stop], heights[lowest] + _LAYER_M, "right"))
        layer = slice(lowest, lowest + end)
        positions.append((np.median(offsets[layer]), np.median(heights[layer])))
    line = _without_spikes(np.array(positions).reshape(-1, 2))
    gaps = np.flatnonzero(np.diff(line[:, 0]) > _GAP_M) + 1
    return tuple(part for part in np.split(line, gaps) if len(part) > 1)


def _without_spikes(line: Floats) -> Floats:
    around = min(_BINS_BESIDE, (len(line) - 1) // 2)
    if around < 1:
        return line
    heights = np.pad(line[:, 1], around, mode="reflect")
    windows = np.lib.stride_tricks.sliding_window_view(heights, 2 * around + 1)
    stands_out = line[:, 1] > np.median(windows, axis=1) + _SPIKE_M
    return line[~stands_out]


def crossings_of(cut: Cut, line: DrawnLine) -> list[Crossing]:
    """Where a line passes through the plane of a cut; a point counts within the slab."""
    section = cut.to_section(line.xyz)
    if len(section) == 1:
        positions = section[cut.holds(section), :2]
    else:
        if line.is_closed:
            section = np.concatenate([section, section[:1]])
        positions = plane_crossings(section)
    inside = np.abs(positions[:, 0]) <= cut.half_length_m
    return [
        Crossing(line.name, line.layer, line.aci, offset, height)
        for offset, height in positions[inside].tolist()
    ]


def plane_crossings(section: Floats) -> Floats:
    """Offsets and heights (k, 2) at which a line of the section, (n, 3), passes its plane."""
    return segment_crossings(section[:-1], section[1:])[1]


def segment_crossings(starts: Floats, ends: Floats) -> tuple[NDArray[np.int64], Floats]:
    """Which segments of the section pass its plane, and where.

    Parameters
    ----------
    starts, ends : (n, 3) float64
        Offsets, heights, distances from the plane.

    Returns
    -------
    numbers : (k,) int64
        Of the segments, rising.
    positions : (k, 2) float64
        Offsets and heights.
    """
    # A vertex in the plane belongs to the side that leaves it, so that it counts once.
    passes = np.flatnonzero((starts[:, 2] <= 0) != (ends[:, 2] <= 0))
    start, end = starts[passes], ends[passes]
    shares = start[:, 2] / (start[:, 2] - end[:, 2])
    positions: Floats = start[:, :2] + shares[:, None] * (end[:, :2] - start[:, :2])
    return passes, positions
