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
from processing.methods.earthwork.surfaces.surfaces import SideHeights
from processing.methods.earthwork.volumes.volume_result import Registration

Floats = NDArray[np.float64]

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
    sides: tuple[SideHeights, SideHeights],
    registration: Registration | None,
    epochs: int,
) -> VolumeSpread:
    """What a volume's uncertainty is made of.

    Parameters
    ----------
    sides : (SideHeights, SideHeights)
        What the change was taken from.
    epochs : int
        How many of the sides were measured: 1 or 2.
    """
    area_m2 = float(change.inside[np.isfinite(change.change_m)].sum()) * change.grid.size_m**2
    tie_m = registration.sure_m[2] if registration is not None else _UNTIED_M
    if not math.isfinite(tie_m):
        tie_m = _UNTIED_M
    return VolumeSpread(
        noise_m3=_of_noise(change),
        set_up_m3=math.hypot(tie_m, _SURFACE_M * math.sqrt(epochs)) * area_m2,
        holes_m3=math.hypot(*(_of_holes(change, side) for side in sides)),
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


def _of_holes(change: ChangeGrid, side: SideHeights) -> float:
    """Within a hole all may be off to one side; one hole tells nothing of another."""
    from scipy.ndimage import label

    in_hole = np.nan_to_num(side.spread) > 0
    if not in_hole.any():
        return 0.0
    numbers, _ = label(in_hole)
    volumes = np.nan_to_num(side.spread) * change.inside * change.grid.size_m**2
    by_hole = np.bincount(numbers.ravel(), volumes.ravel())[1:]
    return float(np.sqrt(np.square(by_hole).sum()))
