"""Lines that were drawn sheet by sheet: ends on both sides of a sheet's edge that don't meet."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence

import numpy as np
from scipy.spatial import cKDTree

from processing.core.arrays import Floats
from processing.map.catalogue import Geometry
from processing.map.feature import Feature
from processing.map.quality.findings import Finding
from processing.map.quality.plan_shapes import SAME_LEVEL_M, PlanShapes
from processing.map.quality.topology import GAP_M, line_ends

SHEET_EAST_M, SHEET_NORTH_M = 400.0, 300.0
"""A sheet of level 500 (作業規程の準則, 国土基本図図郭); edges are at multiples of them."""

EDGE_REACH_M = 1.0
"""Two millimetres at 1:500: what two operators miss each other by where their sheets meet."""

_ON = -math.cos(math.radians(45.0))
"""Ends that go on into each other look away from each other."""

_CODE = re.compile(r"EPSG:(\d+)")
_PLANE = (range(6669, 6688), range(2443, 2462), range(30161, 30180))
"""Plane rectangular systems of Japan by datum: JGD2011, JGD2000, Tokyo."""


def has_sheets(crs: str) -> bool:
    """Whether maps in a reference system are divided into sheets."""
    found = _CODE.fullmatch(crs)
    return found is not None and any(int(found[1]) in codes for codes in _PLANE)


def sheet_gaps(features: Sequence[Feature]) -> Iterator[Finding]:
    """Pairs of ends of one kind across a sheet's edge, farther apart than a gap within a sheet."""
    lines = [one for one in features if one.geometry is Geometry.LINE]
    shapes = PlanShapes.of(lines)
    ends, outward, owners = line_ends(shapes)
    if not len(ends):
        return
    sheets, near = _sheets(ends[:, :2] + shapes.origin)
    numbers = np.flatnonzero(near)
    pairs = cKDTree(ends[numbers, :2]).query_pairs(EDGE_REACH_M, output_type="ndarray")
    for one, other in sorted(map(tuple, numbers[pairs].tolist())):
        apart = math.dist(ends[one, :2], ends[other, :2])
        goes_on = float(outward[one] @ outward[other]) <= _ON
        is_level = abs(ends[one, 2] - ends[other, 2]) <= SAME_LEVEL_M
        if apart <= GAP_M or not goes_on or not is_level or (sheets[one] == sheets[other]).all():
            continue
        both = shapes.features[owners[one]], shapes.features[owners[other]]
        middle = (ends[one] + ends[other]) / 2
        ids = tuple(dict.fromkeys(each.id for each in both))
        place = shapes.position(*middle.tolist())
        yield Finding("sheet_gap", ids, both[0].kind, place, apart)


def _sheets(xy: Floats) -> tuple[Floats, Floats]:
    """On which sheet each place lies, and whether an edge is within reach."""
    size = np.array([SHEET_EAST_M, SHEET_NORTH_M])
    inside = np.mod(xy, size)
    near = (np.minimum(inside, size - inside) <= EDGE_REACH_M).any(axis=1)
    return np.floor(xy / size), near
