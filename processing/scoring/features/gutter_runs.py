"""True gutters as runs of lids, cut into the slots of 0.6 m in which the thesis counts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats
from processing.scoring.features.line_positions import middle_positions
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.features.object_matches import is_in_span, shows_enough

SLOT_M = 0.6
"""Mms.md 7.5: one slot is one usual lid."""

JOINT_M = 0.05
"""Between lids: a slot's middle so near to a lid is on it."""

LEAST_UNCOVERED = 0.5
"""Soil, leaves and grass hide a lid of which less is free."""

LEAST_SCANNED = 0.5
"""Points must lie on half of a lid to show its corners and joints."""

_BESIDE_M = 1.0  # lids of one run, where the truth has no runs
_MOST_CORNERS = 2

# Any: shapely's geometries.
Areas = NDArray[Any]


@dataclass(frozen=True)
class GutterSlots:
    """The slots of one gutter.

    Attributes
    ----------
    axis : (n, 3) float64
        Along the middle of its lids, m.
    slots : (k, 3) float64
        Middles of its slots, m.
    has_lid : (k,) bool
        Whether a lid or a grating lies there.
    is_asked : (k,) bool
        Whether the points show what lies there.
    """

    axis: Floats
    slots: Floats
    has_lid: Flags
    is_asked: Flags


def is_seen(truth: MappedFile, lid: MappedFeature) -> bool:
    """Whether a lid has to be found: passed by the vehicle, mostly free and mostly scanned.

    Raises
    ------
    BadFile
        A share is no number.
    """
    return (
        is_in_span(lid)
        and shows_enough(truth, lid, "uncovered", LEAST_UNCOVERED)
        and shows_enough(truth, lid, "scanned", LEAST_SCANNED)
    )


def areas_of(features: Sequence[MappedFeature]) -> Areas:
    """The features' outlines in plan, as shapely polygons."""
    import shapely

    made = [shapely.Polygon(one.xyz[:, :2]) for one in features]
    return np.asarray(shapely.make_valid(np.array(made, dtype=object)))


def runs_of(truth: MappedFile, lids: Sequence[MappedFeature]) -> list[GutterSlots]:
    """The runs of true lids: as the truth has them, or else lids that lie beside each other.

    Raises
    ------
    BadFile
        A fact is no number.
    """
    areas = areas_of(lids)
    seen = np.array([is_seen(truth, one) for one in lids], np.bool_)
    named = [one.facts.get("run") for one in lids]
    groups: dict[object, list[int]] = {}
    beside = _beside(areas) if None in named else named
    for number, name in enumerate(beside):
        groups.setdefault(str(name), []).append(number)
    return [
        _run([lids[i] for i in members], areas[members], seen[members])
        for members in (_order_members(truth, lids, numbers) for numbers in groups.values())
    ]


def _beside(areas: Areas) -> list[object]:
    """By lid, the group of lids that are connected through near ones."""
    import shapely
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    pairs = shapely.STRtree(areas).query(areas, predicate="dwithin", distance=_BESIDE_M)
    table = coo_array((np.ones(pairs.shape[1]), tuple(pairs)), shape=(len(areas), len(areas)))
    return list(connected_components(table, directed=False)[1].tolist())


def _order_members(
    truth: MappedFile, lids: Sequence[MappedFeature], members: list[int]
) -> list[int]:
    """Members of a run from one end to the other."""
    positions = [truth.number(lids[number], "order") for number in members]
    if np.isnan(positions).any():
        middles = np.array([lids[number].xyz[:, :2].mean(axis=0) for number in members])
        away = middles - middles.mean(axis=0)
        positions = list(away @ np.linalg.svd(away, full_matrices=False)[2][0])
    return [members[position] for position in np.argsort(positions, kind="stable")]


def _run(lids: Sequence[MappedFeature], areas: Areas, seen: Flags) -> GutterSlots:
    import shapely

    axis = _axis(lids)
    slots = middle_positions(axis, SLOT_M)
    (_, nearest), away_m = shapely.STRtree(areas).query_nearest(
        shapely.points(slots[:, :2]), return_distance=True, all_matches=False
    )
    return GutterSlots(axis, slots, away_m <= JOINT_M, seen[nearest])


def _axis(lids: Sequence[MappedFeature]) -> Floats:
    """From the far end of the first lid to that of the last, through the middles of all."""
    middles = np.array([lid.xyz.mean(axis=0) for lid in lids])
    if len(lids) == 1:
        sides = np.roll(lids[0].xyz, -1, axis=0) - lids[0].xyz
        way = sides[np.hypot(*sides[:, :2].T).argmax()]
        first, last = -way, way
    else:
        first, last = middles[0] - middles[1], middles[-1] - middles[-2]
    ends = [
        _end(lid.xyz, middle, way)
        for lid, middle, way in ((lids[0], middles[0], first), (lids[-1], middles[-1], last))
    ]
    return np.vstack([ends[0], middles, ends[1]])


def _end(outline: Floats, middle: Floats, way: Floats) -> Floats:
    """Where a lid ends on a way from its middle: as far as its two outermost corners are."""
    long = max(float(np.hypot(*way[:2])), 1e-9)
    along = (outline - middle)[:, :2] @ way[:2] / long
    outermost = np.sort(along)[-_MOST_CORNERS:].mean()
    return np.asarray(middle + way / long * outermost)
