"""Chance that depends on a seed and a place alone: the same street whatever is built first."""

from __future__ import annotations

import zlib

import numpy as np
from numpy.random import Generator

_LONGEST = 1 << 32


def chance(seed: int, *position: int | str) -> Generator:
    """A stream of random numbers of its own for every place.

    Parameters
    ----------
    seed : int
        Of the whole street or site.
    position : int or str
        What is drawn, and where: ``chance(7, "trees", 12, -1)``. Numbers may be negative.
    """
    words = [
        zlib.crc32(one.encode()) if isinstance(one, str) else one % _LONGEST for one in position
    ]
    return np.random.default_rng([seed % _LONGEST, *words])
