"""Which points lie on found curbs, on the carriageway before them, and level behind them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from processing.core.arrays import Flags, Floats, Integers

_EDGE_STEP_M = 0.1
"""Between the places of edges that are looked for near a point."""

_CURB_REACH_M = 0.3
"""From the middle of an edge's place."""

_TOP_M = 0.12
"""Width of the narrowest stone (JIS A 5371, 地先境界ブロック A); what lies beyond may be paving."""

_EDGE_M = 0.01
"""Before the lower edge and behind the upper one on the face: what stays of the tools' own error of
an edge."""

_LEVEL_M = 0.03
"""Above and below the upper edge: three times the noise of a scanner on a vehicle."""

_ROAD_M, _STEEPEST = 1.5, 0.06
"""How far before a curb the carriageway surely reaches, half a lane, and how steeply it rises there
at most, as aprons of gutters do."""

_BEHIND_M = 3.0
"""How far behind a curb no carriageway is, where the ground is level with its top: of 442,000
such points of three streets by another simulator and one of the own, no street has more than one in
a thousand."""

_PIECE_M = 5.0
"""Of a curb, that moves as one: passes drift by a centimetre in some seconds."""

_APART_M = 0.08
"""How far passes of one survey lie apart at most before they are registered."""

_LEAST_FACE_M, _OF_A_FACE = 0.04, 0.6
"""Height of a face that can be told from the road, and how much of it about its middle is asked:
rounded edges and the corner below lie elsewhere."""

_LEAST_POINTS = 20


class CurbEdges(NamedTuple):
    """The two edges of a piece of curb.

    Attributes
    ----------
    upper, lower : (n, 3) float64
        m, project CRS.
    confidence : float
    """

    upper: Floats
    lower: Floats
    confidence: float


class CurbSamples(NamedTuple):
    """Places along curbs.

    ``tree``: of them in plan; ``uppers``, ``lowers`` (k, 3): on both edges, m about an origin near
    by; ``normals`` (k, 2): unit vectors away from the road; ``confidence`` (k,); ``pieces`` (k,)
    int64: the piece of 5 m that each is of.
    """

    tree: cKDTree
    uppers: Floats
    lowers: Floats
    normals: Floats
    confidence: Floats
    pieces: Integers


def curb_samples(curbs: Sequence[CurbEdges], origin: Floats) -> CurbSamples | None:
    """Places along curbs, None without any; ``origin`` (3,) m, project CRS."""
    if not curbs:
        return None
    parts, pieces = [], 0
    for one in curbs:
        uppers, ways = _along(one.upper - origin, _EDGE_STEP_M)
        beside, _ = _along(one.lower - origin, _EDGE_STEP_M)
        lowers = beside[cKDTree(beside[:, :2]).query(uppers[:, :2])[1]]
        across = np.column_stack([-ways[:, 1], ways[:, 0]])
        # The edges of an upright face lie over each other in places: most of them tell the side.
        if np.sum((uppers - lowers)[:, :2] * across) < 0:
            across = -across
        own = pieces + (np.arange(len(uppers)) * _EDGE_STEP_M // _PIECE_M).astype(np.int64)
        pieces = int(own[-1]) + 1
        parts.append((uppers, lowers, across, np.full(len(uppers), one.confidence), own))
    columns = (np.concatenate(one) for one in zip(*parts, strict=True))
    uppers, lowers, normals, confidence, of_pieces = columns
    return CurbSamples(cKDTree(uppers[:, :2]), uppers, lowers, normals, confidence, of_pieces)


def _along(line: Floats, step_m: float) -> tuple[Floats, Floats]:
    """Places along a line and the way there in plan, (n, 3) and (n, 2)."""
    lengths = np.hypot(*np.diff(line[:, :2], axis=0).T)
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    at = np.linspace(0.0, ends[-1], max(2, round(ends[-1] / step_m) + 1))
    places = np.column_stack([np.interp(at, ends, line[:, axis]) for axis in range(3)])
    ways = np.gradient(places[:, :2], axis=0)
    return places, ways / np.maximum(np.hypot(*ways.T), 1e-9)[:, None]


def moved_to(curbs: CurbSamples, places: Floats) -> CurbSamples:
    """Curbs where a recording itself sees them.

    An edge is measured once for all passes, which lie centimetres apart until they are registered:
    a piece's height moves to the middle of what lies flat on the stone behind its edge, its face to
    the middle of what lies on it. Pieces of which there is too little, or no surface, stay.

    Parameters
    ----------
    places : (n, 3) float64
        Of one recording, about the origin of the samples.
    """
    near, which = near_samples(curbs.tree, places[:, :2], _CURB_REACH_M)
    off = _Offsets.of(curbs, places[near], which)
    is_top = (off.behind > _EDGE_M) & (off.behind < _TOP_M) & (np.abs(off.above) < _APART_M)
    up = _middles(curbs.pieces, which[is_top], off.above[is_top])
    share = 1 + (off.above - up[which]) / np.maximum(off.high, _LEAST_FACE_M)
    is_face = (np.abs(share - 0.5) < _OF_A_FACE / 2) & (off.high > _LEAST_FACE_M)
    behind_face = off.behind + (1 - share) * off.face
    is_face &= np.abs(behind_face) < _APART_M
    back = _middles(curbs.pieces, which[is_face], behind_face[is_face])
    shift = np.column_stack([back[:, None] * curbs.normals, up])
    uppers = curbs.uppers + shift
    return curbs._replace(tree=cKDTree(uppers[:, :2]), uppers=uppers, lowers=curbs.lowers + shift)


class _Offsets(NamedTuple):
    """Of points from the samples of curbs that are nearest to them, m.

    ``behind`` (n,): the upper edge; ``above`` (n,): it; ``face``, ``high`` (n,): how far the lower
    edge lies before and below the upper one.
    """

    behind: Floats
    above: Floats
    face: Floats
    high: Floats

    @classmethod
    def of(cls, curbs: CurbSamples, places: Floats, which: Integers) -> _Offsets:
        """Offsets of places, (n, 3), from the samples of numbers ``which``, (n,)."""
        over, normals = places - curbs.uppers[which], curbs.normals[which]
        face = (curbs.uppers - curbs.lowers)[which]
        behind, before = ((one[:, :2] * normals).sum(axis=1) for one in (over, face))
        return cls(behind, over[:, 2], before, face[:, 2])


def _middles(pieces: Integers, which: Integers, values: Floats) -> Floats:
    """(k,) for each sample the median of its piece's values; 0 where they tell no surface.

    Parameters
    ----------
    pieces : (k,) int64
        Of samples.
    which : (n,) int64
        The sample of each value.
    """
    own = pieces[which]
    order = np.argsort(own, kind="stable")
    found = np.zeros(int(pieces.max()) + 1)
    starts = np.flatnonzero(np.diff(own[order], prepend=-1))
    for part in np.split(order, starts[1:]):
        if part.size >= _LEAST_POINTS:
            low, middle, high = np.percentile(values[part], (25, 50, 75))
            found[own[part[0]]] = middle if high - low < _LEVEL_M else 0.0
    return found[pieces]


class NearCurbs:
    """Places and the samples of curbs that are nearest to them.

    Parameters
    ----------
    places : (n, 3) float64
        About the origin of the samples.
    """

    def __init__(self, curbs: CurbSamples, places: Floats) -> None:
        self._count = len(places)
        self._near, which = near_samples(curbs.tree, places[:, :2], max(_ROAD_M, _BEHIND_M))
        over = (places[self._near] - curbs.uppers[which])[:, :2]
        self._away = np.hypot(*over.T)
        self._off = _Offsets.of(curbs, places[self._near], which)
        self._confidence = curbs.confidence[which]

    def chances_on_curbs(self) -> Floats:
        """(n,) confidence of the curb whose face or top a place lies on; 0 where on none."""
        off = self._off
        is_on_top = (off.behind >= 0) & (off.behind <= _TOP_M) & (np.abs(off.above) < _LEVEL_M)
        is_on_face = (off.behind < _EDGE_M) & (off.behind + off.face > -_EDGE_M)
        is_on_face &= (off.above + off.high > 0) & (off.above < _LEVEL_M)
        return self._chances(is_on_top | is_on_face, _CURB_REACH_M)

    def chances_on_road(self) -> Floats:
        """(n,) confidence of the curb before which a place lies on the carriageway; 0 elsewhere."""
        before_m = -(self._off.behind + self._off.face)
        over_road = np.abs(self._off.above + self._off.high)
        is_on = (before_m > _EDGE_M) & (over_road < _LEVEL_M + _STEEPEST * before_m)
        return self._chances(is_on, _ROAD_M)

    def chances_behind(self) -> Floats:
        """(n,) confidence of the curb behind which a place lies, level with its top; 0 elsewhere.

        Stone, footway, verge or median: whatever it is, no carriageway.
        """
        off = self._off
        is_on = (off.behind > _EDGE_M) & (np.abs(off.above) < _LEVEL_M + _STEEPEST * off.behind)
        return self._chances(is_on & (off.high > _LEAST_FACE_M), _BEHIND_M)

    def _chances(self, is_there: Flags, reach_m: float) -> Floats:
        chances = np.zeros(self._count)
        told = is_there & (self._away < reach_m)
        chances[self._near[told]] = self._confidence[told]
        return chances


def near_samples(tree: cKDTree, places: Floats, reach_m: float) -> tuple[Integers, Integers]:
    """The places with a sample within reach, and which of the samples is nearest to each."""
    away, nearest = tree.query(places, distance_upper_bound=reach_m, workers=-1)
    near = np.flatnonzero(np.isfinite(away))
    return near, np.asarray(nearest, np.int64)[near]
