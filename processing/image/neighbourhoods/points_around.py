"""Points around a measured point, found by their pulses: in its row and in the rows beside it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.kernels import kernel
from processing.recording.columns.counted_classes import class_columns

if TYPE_CHECKING:  # processing.recording.drive makes images, so importing it here would be a circle
    from processing.recording.drive import Drive

_SPAN_PART, _NEAR_PART, _LEAST_SPAN = 4, 8, 2
"""In a row beside, points are looked for within a quarter of a revolution to either side of the
same direction, and rows are told apart by an eighth: beyond it beams look elsewhere. Two pulses at
least."""

_MOST_STRIDE = 256
"""Rows are taken no farther apart: a vehicle that waits longer is looked at no closer."""

_ROWS_ASIDE = 16
"""Rows to either side that are taken; where more lie within the radius, as where a vehicle waits,
every second, fourth … row is."""


class SearchSphere(NamedTuple):
    """Where points are looked for: its middle, (3,) in the integers' own units; its radius, m."""

    middle: Floats
    radius_m: float


def neighbours(drive: Drive, point: int, radius_m: float) -> Integers:
    """Points within a distance of a point, in rising order, taken from the rows around its own.

    Rows are skipped where they are so close that others reach as far. Noise is no surface: of
    points of that class only the one itself is among them.

    Returns
    -------
    (k,) int64
    """
    pulses = drive.columns["pulse"]
    period = _pulses_per_row(drive)
    here, span = int(pulses[point]), max(_LEAST_SPAN, int(period / _SPAN_PART))
    stride, aside = rows_to_take(drive, point, radius_m)
    middles = here + np.rint(period * stride * np.arange(-aside, aside + 1)).astype(np.int64)
    edges = np.searchsorted(pulses, np.concatenate([middles - span, middles + span + 1]))
    starts, stops = edges.reshape(2, -1)
    starts[1:] = np.maximum(starts[1:], stops[:-1])
    found = np.empty(int(np.maximum(0, stops - starts).sum()), np.int64)
    coordinates = drive.coordinates
    part = coordinates.stretched(np.column_stack([starts, stops]))
    middle = coordinates.integers(np.array([point]))[0].astype(np.float64)
    scale = np.array(coordinates.quantisation.scale)
    count = _near_kernel(
        part.integers, scale, part.stretches, SearchSphere(middle, radius_m), found
    )
    near = part.points(found[:count])
    is_noise = class_columns(drive.columns).are_noise(near)
    return np.asarray(near[~is_noise | (near == point)])


def rows_to_take(drive: Drive, point: int, radius_m: float) -> tuple[int, int]:
    """Stride between rows, and how many of them on each side reach as far as the radius."""
    pulses = drive.columns["pulse"]
    period = _pulses_per_row(drive)
    here, position = int(pulses[point]), drive.xyz(np.array([point]))[0]
    span = max(_LEAST_SPAN, int(period / _NEAR_PART))
    stride = 1
    while stride < _MOST_STRIDE:
        for side in (1, -1):
            middle = here + round(side * stride * period)
            start, stop = np.searchsorted(pulses, [middle - span, middle + span + 1])
            if stop > start:
                xyz = drive.xyz(slice(int(start), int(stop)))
                gap = float(np.linalg.norm(xyz - position, axis=1).min())
                if gap * _ROWS_ASIDE * 2 >= radius_m:
                    return stride, min(2 * _ROWS_ASIDE, max(2, math.ceil(radius_m / gap)))
        stride *= 2
    return 1, _ROWS_ASIDE


def _pulses_per_row(drive: Drive) -> float:
    revolutions = drive.revolutions
    return (
        revolutions.pulses_per_revolution
        if revolutions is not None
        else float(drive.info.cells_per_row)
    )


@kernel
def _near_kernel(
    integers: NDArray[np.int32],
    scale: Floats,
    stretches: Integers,
    near: SearchSphere,
    found: Integers,
) -> int:
    """Points of some stretches within a distance of a point's integers; gives their number."""
    middle, radius = near
    count = 0
    for k in range(stretches.shape[0]):
        for i in range(stretches[k, 0], stretches[k, 1]):
            square = 0.0
            for j in range(3):
                away = (float(integers[i, j]) - middle[j]) * scale[j]
                square += away * away
            if square <= radius * radius:
                found[count] = i
                count += 1
    return count


def warm_up() -> None:
    """Compile the kernel."""
    stretches, found = np.array([[0, 1]]), np.empty(1, np.int64)
    integers = np.zeros((1, 3), np.int32)
    integers.flags.writeable = False
    _near_kernel(integers, np.ones(3), stretches, SearchSphere(np.zeros(3), 1.0), found)
