"""How far off a volume may be: noise of points, errors of whole set-ups, and filled holes.

Noise of single points averages out over thousands of cells. What a set-up of the scanner or the
tie of two epochs is off doesn't: a millimetre over a hectare is ten cubic metres. And nobody knows
what the ground did in a hole; all of it may lie to one side.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.volumes.volume_result import Registration

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

COVERAGE = 2.0
"""Standard deviations that are stated: the truth lies within them in 95 of 100 cases."""

_UNTIED_M = 0.005
"""How far off the tie of epochs is thought to be where stable ground doesn't tell it; by judgement,
what targets of a tripod scanner are set up to."""

_SURFACE_M = 0.002
"""Of what lies over all of an epoch, as simulated sites of known ground show."""

_SIGMA_PER_MEDIAN = 1.4826
"""Standard deviation of a normal distribution over its median absolute deviation."""

_BEND_VARIANCE = 1.5
"""Of a value less the mean of its two neighbours, in variances of one: 1 + 2 · (1/2)²."""

_STEP_M = 0.5
"""Between places whose distance from points is looked up: a cell of holes."""


@dataclass(frozen=True)
class VolumeSpread:
    """Standard deviations of a volume by their cause, m³.

    Attributes
    ----------
    noise_m3 : float
        Of points, as cells differ from those about them.
    set_up_m3 : float
        Of the tie of both epochs, and of what lies over all of an epoch: the scanner's scale and
        zero, and low growth that passes for ground; 2 mm, as simulated sites of known ground show.
    holes_m3 : float
        Of ground that was filled in.
    """

    noise_m3: float
    set_up_m3: float
    holes_m3: float

    @property
    def stated_m3(self) -> float:
        """What is stated beside a volume."""
        return COVERAGE * math.hypot(self.noise_m3, self.set_up_m3, self.holes_m3)


def volume_spread(
    change: ChangeGrid,
    counted: Mask,
    spread: Floats,
    registration: Registration | None,
    epochs: int,
) -> VolumeSpread:
    """What a volume's uncertainty is made of.

    Parameters
    ----------
    counted : (rows, columns) bool
        Cells whose change was summed: what all of an epoch is off by counts nowhere else.
    spread : (rows, columns) float64
        Standard deviation of the change where it was filled in, m; 0 where it was measured.
    epochs : int
        How many of the sides were measured: 1 or 2.
    """
    known = counted & np.isfinite(change.change_m)
    area_m2 = float(change.inside[known].sum(dtype=np.float64)) * change.grid.size_m**2
    tie_m = registration.sure_m[2] if registration is not None else _UNTIED_M
    if not math.isfinite(tie_m):
        tie_m = _UNTIED_M
    return VolumeSpread(
        noise_m3=_of_noise(change),
        set_up_m3=math.hypot(tie_m, _SURFACE_M * math.sqrt(epochs)) * area_m2,
        holes_m3=_of_holes(change, spread),
    )


def _of_noise(change: ChangeGrid) -> float:
    values = np.where(change.is_measured, change.change_m, np.nan).astype(np.float64)
    bends = [(z[1:-1] - (z[2:] + z[:-2]) / 2).ravel() for z in (values, values.T) if z.shape[0] > 2]
    known = np.concatenate([bend[np.isfinite(bend)] for bend in bends]) if bends else np.empty(0)
    if known.size == 0:
        return 0.0
    sigma_m = _SIGMA_PER_MEDIAN * float(np.median(np.abs(known))) / math.sqrt(_BEND_VARIANCE)
    cells = float(change.inside[change.is_measured].sum())
    return sigma_m * change.grid.size_m**2 * math.sqrt(cells)


def _of_holes(change: ChangeGrid, spread: Floats) -> float:
    """Errors of filled ground, which are alike along the works and over the width of a hole.

    What hides ground, a bank or a crest, goes on from hole to hole, and a rim doesn't show a ditch
    or a heap in any of them: an error is shared by a strip as long as the site, the root of its
    area, and twice as wide as the distance from what was measured. In a strip of width w whose
    deviations grow with that distance r, a r, and are of one sign all along its length l, the sum
    is a l w²/4; cells of area c that share 2 l r each sum to the same, since over both halves the
    integral of (a r)² 2 l r is a² l w⁴/16 per metre. Together they are never more than if all erred
    to one side.
    """
    from scipy.ndimage import distance_transform_edt

    deviation = np.where(np.isfinite(change.change_m), np.nan_to_num(spread), 0.0)
    in_hole = deviation > 0
    if not in_hole.any():
        return 0.0
    size_m = change.grid.size_m
    step = max(1, round(_STEP_M / size_m))
    away_m = np.asarray(distance_transform_edt(in_hole[::step, ::step])) * (step * size_m)
    away_m = away_m.repeat(step, axis=0).repeat(step, axis=1)[
        : in_hole.shape[0], : in_hole.shape[1]
    ]
    # Gaps narrower than a step are at least a cell wide.
    away_m = np.maximum(away_m, size_m)
    long_m = math.sqrt(float(change.inside.sum(dtype=np.float64))) * size_m
    shared_m2 = long_m * 2 * away_m
    volumes = deviation * change.inside * size_m
    to_one_side_m3 = float(volumes.sum(dtype=np.float64)) * size_m
    return min(float(np.sqrt((np.square(volumes) * shared_m2).sum())), to_one_side_m3)
