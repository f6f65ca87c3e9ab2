"""Whether a section about an axis is square: posts, piers and corners of houses are, trunks aren't.

Noise and distance don't change it.
"""

from __future__ import annotations

import numpy as np

from processing.core.arrays import Floats

_FEWEST = 12
"""Points from which a section's shape is told: twice what is fitted to them, and more."""

_SURE = 2.0
"""Standard deviations taken off a section's corners: what noise alone makes."""

_SQUARE = 0.1
"""Of the radius by which corners of square posts, which go four times in and out about the axis,
stand off a circle fitted to them; 0.14 by integration, less where edges are rounded."""


def square_share(beside: Floats, radii: Floats) -> float:
    """How far a section goes in and out four times about its axis, over what a square does.

    Parameters
    ----------
    beside : (n, 2) float64
        Points about the axis, m.
    radii : (n,) float64
        Of the circle at their heights.

    Returns
    -------
    float
        0 to 1: the amplitude of the radius' fourth harmonic less what noise alone makes.
    """
    if len(beside) < _FEWEST:
        return 0.0
    turn = np.arctan2(beside[:, 1], beside[:, 0])
    off = np.hypot(beside[:, 0], beside[:, 1]) - radii
    # A circle a little aside or too wide is none of it.
    waves = [np.ones(len(off))]
    for times in (1, 4):
        waves += [np.cos(times * turn), np.sin(times * turn)]
    design = np.column_stack(waves)
    cofactors = np.linalg.inv(design.T @ design + 1e-6 * np.eye(len(waves)))
    found = cofactors @ design.T @ off
    scatter = float(((off - design @ found) ** 2).sum()) / (len(off) - len(waves))
    unsure = float(np.sqrt(scatter * np.trace(cofactors[3:, 3:])))
    sure = float(np.hypot(found[3], found[4])) - _SURE * unsure
    return min(max(sure / float(np.median(radii)), 0.0) / _SQUARE, 1.0)
