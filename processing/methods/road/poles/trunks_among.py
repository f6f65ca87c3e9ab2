"""Which shafts are trunks: how sure the search for trees is of what stands there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial.distance import cdist

from processing.core.arrays import Floats
from processing.core.monitor import Monitor
from processing.methods.road.objects.sparse_plan import SparsePlan
from processing.methods.road.trees.street_trees import StreetTree, TreeSettings, upright_things
from processing.recording.drive import Drive

EVERY_TRUNK = TreeSettings(1.5)
"""Trunks that share the crowns about a shaft with it: old trees too, whatever the tool for trees is
asked for."""

_ON_M = 0.2
"""An axis nearer to a shaft's is its own: half of the thickest shafts."""


def tree_chances(
    drives: Sequence[Drive],
    plan: SparsePlan,
    feet: Floats,
    monitor: Monitor,
    *,
    upright: Sequence[StreetTree] | None = None,
) -> Floats:
    """How sure the search for trees is of each shaft.

    Parameters
    ----------
    feet : (n, 2) float64
        Of shafts, m about the plan's origin.
    upright : sequence of StreetTree, optional
        What that search found of :data:`EVERY_TRUNK`; else it is asked about the feet.

    Returns
    -------
    (n,) float64
        0 where it finds no trunk.
    """
    if not len(feet):
        return np.zeros(0)
    if upright is None:
        upright = upright_things(drives, EVERY_TRUNK, monitor, about=feet)
    axes, sure = [], []
    for tree in upright:
        foot = tree.foot[:2] - plan.origin[:2]
        for stem in tree.trunk.stems:
            axes.append(foot + stem.base - tree.trunk.base)
            sure.append(tree.confidence)
    if not axes:
        return np.zeros(len(feet))
    away = cdist(feet, np.array(axes))
    return np.asarray(np.where(away < _ON_M, np.array(sure), 0.0).max(axis=1))
