"""The found ground where somebody has said since which points are ground, in a section's slab."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from processing.methods.ground.surface_line import SurfaceLine

Floats = NDArray[np.float64]

_BIN_M = 0.25
"""Width of offset within which points give one height: about the smallest cell of the surface,
0.2 m."""

_LOW_PERCENT, _LAYER_M = 10, 0.3
"""Heights of a bin up to ``_LAYER_M`` above its low ones are of one surface, roughness and slope
included; ``_LOW_PERCENT`` leaves strays under the ground out. By trial."""

_NEAR_BINS = 2
"""Heights farther apart than these have nothing measured between them; by trial, so that single
empty bins of sparse points are no gaps."""


def update_ground_lines(
    lines: Sequence[SurfaceLine],
    section: Floats,
    is_ground: NDArray[np.bool_],
    was_ground: NDArray[np.bool_],
) -> tuple[SurfaceLine, ...]:
    """The lines with new stretches where points of the slab are ground now, or are it no longer.

    A new stretch goes through the middle of the lowest of the ground's points within each
    bin of offsets, and joins the old line at its ends; where no ground is left it is filled in.

    Parameters
    ----------
    lines : sequence of SurfaceLine
        As the tool found them, from left to right.
    section : (n, 3) float64
        Points of the slab: offset, height, distance from the plane, m.
    is_ground, was_ground : (n,) bool
        What they are now, and what they were when the lines were found.

    Returns
    -------
    tuple of SurfaceLine
        From left to right; those given where nothing was changed.
    """
    changed = is_ground != was_ground
    if not changed.any():
        return tuple(lines)
    grounds = section[is_ground]
    left = list(lines)
    new: list[SurfaceLine] = []
    for low_m, high_m in _stretches(section[changed, 0]):
        ends = [_height_at(left, low_m), _height_at(left, high_m)]
        left = [piece for one in left for piece in _outside(one, low_m, high_m)]
        inside = grounds[(grounds[:, 0] >= low_m) & (grounds[:, 0] <= high_m)]
        nodes = _middle_heights(inside)
        if ends[0] is not None:
            nodes = np.concatenate([[[low_m, ends[0]]], nodes[nodes[:, 0] > low_m]])
        if ends[1] is not None:
            nodes = np.concatenate([nodes[nodes[:, 0] < high_m], [[high_m, ends[1]]]])
        new += _pieces(nodes)
    return tuple(sorted((*left, *new), key=lambda one: float(one.positions[0, 0])))


def _stretches(offsets: Floats) -> Iterable[tuple[float, float]]:
    """Where points were changed, a bin wider on both sides; what is near is one stretch."""
    bins = np.unique(np.floor(offsets / _BIN_M).astype(np.int64))
    breaks = np.flatnonzero(np.diff(bins) > 2 * _NEAR_BINS) + 1
    for some in np.split(bins, breaks):
        yield float(some[0] - 1) * _BIN_M, float(some[-1] + 2) * _BIN_M


def _middle_heights(grounds: Floats) -> Floats:
    """(k, 2): mean offset and height of the points in each bin."""
    bins = np.floor(grounds[:, 0] / _BIN_M).astype(np.int64)
    order = np.argsort(bins, kind="stable")
    starts = np.flatnonzero(np.diff(bins[order], prepend=bins.min(initial=0) - 1))
    parts = np.split(grounds[order], starts[1:]) if grounds.size else []
    found = [(part[:, 0].mean(), _ground_height(part[:, 1])) for part in parts]
    return np.array(found, dtype=np.float64).reshape(-1, 2)


def _ground_height(heights: Floats) -> float:
    """The middle of the lowest layer: of two surfaces above each other the lower is the ground."""
    low = np.percentile(heights, _LOW_PERCENT)
    return float(np.median(heights[heights <= low + _LAYER_M]))


def _height_at(lines: Iterable[SurfaceLine], offset_m: float) -> float | None:
    for one in lines:
        offsets, heights = one.positions.T
        if offsets[0] <= offset_m <= offsets[-1]:
            return float(np.interp(offset_m, offsets, heights))
    return None


def _outside(line: SurfaceLine, low_m: float, high_m: float) -> Iterable[SurfaceLine]:
    """What of a line lies left and right of a stretch."""
    offsets, heights = line.positions.T
    for low, high in ((-np.inf, low_m), (high_m, np.inf)):
        inner = (offsets > low) & (offsets < high)
        cuts = [end for end in (low, high) if offsets[0] < end < offsets[-1]]
        positions = np.concatenate(
            [line.positions[inner], [(end, np.interp(end, offsets, heights)) for end in cuts]]
            if cuts
            else [line.positions[inner]]
        )
        if len(positions) > 1:
            yield SurfaceLine(positions[np.argsort(positions[:, 0])], line.is_filled)


def _pieces(nodes: Floats) -> Iterable[SurfaceLine]:
    """Lines through points: filled in where neighbours are far from each other."""
    is_far = np.diff(nodes[:, 0]) > _NEAR_BINS * _BIN_M
    ends = np.flatnonzero(np.diff(is_far.astype(np.int8))) + 1
    for start, stop in zip([0, *ends.tolist()], [*ends.tolist(), is_far.size], strict=True):
        if stop > start:
            yield SurfaceLine(nodes[start : stop + 1], bool(is_far[start]))
