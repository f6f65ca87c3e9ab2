"""How much hangs together: cubes that touch, joined, and what such a part looks like."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.methods.noise.features.cell_kernels import (
    COUNT,
    SUMS,
    SURE,
    CellLevel,
    cell_sums_kernel,
    join_kernel,
    largest_kernel,
    spread_kernel,
)

PART_FEATURES = 5

_LEAST_LENGTH_M = 1e-9
"""Keeps shares of a part that is a single point finite."""

_LEAST_CUBES = 0.1
"""Keeps the logarithm of its length finite; the trees learned with it."""


@dataclass(frozen=True)
class Parts:
    """The parts of a cloud whose cubes of one size touch by a face, an edge or a corner.

    Attributes
    ----------
    numbers : (c,) int32
        Each cube's part.
    sizes : (p,) float64
        Points of each part.
    features : (p, PART_FEATURES) float32
        Of each part: log2 of its points and of its sure points, log2 of its length in cubes, and
        how much it is a line and a plane, 0 to 1.
    """

    numbers: NDArray[np.int32]
    sizes: NDArray[np.float64]
    features: NDArray[np.float32]


def sure_counts(level: CellLevel) -> NDArray[np.float64]:
    """How many sure points there are in the part to which each cube belongs.

    Cubes join only through cubes that hold such points. Others take the largest part beside them,
    0 where there is none.

    Returns
    -------
    (c,) float64
    """
    joins = level.sums[:, SURE] > 0
    parents = np.arange(level.codes.size)
    join_kernel(level, joins, parents)
    totals = np.bincount(parents, weights=level.sums[:, SURE], minlength=parents.size)
    found = np.empty(parents.size)
    largest_kernel(level, joins, totals[parents].astype(np.float64), found)
    return found


def parts_of(level: CellLevel, joins: NDArray[np.bool_] | None = None) -> Parts:
    """The parts of everything that was measured, or of the cubes that join, (c,) bool.

    Cubes that don't join are parts of their own.
    """
    parents = np.arange(level.codes.size)
    join_kernel(level, np.ones(parents.size, np.bool_) if joins is None else joins, parents)
    is_root = parents == np.arange(parents.size)  # a part's first cube gives it its number
    numbers = (np.cumsum(is_root, dtype=np.int32) - 1)[parents]
    sums = np.zeros((int(is_root.sum()), SUMS))
    cell_sums_kernel(level.sums, numbers, sums)
    spreads = np.empty((sums.shape[0], 3))
    spread_kernel(sums, spreads)
    length = np.maximum(spreads[:, 0], _LEAST_LENGTH_M)
    features = np.column_stack(
        [
            np.log2(1 + sums[:, COUNT]),
            np.log2(1 + sums[:, SURE]),
            np.log2(_LEAST_CUBES + spreads[:, 0] / level.side),
            (spreads[:, 0] - spreads[:, 1]) / length,
            (spreads[:, 1] - spreads[:, 2]) / length,
        ]
    )
    return Parts(numbers, sums[:, COUNT], features.astype(np.float32))
