"""Length and curvature of the stretches of scan lines (Takahashi 2022, section 4.5).

Points that follow each other on a scan line and are no more than 0.3 m apart are one stretch; all
of them get its length and how far it bends from the line between its ends. Of a pulse with several
returns the last lies on the stretch; the others, which met a leaf or a wire on the way, are
stretches of their own without a length.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.image.images_of_drives import image_of
from processing.recording.columns.ordering import read_chunk
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind

_POINTS_AT_ONCE = 500_000
"""Some 30 MB, and a moment."""

_STEP_M = 0.3
"""Between neighbours of a stretch (section 4.5)."""

_MOST_CURVED = 10.0
"""Where a stretch comes back to where it began, depth over width is without a limit; ten is a loop.
"""


def has_scan_lines(drive: Drive) -> bool:
    """Whether the order of a drive's points is that of a scanner's lines."""
    return drive.pixel_kind is not ImageKind.TOP_VIEW


def scan_line_features(
    drive: Drive, found: tuple[NDArray[np.float32], ...], monitor: Monitor
) -> None:
    """Length (m) and curvature of every point's stretch.

    A line of a rotating scanner is a revolution from zenith to zenith, so that the road isn't cut;
    of a standing scanner it is a sweep.

    Parameters
    ----------
    found : two of (n,) float32
        Get the lengths, and the curvatures.

    Raises
    ------
    Cancelled
    """
    kind = ImageKind.TRAJECTORY_CENTER if drive.pixel_kind.follows_path else drive.pixel_kind
    starts = image_of(drive, kind).row_starts
    first, last = 0, starts.size - 1
    while first < last:
        monitor.check()
        monitor.report(float(starts[first]) / max(1, drive.count))
        wanted = np.searchsorted(starts, starts[first] + _POINTS_AT_ONCE, "right") - 1
        end = min(last, max(first + 1, int(wanted)))
        start, stop = int(starts[first]), int(starts[end])
        xyz = drive.coordinates.chunk_xyz(start, stop)
        pulses = read_chunk(drive.folder, "pulse", start, stop).astype(np.int64)
        both = np.zeros((2, stop - start), np.float32)
        stretches_kernel(xyz, pulses, starts[first : end + 1] - start, both)
        for values, part in zip(found, both, strict=True):
            values[start:stop] = part
        first = end


@kernel
def stretches_kernel(
    xyz: Floats, pulses: Integers, row_starts: Integers, found: NDArray[np.float32]
) -> None:
    """Lengths and curvatures, ``found`` (2, n) zero; ``row_starts`` (rows + 1,) of the points."""
    line = np.empty(xyz.shape[0], np.int64)
    for row in range(row_starts.size - 1):
        count = 0
        for point in range(row_starts[row], row_starts[row + 1]):
            is_last = point + 1 == row_starts[row + 1] or pulses[point + 1] != pulses[point]
            if not is_last or not np.isfinite(xyz[point].sum()):
                continue
            if count > 0 and _apart(xyz, line[count - 1], point) > _STEP_M:
                _end_stretch(xyz, line[:count], found)
                count = 0
            line[count] = point
            count += 1
        _end_stretch(xyz, line[:count], found)


@kernel
def _end_stretch(xyz: Floats, line: Integers, found: NDArray[np.float32]) -> None:
    """Give the points of a stretch its length and curvature."""
    if line.size < 2:
        return
    first, last, length, depth = line[0], line[-1], 0.0, 0.0
    for k in range(1, line.size):
        length += _apart(xyz, line[k - 1], line[k])
        depth = max(depth, _beside(xyz, line[k], first, last))
    chord = _apart(xyz, first, last)
    curvature = min(depth / chord, _MOST_CURVED) if chord > 0.0 else 0.0
    for k in range(line.size):
        found[0, line[k]], found[1, line[k]] = length, curvature


@kernel
def _apart(xyz: Floats, one: int, other: int) -> float:
    square = 0.0
    for axis in range(3):
        square += (xyz[one, axis] - xyz[other, axis]) ** 2
    return math.sqrt(square)


@kernel
def _beside(xyz: Floats, point: int, first: int, last: int) -> float:
    """Distance of a point from the line between two others, which ends there."""
    along, square = 0.0, 0.0
    for axis in range(3):
        way = xyz[last, axis] - xyz[first, axis]
        along += (xyz[point, axis] - xyz[first, axis]) * way
        square += way * way
    share = min(1.0, max(0.0, along / square)) if square > 0.0 else 0.0
    distance = 0.0
    for axis in range(3):
        foot = xyz[first, axis] + share * (xyz[last, axis] - xyz[first, axis])
        distance += (xyz[point, axis] - foot) ** 2
    return math.sqrt(distance)


def warm_up() -> None:
    """Compile the kernels."""
    pulses = np.arange(2)
    stretches_kernel(np.zeros((2, 3)), pulses, 2 * pulses, np.zeros((2, 2), np.float32))
