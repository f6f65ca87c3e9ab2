"""From which intensity on a thing shines back at the laser as the face of a sign does.

Beads and prisms of a sign's face send back many times what a white wall does. Scales of intensity
differ between scanners and with the range, so what is bright is told by what else a head measured
at that range.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats

_LOW, _MIDDLE, _HIGH = 0.3, 0.5, 0.7
_STEPS = 1.049
"""Quantiles from which the spread follows, and how many standard deviations lie between the outer
ones. Where little rises beside the road up to a quarter may be faces of signs; the dark side alone
would follow what is seen askew, the bright side alone is narrow where leaves are most of all."""

CLASSES = 10
"""Of ranges: up to 4 m, and nine that each end half as far again, the last one beyond 100 m."""

_CLASS_RATIO = 1.5
"""Between ranges of neighbouring classes."""

_FEWEST_POINTS = 200
"""Of a range class that has a say in what is bright; others take what the law of the head says."""

_POWERS = np.arange(0.0, 2.01, 0.1)
"""Of the range by which diffuse things grow darker: 0 where a maker has taken that out, 2 where
nothing was done; scales that are a root or a logarithm of the strength lie between."""

_OTHER = 1.5
"""By how much what stands at one range is brighter than the law says: leaves, where nearer things
are darker. Where signs are most of what was met at a range, it looks brighter still; where it looks
darker, panes and tyres are most of it and what else stands there is as bright as elsewhere."""

SHINING = 4.5
"""How many standard deviations of all intensities lies above their middle what nothing diffuse
reaches. Reflectances beside a road run from 0.1 to 0.6 about 0.35: white is
about two steps above the middle, a sign's face of the least class at a thirtieth of its design
value (JIS Z 9117: 70 cd/lx/m² against 0.3 of a white wall) twenty and more."""


class Brightness(NamedTuple):
    """What a head measures on diffuse things that stand, for each class of ranges.

    Attributes
    ----------
    middles : (CLASSES,) float64
        Intensity of the middle one.
    steps : (CLASSES,) float64
        Their standard deviation; infinite where nothing was measured or a recording has no
        intensity.
    """

    middles: Floats
    steps: Floats

    def bounds(self) -> Floats:
        """(CLASSES,) float64: the least intensity of a bright point; infinite: none is."""
        return np.asarray(self.middles + SHINING * self.steps)


NO_BRIGHTNESS = Brightness(np.zeros(CLASSES), np.full(CLASSES, np.inf))
"""Of a head that measures no intensity."""


def brightness_of(intensity: NDArray[np.uint16], classes: NDArray[np.int64]) -> Brightness:
    """What is usual to a head, and how far things differ.

    Parameters
    ----------
    intensity : (n,) uint16
        Of points of upright things.
    classes : (n,) int64
        Range class of each.
    """
    if intensity.size == 0 or not intensity.any():
        return NO_BRIGHTNESS
    middles = _middles(intensity, classes)
    # One spread for all: far away a single wall may be all that there is.
    low, middle, high = np.quantile(intensity / middles[classes], (_LOW, _MIDDLE, _HIGH)).tolist()
    step = (high - low) / _STEPS
    return Brightness(middles * middle, middles * step) if step > 0 else NO_BRIGHTNESS


def _middles(intensity: NDArray[np.uint16], classes: NDArray[np.int64]) -> Floats:
    """(CLASSES,) what diffuse things send back from each range class."""
    counts = np.bincount(classes, minlength=CLASSES)[:CLASSES]
    known = np.flatnonzero(counts >= _FEWEST_POINTS)
    if not known.size:
        return np.full(CLASSES, max(float(np.median(intensity)), 1.0))
    own = np.array([float(np.median(intensity[classes == number])) for number in known])
    own = np.maximum(own, 1.0)
    middles = _falling(known, own, counts[known].astype(np.float64))
    middles[known] = np.clip(own, middles[known], _OTHER * middles[known])
    return middles


def _falling(known: NDArray[np.int64], own: Floats, counts: Floats) -> Floats:
    """(CLASSES,) the power of the range that lies nearest to what classes tell, each by its points.

    Distances are those of logarithms, not squared: a class that holds something else than others
    doesn't bend the law.
    """
    every = np.arange(CLASSES) * np.log(_CLASS_RATIO)
    best = (np.inf, 0.0, 0.0)
    for power in _POWERS.tolist():
        level = np.log(own) + power * every[known]
        order = np.argsort(level, kind="stable")
        share = np.cumsum(counts[order])
        middle = float(level[order[int(np.searchsorted(share, share[-1] / 2))]])
        off = float((counts * np.abs(level - middle)).sum())
        if off < best[0]:
            best = (off, middle, power)
    return np.asarray(np.exp(best[1] - best[2] * every))
