"""Gratings as they were measured among the covers that a gutter's regular joints tell of.

A row of joints says only how long its covers are; where the surface is open all over a rectangle,
that says what lies there, and how large it is. Gratings beside all gutters are catch basins.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.methods.road.gutters.grating_facts import GratingFound
from processing.methods.road.gutters.gutter_axis import GutterAxis
from processing.methods.road.gutters.gutter_lids import GutterCover

_Floats = NDArray[np.float64]

# "By trial": chosen while the tool was made; no measurement of the single value is recorded.

_ON_SHARE = 0.5
"""Of a grating: so much lies on the gutter's covers. By trial."""

_CLASH = 0.3
"""Of the shorter one: what overlaps so much along the gutter cannot both be. By trial."""

_SAME = 0.5
"""Of both together: what overlaps so much is one, as in the scores of lids
(`processing.scoring`)."""

_AHEAD_M = 0.1
"""To either side of a place, for the direction of the axis there."""


@dataclass(frozen=True)
class RatedCovers:
    """Covers of one gutter in order, and how sure each is."""

    covers: tuple[GutterCover, ...]
    sure: _Floats


def add_gratings(
    axis: GutterAxis, own: RatedCovers, gratings: Sequence[GratingFound]
) -> tuple[RatedCovers, tuple[GratingFound, ...]]:
    """Covers of a gutter with the gratings that lie on it, and the gratings that do not."""
    covers, sure = list(own.covers), own.sure.tolist()
    beside: list[GratingFound] = []
    for found in gratings:
        one = _on_gutter(axis, covers, found)
        if one is None:
            beside.append(found)
            continue
        clashing = [k for k, other in enumerate(covers) if _clash(one, other)]
        same = [k for k in clashing if covers[k].is_grating and _are_same(one, covers[k])]
        if same:
            sure[same[0]] = max(sure[same[0]], found.confidence)
        elif all(sure[k] < found.confidence for k in clashing):
            covers = [*(other for k, other in enumerate(covers) if k not in clashing), one]
            sure = [*(value for k, value in enumerate(sure) if k not in clashing), found.confidence]
    order = sorted(range(len(covers)), key=lambda k: covers[k].along_m)
    kept = RatedCovers(tuple(covers[k] for k in order), np.array([sure[k] for k in order]))
    return kept, tuple(beside)


def _on_gutter(
    axis: GutterAxis, covers: Sequence[GutterCover], found: GratingFound
) -> GutterCover | None:
    """A grating as a cover of a gutter; None where it lies beside all its covers."""
    along, _, _ = axis.coordinates_of(found.corners.mean(axis=0)[None], found.length_m)
    if not np.isfinite(along[0]):
        return None
    at = float(along[0])
    near = [one for one in covers if abs(one.along_m - at) < one.length_m + found.length_m]
    if sum(found.share_in(one.corners) for one in near) < _ON_SHARE:
        return None
    ahead = np.diff(
        axis.positions(np.array([at - _AHEAD_M, at + _AHEAD_M]), np.zeros(2))[:, :2], axis=0
    )[0]
    sides = np.roll(found.corners, -1, axis=0) - found.corners
    first = int(np.argmax(sides[:, :2] @ ahead / np.hypot(*sides[:, :2].T)))
    long, wide = (float(np.hypot(*sides[(first + k) % 4, :2])) for k in range(2))
    return GutterCover(
        np.roll(found.corners, -first, axis=0),
        is_grating=True,
        is_bridged=False,
        width_m=wide,
        length_m=long,
        on_top=0,
        below=0,
        along_m=at,
        seen=(0, 0),
        rough_m=0.0,
        points=(*found.points[first:], *found.points[:first]),
        drives=(found.drive,) * 4,
    )


def _shared(one: GutterCover, other: GutterCover) -> float:
    away = abs(one.along_m - other.along_m)
    return (one.length_m + other.length_m) / 2 - away


def _clash(one: GutterCover, other: GutterCover) -> bool:
    return _shared(one, other) > _CLASH * min(one.length_m, other.length_m)


def _are_same(one: GutterCover, other: GutterCover) -> bool:
    shared = min(_shared(one, other), one.length_m, other.length_m)
    return shared > _SAME * (one.length_m + other.length_m - shared)
