"""From which intensity on a thing shines back at the laser as the face of a sign does.

Beads and prisms of a sign's face send back many times what a white wall does. Scales of intensity
differ between scanners and with the range, so what is bright is told by what else a head measured
at that range.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats

_SHARE, _STEPS_OF_SHARE = 0.7, 0.524
"""Quantile from which the spread follows, and how many standard deviations it lies above the
middle: where little rises beside the road up to a quarter of that may be faces of signs."""

CLASSES = 10
"""Of ranges: up to 4 m, and nine that each end half as far again, the last one beyond 100 m."""

_LEAST_POINTS = 1_500
"""Of a range class that tells its own limit; others take that of the class beside them: a few
hundred points that follow each other may be of one thing."""

_NEARER, _OTHER = 2.25, 1.5
"""By how much diffuse things are brighter in the range class before: the square of the ranges'
ratio where intensities aren't corrected for the range, nothing where they are; and by how much as
other things stand there. Where signs are most of what was met at a range, it looks brighter."""

_SPREADS = 4.5
"""How many standard deviations of all intensities lies above their middle what nothing diffuse
reaches. Reflectances beside a road run from 0.1 to 0.6 about 0.35: white is
about two steps above the middle, a sign's face of the least class at a thirtieth of its design
value (JIS Z 9117: 70 cd/lx/m² against 0.3 of a white wall) twenty and more."""


def bright_bounds(intensity: NDArray[np.uint16], classes: NDArray[np.int64]) -> Floats:
    """The least intensity of a bright point, for each class of ranges.

    Parameters
    ----------
    intensity : (n,) uint16
        Of points of upright things.
    classes : (n,) int64
        Range class of each.

    Returns
    -------
    (CLASSES,) float64
        Infinite where nothing was measured or a recording has no intensity.
    """
    bounds = np.full(CLASSES, np.inf)
    if intensity.size == 0 or not intensity.any():
        return bounds
    middles = _middles(intensity, classes)
    # One spread for all: far away a single wall may be all that there is.
    step = (float(np.quantile(intensity / middles[classes], _SHARE)) - 1.0) / _STEPS_OF_SHARE
    return np.asarray(middles * (1.0 + _SPREADS * step)) if step > 0 else bounds


def _middles(intensity: NDArray[np.uint16], classes: NDArray[np.int64]) -> Floats:
    """(CLASSES,) what diffuse things send back from each range class.

    From the class with the most points on, each next one is as bright as it can be beside it.
    """
    counts = np.bincount(classes, minlength=CLASSES)[:CLASSES]
    middles: Floats = np.full(
        CLASSES, float(np.median(intensity))
    )  # where no class has enough points
    known = counts >= _LEAST_POINTS
    for number in np.flatnonzero(known).tolist():
        middles[number] = float(np.median(intensity[classes == number]))
    middles = np.maximum(middles, 1.0)
    most = int(counts.argmax())
    for way, low, high in ((1, _NEARER * _OTHER, _OTHER), (-1, _OTHER, _NEARER * _OTHER)):
        beside = middles[most]
        number = most + way
        while 0 <= number < CLASSES:
            own = middles[number] if known[number] else beside
            beside = middles[number] = min(max(own, beside / low), beside * high)
            number += way
    return middles
