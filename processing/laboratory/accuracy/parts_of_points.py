"""Points that hang together: what a person takes for one thing when marking it."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from processing.core.arrays import Floats, Integers


def parts_of_points(xyz: Floats, cell_m: float, link_m: float) -> Integers:
    """(n,) int64 the number of the part that each point is of.

    Parameters
    ----------
    xyz : (n, 3) float64
        m.
    cell_m : float
        Points of one cell so wide hang together.
    link_m : float
        As do cells whose corners are no farther apart.
    """
    cells, cell_of = np.unique(np.floor(xyz / cell_m), axis=0, return_inverse=True)
    pairs: Integers = cKDTree(cells * cell_m).query_pairs(link_m, output_type="ndarray")
    shape = (len(cells), len(cells))
    graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=shape)
    part: Integers = connected_components(graph, directed=False)[1].astype(np.int64)
    return part[cell_of.ravel()]
