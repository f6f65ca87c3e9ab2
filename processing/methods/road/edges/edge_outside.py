"""What lies outside of an edge: grass and soil by their roughness, gutters by their width."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.methods.road.edges.cross_cells import CrossCells
from processing.methods.road.edges.edge_courses import LEFT, EdgeCourse

Outside = Literal["walk", "gutter", "soil", "grass"]

_ROUGH_M, _GROWN_M = 0.0035, 0.012
"""Standard deviation of heights beyond the noise of the road inside: paving has 2 mm at most (mean
profile depths, ISO 13473-1), gravel and soil their grain of a centimetre, grass its blades."""

_NEAR, _BEYOND = (1, 6), (16, 22)
"""Cells from an edge that lie on what is next to it, and beyond the widest gutter, 0.66 m."""

_BRIGHTER, _DARKER, _OTHER_HEIGHT_M = 0.2, 0.4, 0.05
"""Differences beyond it that make what is next to an edge a gutter; what is left of the effects of
range and incidence makes the same surface darker farther out."""

_INSIDE = (-12, -2)
_AROUND = 12
"""Stations to each side that decide together: walks and gutters go on for a dozen metres."""


def outsides(cells: CrossCells, course: EdgeCourse) -> NDArray[np.str_]:
    """(n,) what lies outside at each station of a course; as at the nearest one that tells."""
    near, beyond, inside = (_mean_rows(cells, course, one) for one in (_NEAR, _BEYOND, _INSIDE))
    rough, far_rough = (_excess(one[0], inside[0]) for one in (near, beyond))
    other = (beyond[1] - near[1] > _BRIGHTER) | (near[1] - beyond[1] > _DARKER)
    other |= np.abs(beyond[2] - near[2]) > _OTHER_HEIGHT_M
    other |= far_rough > _ROUGH_M
    told = np.flatnonzero(np.isfinite(near[2]) & np.isfinite(beyond[2]))
    if not told.size:
        told = np.arange(len(course.stations))
    is_narrow = _median(other[told].astype(np.float64)) > 0.5
    usual = _median(rough[told])
    smooth = np.where(is_narrow, "gutter", "walk")
    soft = np.where(usual > _GROWN_M, "grass", "soil")
    kinds = np.where(usual > _ROUGH_M, soft, smooth)
    after = np.clip(np.searchsorted(told, np.arange(len(course.stations))), 0, len(told) - 1)
    return np.asarray(kinds[after])


def _mean_rows(
    cells: CrossCells, course: EdgeCourse, span: tuple[int, int]
) -> tuple[Floats, Floats, Floats]:
    """Roughness of the quieter, m, mean tone and height, m, of some cells: (n,) float64 each."""
    half = cells.counts.shape[1] // 2
    at = np.clip(course.places[:, None] + np.arange(*span), 0, half - 1)
    columns = half + at if course.side == LEFT else half - 1 - at
    rows = course.stations[:, None]
    rough = np.sort(np.exp(cells.rough[rows, columns]), axis=1)  # unknown ones last
    # Joints and handles of lids, and what stands on the ground, fill some cells only.
    known = np.isfinite(rough).sum(axis=1)
    quiet = rough[np.arange(len(rough)), np.maximum((known - 1) // 4, 0)]
    tones, heights = cells.tones[rows, columns], cells.heights[rows, columns]
    return quiet, _known_mean(tones), _known_mean(heights)


def _known_mean(values: Floats) -> Floats:
    known = np.isfinite(values)
    count = known.sum(axis=1)
    with np.errstate(invalid="ignore"):
        return np.asarray(np.where(known, values, 0.0).sum(axis=1) / np.where(count, count, np.nan))


def _excess(rough: Floats, inside: Floats) -> Floats:
    """What is left of a standard deviation without the noise that the road shows, too."""
    own = np.where(np.isfinite(inside), inside, 0.0)
    more = np.where(np.isfinite(rough), rough, 0.0) ** 2 - own**2
    return np.asarray(np.sqrt(np.maximum(more, 0.0)))


def _median(values: Floats) -> Floats:
    """Medians over the stations around."""
    from scipy.ndimage import median_filter

    return np.asarray(median_filter(values, 2 * _AROUND + 1, mode="nearest"))
