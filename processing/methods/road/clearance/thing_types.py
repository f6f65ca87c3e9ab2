"""What hangs over a road: as the classes of its points say, else by its shape."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats

ThingType = Literal["tree", "wire", "sign", "pole", "building", "structure", "other"]

THINGS: Mapping[int, ThingType] = {
    4: "tree", 5: "tree", 6: "building", 14: "wire", 15: "structure", 65: "sign", 66: "pole",
}  # fmt: skip
"""By the code of its points' class."""

_LEAST_SHARE = 0.5
"""Of the points those of one class, which then tells what the whole is."""

_THIN_M, _LONG_M = 0.06, 0.3
"""Standard deviations across and along what is a line: half a hand's breadth, a metre's length."""

_FLAT_M, _WIDE_M = 0.05, 0.08
"""The same off and within what is flat."""

_LEVEL, _UPRIGHT = 0.9, 0.3
"""Vertical part of the normal of what lies level, and of what stands."""

_THICK_M = 0.1
"""Standard deviation in every direction of what is no surface: twigs and leaves."""

_FEWEST = 6
_MOST = 4000


class ThingKind(NamedTuple):
    """What a thing is, and whether a class said it (else its shape)."""

    type: ThingType
    is_classified: bool


def thing_of(codes: NDArray[np.uint8], local: Floats) -> ThingKind:
    """What points are of.

    Parameters
    ----------
    codes : (n,) uint8
        Their classes.
    local : (n, 3) float64
        m.
    """
    votes: dict[ThingType, int] = {}
    for code, count in zip(*np.unique(codes, return_counts=True), strict=True):
        if int(code) in THINGS:
            kind = THINGS[int(code)]
            votes[kind] = votes.get(kind, 0) + int(count)
    if votes:
        most = max(votes, key=lambda kind: votes[kind])
        if votes[most] >= _LEAST_SHARE * codes.size:
            return ThingKind(most, is_classified=True)
    return ThingKind(shape_of(local), is_classified=False)


def shape_of(local: Floats) -> ThingType:
    """What points are of by their shape alone.

    A thin line is a wire, what is level and flat a structure, what stands flat a sign; what is
    thick in every direction a tree.
    """
    if len(local) < _FEWEST:
        return "other"
    chosen = local[:: max(1, len(local) // _MOST)]
    spreads, axes = np.linalg.eigh(np.cov((chosen - chosen.mean(axis=0)).T))
    thin, wide, long = np.sqrt(np.maximum(spreads, 0.0)).tolist()
    if wide <= _THIN_M and long >= _LONG_M:
        return "wire"
    if thin <= _FLAT_M and wide >= _WIDE_M:
        upwards = abs(float(axes[2, 0]))
        if upwards >= _LEVEL:
            return "structure"
        return "sign" if upwards <= _UPRIGHT else "other"
    return "tree" if thin >= _THICK_M else "other"
