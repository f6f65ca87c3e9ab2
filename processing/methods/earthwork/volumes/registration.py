"""Whether two epochs lie on each other, found from ground that did not change.

Where a constant says “by trial”, no measurement varied it alone: docs/accuracy.md judges all values
together, on simulated sites whose volumes are known.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from processing.methods.earthwork.volumes.volume_result import Registration

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

_FARTHEST_M = 0.3
"""Largest change of height that is looked at as a shift: epochs are tied better than that. By
trial."""

_BIN_M, _SMOOTHED_BINS = 0.005, 5
"""Changes are counted in bins of half a centimetre, and the fullest five side by side, about as
wide as changes of untouched ground scatter, are the most frequent. By trial."""

_NEAR_M = 0.05
"""From the most frequent change within which ground is stable; by trial."""

_ROUNDS = 12
"""Of reweighted least squares; by trial."""

_LEAST_AREA_M2 = 25.0
"""Of stable ground, from which anything is found: a square of 5 m, one patch. By trial."""

_PATCH_M = 5.0
"""Side of the squares within which errors are the same. Judged cell by cell, slopes that were
worked on had looked like a shift of 17 mm on a site without any. By trial."""

_SURE = 3.0
"""Standard deviations by which a shift is more than chance: 99.7 % of a normal distribution."""

_UP_M, _SIDEWAYS_M = 0.01, 0.02
"""Shifts that matter and are reported: upward 1 cm is 100 m³ on a hectare, sideways 2 cm is as much
on ground that is all slopes of 1 : 2. By judgement."""

_ON_SLOPES_M = 0.002
"""By how much a scanner's own errors differ with the slope that its beams come in on. On simulated
sites without any shift, errors of a millimetre or two on gentle slopes had looked like 17 to 24 mm
to the east."""

_LEAST_SLOPE = 1e-3
"""Spread of slopes below which nothing tells a shift to the side; keeps the quotient finite."""

_FEWEST_PATCHES = 4
"""As many as there are unknowns: three directions and the term of steepness."""

_LEAST_SURE_M = 1e-4
"""Least standard deviation that is stated: a tenth of a millimetre is better than any survey."""

_GENTLE_SLOPE = 0.1
"""Weight, as of one cell with this slope, of there being no shift to the side and no term of
steepness. By trial."""

_FEWEST = 50
"""Cells known on both sides, from which a most frequent change is found; by trial."""

_SIGMA_PER_MEDIAN = 1.4826
"""Standard deviation of a normal distribution over its median absolute deviation."""

_LEAST_SPREAD_M = 1e-4
"""Keeps weights finite where epochs agree to the last digit."""

_KERNEL_SPREADS = 2.0
"""Half width of Geman and McClure's weight: two standard deviations count a quarter. By trial."""


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
    found = zip(registration.shift_m, registration.sure_m, strict=True)
    east, north, up = (value if abs(value) > _SURE * sure else 0.0 for value, sure in found)
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
    smooth = np.convolve(counts, np.ones(_SMOOTHED_BINS), mode="same")
    best = int(np.argmax(smooth))
    return float(edges[best] + edges[best + 1]) / 2


def _robust_fit(terms: Floats, values: Floats) -> tuple[Floats, Floats]:
    """The shift and the weight of each cell (Geman and McClure)."""
    weights = np.ones(len(values))
    # On level ground nothing tells of a shift to the side: it is then taken for none.
    rest = np.diag([_GENTLE_SLOPE**2, _GENTLE_SLOPE**2, 0.0, _GENTLE_SLOPE**2])
    shift: Floats = np.zeros(terms.shape[1])
    for _ in range(_ROUNDS):
        form = terms.T @ (terms * weights[:, None]) + rest
        shift = np.asarray(np.linalg.solve(form, terms.T @ (weights * values)), np.float64)
        misses = values - terms @ shift
        usual = float(np.median(np.abs(misses)))
        spread = max(_SIGMA_PER_MEDIAN * usual, _LEAST_SPREAD_M)
        weights = 1.0 / np.square(1.0 + np.square(misses / (_KERNEL_SPREADS * spread)))
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

    What a scanner's position is off, and what work left on a slope, is the same over a patch: it
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
