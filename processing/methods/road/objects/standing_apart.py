"""Of things that can't stand so near to each other the surest ones."""

from __future__ import annotations

import numpy as np

from processing.core.arrays import Flags, Floats


def stand_apart(feet: Floats, apart_m: float) -> Flags:
    """Which things stay if of two that stand nearer than a distance the one named first does.

    Parameters
    ----------
    feet : (n, 2) float64
        Where things stand, the surest first, m.
    apart_m : float

    Returns
    -------
    (n,) bool
        A thing goes only for one that stays itself.
    """
    from scipy.spatial import cKDTree

    is_kept = np.ones(len(feet), np.bool_)
    near = cKDTree(feet).query_pairs(apart_m, output_type="ndarray")
    near = near[np.hypot(*(feet[near[:, 0]] - feet[near[:, 1]]).T) < apart_m]
    for first, second in near[np.lexsort(near.T)].tolist():
        is_kept[second] &= not is_kept[first]
    return is_kept
