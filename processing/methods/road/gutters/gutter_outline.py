"""The outline of covered gutters on the map: both long edges of each run."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from processing.map.drafting.needed_positions import needed_positions
from processing.methods.road.gutters.gutter_lids import GutterCover

_Floats = NDArray[np.float64]

_OFF_M = 0.01
"""A vertex that moves the outline by less is left out: lids are laid no more exactly. By trial."""


def edge_lines(covers: Sequence[GutterCover], longest_gap_m: float) -> Iterator[_Floats]:
    """Both edges of each stretch of covers that follow each other: (n, 3) float64, m.

    Parameters
    ----------
    covers : sequence of GutterCover
        Of one gutter, in order.
    longest_gap_m : float
        Between covers of one stretch.
    """
    stretch: list[GutterCover] = []
    for one in covers:
        if stretch and _gap(stretch[-1], one) > longest_gap_m:
            yield from _edges(stretch)
            stretch = []
        stretch.append(one)
    if stretch:
        yield from _edges(stretch)


def _gap(one: GutterCover, other: GutterCover) -> float:
    return other.along_m - one.along_m - (one.length_m + other.length_m) / 2


def _edges(stretch: Sequence[GutterCover]) -> Iterator[_Floats]:
    for first, last in ((0, 1), (3, 2)):
        positions = np.array([one.corners[k] for one in stretch for k in (first, last)])
        kept = needed_positions(positions, _OFF_M)
        yield positions[kept]
