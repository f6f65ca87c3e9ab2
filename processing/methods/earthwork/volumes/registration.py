"""Whether two epochs lie on each other, told by ground that did not change."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from processing.methods.earthwork.volumes.volume_result import Registration

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

_FARTHEST_M = 0.3
_BIN_M = 0.005
_NEAR_M = 0.05
_ROUNDS = 12
_LEAST_AREA_M2 = 25.0
_PATCH_M = 5.0
_SURE = 3.0
_UP_M = 0.01
_ON_SLOPES_M = 0.002
_LEAST_SLOPE = 1e-3
_SIDEWAYS_M = 0.02
_FEWEST_PATCHES = 4
_LEAST_SURE_M = 1e-4
_GENTLE = 0.1
_FEWEST = 50


def registration_of(before: Floats, after: Floats, size_m: float) -> Registration | None:
    """By how much the later epoch lies off, from stable ground; None where too little is stable.

    Parameters
    ----------
    before, after : (rows, columns) float64
        Mean heights of cells of about half a metre, where slopes show and noise doesn't; NaN
        where nothing was measured.
    size_m : float
        Side of a cell.

    The most frequent change of height within 0.3 m is that of ground nobody touched. On it a shift
    to the side shows as change on slopes, fitted robustly:
    ``change = up − slope · sideways + c · steepness``.

    References
    ----------
    Nuth and Kääb 2011, co-registration by slope and aspect.
    """
    change = after - before
    slope_x, slope_y = _slopes(before, size_m)
    known = np.isfinite(change) & np.isfinite(slope_x) & np.isfinite(slope_y)
    if known.sum() < _FEWEST:
        return None
    peak = _most_frequent(change[known])
    stable = known & (np.abs(change - peak) <= _NEAR_M)
    east_slope, north_slope = slope_x[stable], slope_y[stable]
    # What rain or a bucket did to slopes alone is no shift: that shows on slopes facing each other.
    steepness = np.hypot(east_slope, north_slope)
    terms = np.column_stack([-east_slope, -north_slope, np.ones_like(steepness), steepness])
    values = change[stable]
    area_m2 = stable.sum() * size_m**2
    if area_m2 < _LEAST_AREA_M2:
        return None
    shift, weights = _robust_fit(terms, values)
    misses = values - terms @ shift
    sure = _significance(terms, weights * misses, weights, _patches(stable, size_m))
    # A scanner's own errors differ with the slope that its beams come in on: where slopes are
    # gentle they look like a large shift to the side.
    spread = np.std(terms[:, :2], axis=0)
    sure[:2] = np.hypot(sure[:2], _ON_SLOPES_M / np.maximum(spread, _LEAST_SLOPE))
    moved, matters = shift[:3], np.array([_SIDEWAYS_M, _SIDEWAYS_M, _UP_M])
    is_significant = bool(np.any((np.abs(moved) > matters) & (np.abs(moved) > _SURE * sure)))
    east, north, up = (float(value) for value in moved)
    return Registration(
        shift_m=(east, north, up),
        sure_m=(float(sure[0]), float(sure[1]), float(sure[2])),
        stable_area_m2=float(area_m2),
        is_significant=is_significant,
        is_corrected=False,
    )


def correctable_shift(registration: Registration) -> Registration:
    """The shift that can be taken back: what is more than chance, each direction by itself.

    Taking back what chance made of a gentle slope would make volumes worse.
    """
    told = zip(registration.shift_m, registration.sure_m, strict=True)
    east, north, up = (value if abs(value) > _SURE * sure else 0.0 for value, sure in told)
    is_corrected = (east, north, up) != (0.0, 0.0, 0.0)
    if not is_corrected:
        return registration
    return replace(registration, shift_m=(east, north, up), is_corrected=True)


def _slopes(heights: Floats, size_m: float) -> tuple[Floats, Floats]:
    east, north = np.full(heights.shape, np.nan), np.full(heights.shape, np.nan)
    east[:, 1:-1] = (heights[:, 2:] - heights[:, :-2]) / (2 * size_m)
    north[1:-1] = (heights[2:] - heights[:-2]) / (2 * size_m)
    return east, north


def _most_frequent(change: Floats) -> float:
    near = change[np.abs(change) <= _FARTHEST_M]
    if near.size == 0:
        return 0.0
    counts, edges = np.histogram(near, np.arange(-_FARTHEST_M, _FARTHEST_M + _BIN_M, _BIN_M))
    smooth = np.convolve(counts, np.ones(5), mode="same")
    best = int(np.argmax(smooth))
    return float(edges[best] + edges[best + 1]) / 2


def _robust_fit(terms: Floats, values: Floats) -> tuple[Floats, Floats]:
    """The shift and the weight of each cell (Geman and McClure)."""
    weights = np.ones(len(values))
    # On level ground nothing tells of a shift to the side: it is then taken for none.
    rest = np.diag([_GENTLE**2, _GENTLE**2, 0.0, _GENTLE**2])
    shift: Floats = np.zeros(4)
    for _ in range(_ROUNDS):
        form = terms.T @ (terms * weights[:, None]) + rest
        shift = np.asarray(np.linalg.solve(form, terms.T @ (weights * values)), np.float64)
        misses = values - terms @ shift
        spread = max(1.4826 * float(np.median(np.abs(misses))), 1e-4)
        weights = 1.0 / np.square(1.0 + np.square(misses / (2.0 * spread)))
    return shift, weights


def _patches(stable: Mask, size_m: float) -> NDArray[np.int64]:
    """Which square of some metres each stable cell lies in."""
    cells = max(1, round(_PATCH_M / size_m))
    rows, columns = np.nonzero(stable)
    across = -(-stable.shape[1] // cells)
    patches: NDArray[np.int64] = np.unique(
        rows // cells * across + columns // cells, return_inverse=True
    )[1]
    return patches


def _significance(
    terms: Floats, pulls: Floats, weights: Floats, patches: NDArray[np.int64]
) -> Floats:
    """Standard deviations, m, as if each patch were one measurement.

    What a scanner's place is off, and what work left on a slope, is the same over a patch: it
    doesn't average out within one (White 1980, for clusters Liang and Zeger 1986).
    """
    count = int(patches.max()) + 1
    if count < _FEWEST_PATCHES:
        return np.full(3, np.inf)
    scores = np.column_stack(
        [np.bincount(patches, pulls * term, minlength=count) for term in terms.T]
    )
    inverse = np.linalg.pinv(terms.T @ (terms * weights[:, None]))
    spread = inverse @ (scores.T @ scores) @ inverse * count / (count - 1)
    sure: Floats = np.sqrt(np.maximum(np.diag(spread)[:3], _LEAST_SURE_M**2))
    return sure
