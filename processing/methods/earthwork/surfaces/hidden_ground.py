"""Ground that nobody saw: how it probably lies behind crests and beneath machines, and how surely.

A smooth surface over a hole is right on average where a machine or a fence hid the ground. Behind
a crest it isn't: the last beam over the crest is the highest that the ground there can be, and a
smooth surface runs along that very beam. Ground behind a crest falls off as slopes of this site
do, until it meets the ground that goes on from what was seen farther away. Which of both holds no
beam tells: beside points it is nearly always the smooth surface, metres from any the other. On six
simulated sites of 95 to 150 m the smooth surface lay 7 cm too high in the mean, the one behind
crests 10 cm too low, and what lies between them by their likelihood within 2 cm.

Where a constant says “by trial”, no measurement varied it alone: docs/accuracy.md judges all values
together, on simulated sites whose volumes are known.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.methods.earthwork.surfaces.filling import fill_smoothly, measured_extent
from processing.methods.earthwork.surfaces.sight_lines import SightLines

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

_SLOPE_FROM = 0.25
"""Rise over run from which ground is a slope: 1 : 4, the gentlest that banks are built with."""

_USUAL_SLOPE = 0.5
"""Where a site has too few slopes: 1 : 2, as banks of earth are built."""

_GENTLEST_SLOPE = 0.3
"""Least of what ground falls by behind a crest: it does fall. By trial."""

_STEEPEST_RISE = 5.0
"""Rise over run, 79°, to which slopes seen behind are cut: steeper ones are walls or strays."""

_ON_BEAM_M = 0.03
"""How near a smooth surface runs to a beam to be held up by it alone; by trial, about the noise of
points and the roughness of graded ground."""

_BEHIND_M = 1.5
"""Of the ground seen next behind, from which its slope is told: three cells of holes. By trial."""

_REACH_M = 60.0
"""How far from a hole a crest and the ground behind are looked for; by trial. Farther crests are
of other works."""

_FEW = 20
"""Slopes or differences from which a percentile or a mean is told; by trial."""

_EVEN_M2 = 1e-9
"""Spread of distances below which a line of heights has no slope."""

_EVEN_ODDS_M = 1.5
"""From points, where ground behind a crest is as likely to fall off as to go on smoothly.
Of what lies between both surfaces, on the six simulated sites ground was lower than the smooth one
by .1 to .4 within 0.6 m of points, .2 to .5 within 1.2 m, .4 to .9 within 2.5 m, .5 to .7 beyond;
odds in proportion to the distance give .2, .4, .5 and .7."""

_ROUGH_M = 2.0
"""Distance whose roughness a hole has at least, since what hides ground is rough: a machine's half
width. By trial."""

_LAGS_M = (0.5, 1.0, 2.0, 4.0, 8.0)
"""Distances at which the site's roughness is measured, each twice the one before, up to about the
half width of what is filled in at an edge; beyond, it is taken to grow with the distance, as for a
slope that is missed."""

_BEHIND_FACTS = 6
_FROM_CREST, _CREST, _TO_FAR, _FAR, _RISE, _HORIZON = range(_BEHIND_FACTS)
"""Columns that :func:`_crest_kernel` fills."""


class _Beam(NamedTuple):
    """Where a scanner stood in plan, the direction of a beam there, and how far it has come, m."""

    east: float
    north: float
    x: float
    y: float
    far_m: float


class SeenBeside(NamedTuple):
    """What else is known of a site where ground was not measured.

    Attributes
    ----------
    lines : SightLines
        Of the positions where scanners stood; without them crests don't count.
    others : (rows, columns) float64
        Heights that other dates measured, m; NaN where none did.
    """

    lines: SightLines
    others: Floats


@dataclass(frozen=True)
class FilledGround:
    """Ground over a grid, measured and filled in; NaN where there is none.

    Attributes
    ----------
    heights : (rows, columns) float64
    spread : (rows, columns) float64
        Standard deviation that a filled height is thought to have, m; in a cell that was measured,
        that of a height between its points.
    """

    heights: Floats
    spread: Floats


def fill_ground(
    heights: Floats,
    is_wanted: Mask,
    seen: SeenBeside,
    size_m: float,
    monitor: Monitor,
) -> FilledGround:
    """Fill holes in measured ground; what lies beyond its last points is none.

    Parameters
    ----------
    heights : (rows, columns) float64
        NaN where nothing was measured.
    is_wanted : (rows, columns) bool
        Where ground is asked for.
    seen : SeenBeside
        In the grid's frame: east and north of its corner, up from its height, m.
    """
    from scipy.ndimage import distance_transform_edt

    is_known = np.isfinite(heights)
    if not is_known.any():
        return FilledGround(np.full(heights.shape, np.nan), np.full(heights.shape, np.nan))
    away_m = np.asarray(distance_transform_edt(~is_known)) * size_m
    wanted = is_wanted & measured_extent(is_known, size_m)
    smooth = fill_smoothly(heights, is_known, wanted)
    monitor.check()
    holes = wanted & ~is_known
    # What hides is rough; a gap between points is no wider than a cell.
    reach_m = np.where(holes, np.maximum(away_m, _ROUGH_M), size_m / 2)
    spread = _roughness_at(heights, reach_m, size_m)
    likely = _behind_crests(smooth, is_known, holes, (seen, size_m), monitor)
    falls = away_m / (away_m + _EVEN_ODDS_M)
    drop = np.where(holes, smooth - likely, 0.0)
    spread = np.hypot(spread, np.sqrt(falls * (1 - falls)) * drop)
    filled = smooth - falls * drop
    return FilledGround(filled, np.where(np.isnan(filled), np.nan, spread))


def _behind_crests(
    smooth: Floats, is_known: Mask, holes: Mask, at: tuple[SeenBeside, float], monitor: Monitor
) -> Floats:
    """The smooth surface, lowered where it runs along a beam over a crest."""
    (lines, others), size_m = at
    meets = others[holes]
    positions = np.argwhere(holes).astype(np.int64)
    known = np.where(is_known, smooth, np.nan)
    typical = _site_slope(known, size_m)
    sums = np.zeros((len(positions), 2))
    middles: Floats = (positions[:, ::-1].astype(np.float64) + 0.5) * size_m
    for number, stand in enumerate(lines.stands):
        monitor.check()
        limit = lines.highest_at(number, middles)
        behind = np.full((len(positions), _BEHIND_FACTS), np.nan)
        _crest_kernel(known, positions, stand, size_m, behind)
        from_crest, crest, to_far, far, rise, horizon = behind.T
        here = smooth[holes]
        is_behind = (horizon >= here - _ON_BEAM_M) | (limit <= here - _ON_BEAM_M)
        is_behind &= (to_far > 0) | np.isfinite(meets)
        falling = np.maximum(typical, np.clip(np.nan_to_num(rise), 0.0, _STEEPEST_RISE))
        going_on = far - np.clip(rise, -_STEEPEST_RISE, typical) * (to_far + size_m / 2)
        # At the edge of a site nothing is seen behind: there it meets the ground of another date.
        going_on = np.where(to_far > 0, going_on, meets)
        likely = np.maximum(crest - falling * from_crest, going_on)
        likely = np.minimum(likely, np.minimum(here, limit))
        sums[is_behind, 0] += likely[is_behind]
        sums[is_behind, 1] += 1.0
    heights = smooth.copy()
    is_reported = sums[:, 1] > 0
    rows, columns = positions[is_reported].T
    heights[rows, columns] = sums[is_reported, 0] / sums[is_reported, 1]
    return heights


def _site_slope(heights: Floats, size_m: float) -> float:
    """What slopes of the site fall by, m per m, in the median."""
    across = (heights[1:-1, 2:] - heights[1:-1, :-2]) / (2 * size_m)
    along = (heights[2:, 1:-1] - heights[:-2, 1:-1]) / (2 * size_m)
    slopes = np.hypot(across, along)
    slopes = slopes[np.isfinite(slopes) & (slopes > _SLOPE_FROM)]
    if slopes.size < _FEW:
        return _USUAL_SLOPE
    return max(float(np.median(slopes)), _GENTLEST_SLOPE)


def _roughness_at(heights: Floats, away_m: Floats, size_m: float) -> Floats:
    """By how much ground differs from the middle between its neighbours so far away.

    That is what a smooth surface over a hole of such a size misses, told by the ground that was
    measured on the same site.
    """
    lags, misses = [0.0], [0.0]
    for lag_m in _LAGS_M:
        step = max(1, round(lag_m / size_m))
        found = []
        for z in (heights, heights.T):
            if z.shape[0] > 2 * step:
                miss = z[step:-step] - (z[2 * step :] + z[: -2 * step]) / 2
                found.append(miss[np.isfinite(miss)])
        everything = np.concatenate(found) if found else np.empty(0)
        if everything.size >= _FEW:
            lags.append(step * size_m)
            misses.append(float(np.sqrt(np.mean(np.square(everything)))))
    beyond = np.maximum(away_m / max(lags[-1], size_m), 1.0)
    told: Floats = np.interp(away_m, lags, np.maximum.accumulate(misses)) * beyond
    return told


@kernel
def _height_kernel(known: Floats, size_m: float, x: float, y: float) -> float:
    row, column = int(np.floor(y / size_m)), int(np.floor(x / size_m))
    if 0 <= row < known.shape[0] and 0 <= column < known.shape[1]:
        return float(known[row, column])
    return np.nan


@kernel
def _crest_kernel(
    known: Floats, positions: NDArray[np.int64], stand: Floats, size_m: float, behind: Floats
) -> None:
    """What a standing scanner's beams over measured ground say of positions that have none.

    ``behind``: m from the crest, height of the crest, m to the ground that was seen behind, its
    height, its rise away from the scanner, height of a beam over the crest there; NaN where there
    is none.
    """
    step = size_m / 2
    for position in range(positions.shape[0]):
        x = (positions[position, 1] + 0.5) * size_m - stand[0]
        y = (positions[position, 0] + 0.5) * size_m - stand[1]
        far_m = np.hypot(x, y)
        if far_m < size_m:
            continue
        x, y = x / far_m, y / far_m
        steepest = -np.inf
        at = max(size_m, far_m - _REACH_M)
        while at < far_m:
            z = _height_kernel(known, size_m, stand[0] + x * at, stand[1] + y * at)
            # NaN is never more.
            if (z - stand[2]) / at >= steepest:
                steepest = (z - stand[2]) / at
                behind[position, _FROM_CREST] = far_m - at
                behind[position, _CREST] = z
            at += step
        if steepest > -np.inf:
            behind[position, _HORIZON] = stand[2] + far_m * steepest
            beam = _Beam(stand[0], stand[1], x, y, far_m)
            _behind_kernel(known, size_m, beam, behind[position])


@kernel
def _behind_kernel(
    known: Floats,
    size_m: float,
    beam: _Beam,
    behind: Floats,
) -> None:
    """The ground that was seen next behind a position, and how it rises over some distance."""
    far_m = beam.far_m
    first_m, last_m = -1.0, far_m + _REACH_M
    count, sum_at, sum_square, sum_z, sum_both = 0, 0.0, 0.0, 0.0, 0.0
    at = far_m
    while at < last_m:
        z = _height_kernel(known, size_m, beam.east + beam.x * at, beam.north + beam.y * at)
        if not np.isnan(z):
            if first_m < 0.0:
                first_m, last_m = at, at + _BEHIND_M
                behind[_TO_FAR], behind[_FAR] = at - far_m, z
            away = at - first_m
            count += 1
            sum_at += away
            sum_square += away * away
            sum_z += z
            sum_both += away * z
        at += size_m / 2
    spread = count * sum_square - sum_at * sum_at
    if first_m >= 0.0:
        rise = (count * sum_both - sum_at * sum_z) / spread if spread > _EVEN_M2 else 0.0
        behind[_RISE] = rise


def warm_up() -> None:
    """Compile the kernel of this file."""
    known, positions = np.zeros((2, 2)), np.zeros((1, 2), np.int64)
    _crest_kernel(known, positions, np.array([-3.0, 0.0, 1.0]), 1.0, np.zeros((1, _BEHIND_FACTS)))
