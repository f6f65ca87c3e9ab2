"""Pieces of scan lines that lie on one plate: near each other, in one upright plane."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from processing.core.arrays import Floats, Integers
from processing.core.monitor import Monitor
from processing.core.worked_ahead import in_order
from processing.methods.road.signs.link_kernels import (
    PLANE_HIGH,
    PLANE_LOW,
    PLANE_MIDDLE,
    PLANE_NOISE,
    PLANE_NORMAL,
    PLANE_RIGHT,
    PLANE_UP,
    PLANE_WIDTH,
    RIM_M,
    complete_kernel,
    flat_kernel,
    link_kernel,
    plane_kernel,
    turns_kernel,
)
from processing.methods.road.signs.piece_kernels import (
    BEFORE,
    BEHIND,
    BRIGHTS,
    COUNT,
    FREE,
    FROM,
    HIDDEN,
    TO,
    VIEW,
)
from processing.methods.road.signs.scan_pieces import ScanPieces

_FEWEST_PIECES, _FEWEST_POINTS = 2, 8

_LARGEST_M = 6.0
_LEAST_WIDE_M, _LEAST_LONG_M = 0.08, 0.25
"""Of a group's box, in either direction and in the larger one: the smallest plate is 10 cm by
40 cm, a pulse may miss some of it."""

_DULL_TURNS, _DULL_POINTS = 3, 20
_DULL_LEAST_M, _DULL_LARGEST_M = 0.25, 4.0
"""Of a dull group: turns that met it, points, and the sides of its box. Leaves and façades show
many pieces that lie in a plane by chance, and small plates hang with larger ones."""

_LEAST_CLEAR = 0.3
"""Share of a dull group's turns on which nothing of the same goes on at either end: plates end in
the free or behind what is nearer, walls go on."""

_LEAST_SPAN = 0.2
"""Mean length that turns draw on a dull group, over its own: lines cross a plate from rim to rim,
pieces of a crown begin and end anywhere."""

_SAME_PLANE_M = 0.04
"""Groups whose planes lie nearer to each other are of one plate: its front and its back, and passes
some centimetres apart. Plates that hang back to back have their post between them, 6 cm."""

_SAME_WAY = np.cos(np.radians(12.0))
_LIKELY_WAY, _LIKELY_M = np.cos(np.radians(15.0)), 0.1
"""The same of groups that are looked at: the plane of a group moves while others join it."""

_BESIDE_M, _HIDDEN_M = 0.2, 0.5
"""Between the boxes of groups of one plate: the post before its back hides a strip of it, twice as
wide as itself where it is seen askew; a pole before it hides more, and lines end at what is nearer
then."""

_LEAST_HIDDEN = 0.4
"""Share of a group's lines with something nearer beyond an end: most of those that are left of a
plate on either side of a pole run up to it."""


@dataclass(frozen=True)
class PlateGroup:
    """Pieces in one plane.

    Attributes
    ----------
    pieces : (k,) int64
        Their numbers.
    plane : (PLANE_WIDTH,) float64
        As the kernels take it, m about the origin of the plan; the properties are views of it.
    """

    pieces: Integers
    plane: Floats

    @property
    def middle(self) -> Floats:
        """(3,) m about the origin of the plan."""
        return self.plane[PLANE_MIDDLE:PLANE_RIGHT]

    @property
    def right(self) -> Floats:
        """(3,) unit vector to the right, as the scanner saw it."""
        return self.plane[PLANE_RIGHT:PLANE_UP]

    @property
    def up(self) -> Floats:
        """(3,) unit vector upwards in the plane."""
        return self.plane[PLANE_UP:PLANE_NORMAL]

    @property
    def normal(self) -> Floats:
        """(3,) unit vector towards the scanner."""
        return self.plane[PLANE_NORMAL:PLANE_NOISE]

    @property
    def noise_m(self) -> float:
        """How far its pieces lie off the plane."""
        return float(self.plane[PLANE_NOISE])

    @property
    def low(self) -> Floats:
        """(2,) the lower corner of its box, right and up of the middle as the scanner saw it, m."""
        return self.plane[PLANE_LOW:PLANE_HIGH]

    @property
    def high(self) -> Floats:
        """(2,) the upper corner."""
        return self.plane[PLANE_HIGH:]

    def flat(self, xyz: Floats) -> Floats:
        """(n, 2) right and up of the middle."""
        return np.asarray((xyz - self.middle) @ self._axes.T)

    def xyz(self, flat: Floats) -> Floats:
        """(…, 3) places of the plane, m about the origin of the plan."""
        return np.asarray(self.middle + flat @ self._axes)

    @property
    def _axes(self) -> Floats:
        """(2, 3) to the right and up."""
        return self.plane[PLANE_RIGHT:PLANE_NORMAL].reshape(2, 3)


def plate_groups(pieces: ScanPieces, ways: Floats, monitor: Monitor) -> list[PlateGroup]:
    """Groups of pieces that may be plates.

    Parameters
    ----------
    ways : (n, 3) float64
        What the vehicle went during one turn where each piece was measured, m; NaN where nobody
        knows.
    """
    values = pieces.values
    is_bright = 2 * values[:, BRIGHTS] > values[:, COUNT]
    is_seed = is_bright | (values[:, BEFORE] == FREE) | (values[:, BEHIND] == FREE)

    def linked_of(number: int) -> list[Integers]:
        monitor.check()
        mine = np.flatnonzero(is_seed & (pieces.drive == number))
        mine = mine[np.argsort(pieces.row[mine], kind="stable")]
        linked = np.empty(mine.size, np.int64)
        link_kernel(values[mine], pieces.row[mine], is_bright[mine], ways[mine], linked)
        order = np.argsort(linked, kind="stable")
        cuts = np.flatnonzero(np.diff(linked[order])) + 1
        return np.split(mine[order], cuts)

    groups: list[PlateGroup] = []
    drives = range(int(pieces.drive.max(initial=-1)) + 1)
    for members in (one for some in in_order(linked_of, drives) for one in some):
        monitor.check()
        if members.size >= _FEWEST_PIECES:
            groups += _planes(pieces, members)
    found: list[PlateGroup] = []
    for one in _completed(pieces, _joined(pieces, groups, is_bright), is_bright):
        monitor.check()
        if is_bright[one.pieces].any() or _may_be_dull(pieces, one):
            found.append(one)
    return found


def _planes(pieces: ScanPieces, members: Integers) -> list[PlateGroup]:
    """Planes among linked pieces, the one with the most points first."""
    found: list[PlateGroup] = []
    left = members[np.argsort(-pieces.values[members, COUNT], kind="stable")]
    while left.size >= _FEWEST_PIECES and pieces.values[left, COUNT].sum() >= _FEWEST_POINTS:
        chosen = np.zeros(left.size, np.bool_)
        if plane_kernel(pieces.values, left, chosen) < _FEWEST_POINTS:
            break
        group = group_of(pieces.values, left[chosen])
        if group is not None and _is_plate_sized(group):
            found.append(group)
        left = left[~chosen]
    return found


def _may_be_dull(pieces: ScanPieces, group: PlateGroup) -> bool:
    """Whether lines of a group that isn't bright cross it from rim to rim."""
    size = group.high - group.low
    if size.min() < _DULL_LEAST_M or size.max() > _DULL_LARGEST_M:
        return False
    if pieces.values[group.pieces, COUNT].sum() < _DULL_POINTS:
        return False
    met_by = pieces.drive, pieces.row
    turns, clear, span = turns_kernel(pieces.values, met_by, group.pieces, group.plane)
    return turns >= _DULL_TURNS and clear >= _LEAST_CLEAR and span >= _LEAST_SPAN


def _is_plate_sized(group: PlateGroup) -> bool:
    short, long = sorted((group.high - group.low).tolist())
    return bool(long <= _LARGEST_M and short >= _LEAST_WIDE_M and long >= _LEAST_LONG_M)


def group_of(values: Floats, members: Integers) -> PlateGroup | None:
    """The plane of pieces by least squares; None where it isn't upright."""
    told = np.empty(PLANE_WIDTH)
    if not flat_kernel(values, members, told):
        return None
    return PlateGroup(members, told)


def _joined(
    pieces: ScanPieces, groups: list[PlateGroup], is_bright: NDArray[np.bool_]
) -> list[PlateGroup]:
    """Groups of one plate as one, those that have the most points first."""
    if len(groups) < 2:
        return groups
    points = [float(pieces.values[one.pieces, COUNT].sum()) for one in groups]
    order = np.argsort(-np.array(points), kind="stable")
    beside = _beside(groups, order)
    taken = np.zeros(len(groups), np.bool_)
    found: list[PlateGroup] = []
    for first in order.tolist():
        if taken[first]:
            continue
        taken[first] = True
        whole = groups[first]
        for other in beside.get(first, ()):
            if taken[other] or not _are_one(pieces.values, whole, groups[other]):
                continue
            if not _is_plate_on_wall(pieces, (whole, groups[other]), is_bright):
                both = group_of(pieces.values, np.union1d(whole.pieces, groups[other].pieces))
                if both is not None and both.noise_m <= _SAME_PLANE_M / 2:
                    whole, taken[other] = both, True
        found.append(whole)
    return found


def _beside(groups: list[PlateGroup], order: Integers) -> dict[int, list[int]]:
    """Which groups may be of one plate with another one, in their order; most are with none."""
    planes = np.array([one.plane for one in groups])
    middles, normals = planes[:, PLANE_MIDDLE:PLANE_RIGHT], planes[:, PLANE_NORMAL:PLANE_NOISE]
    reach = np.hypot(*(planes[:, PLANE_HIGH:] - planes[:, PLANE_LOW:PLANE_HIGH]).T) + 1
    near = cKDTree(middles).query_ball_point(middles, reach)
    first = np.repeat(np.arange(len(groups)), [len(one) for one in near])
    other = np.concatenate(near).astype(np.int64)
    is_likely = first != other
    for least, told in (
        (_LIKELY_WAY, np.abs((normals[first] * normals[other]).sum(axis=1))),
        (-_LIKELY_M, -np.abs(((middles[other] - middles[first]) * normals[first]).sum(axis=1))),
    ):
        is_likely &= told >= least
    rank = np.argsort(order)
    first, other = first[is_likely], other[is_likely]
    beside: dict[int, list[int]] = {}
    for number in np.lexsort([rank[other], first]).tolist():
        beside.setdefault(int(first[number]), []).append(int(other[number]))
    return beside


def _are_one(values: Floats, whole: PlateGroup, other: PlateGroup) -> bool:
    if abs(whole.normal @ other.normal) < _SAME_WAY:
        return False
    off = (other.middle - whole.middle) @ whole.normal
    back = (whole.middle - other.middle) @ other.normal
    if max(abs(off), abs(back)) > _SAME_PLANE_M:
        return False
    corners = other.xyz(np.array([other.low, other.high]))
    flat = whole.flat(corners)
    low, high = flat.min(axis=0), flat.max(axis=0)
    gap = float(np.maximum(low - whole.high, whole.low - high).max())
    if gap <= _BESIDE_M:
        return True
    return gap <= _HIDDEN_M and all(_is_hidden(values[one.pieces]) for one in (whole, other))


def _is_hidden(values: Floats) -> bool:
    return bool((values[:, [BEFORE, BEHIND]] == HIDDEN).any(axis=1).mean() >= _LEAST_HIDDEN)


def _is_plate_on_wall(
    pieces: ScanPieces, groups: tuple[PlateGroup, PlateGroup], is_bright: NDArray[np.bool_]
) -> bool:
    """Whether, seen from one side, one group shines within the other one, which doesn't.

    Parts of one face may lie beside each other, of which one is darker by its paint.
    """
    for sign in (-1.0, 1.0):
        shares = []
        for group in groups:
            towards = sign * (pieces.values[group.pieces, VIEW : VIEW + 3] @ groups[0].normal)
            mine = group.pieces[towards > 0]
            if mine.size:
                shares.append(np.average(is_bright[mine], weights=pieces.values[mine, COUNT]) > 0.5)
        if len(set(shares)) > 1:
            bright, dull = groups if shares[0] else groups[::-1]
            corners = dull.flat(bright.xyz(np.array([bright.low, bright.high])))
            if (corners >= dull.low).all() and (corners <= dull.high).all():
                return True
    return False


def _completed(
    pieces: ScanPieces, groups: Sequence[PlateGroup], is_bright: NDArray[np.bool_]
) -> Iterator[PlateGroup]:
    """Groups with what else lies in the box and the plane of each and is as bright.

    Further pieces of plates end at things before them or beside them.
    """
    if not groups:
        return
    values = pieces.values
    tree = cKDTree((values[:, FROM : FROM + 3] + values[:, TO : TO + 3]) / 2)
    planes = np.array([one.plane for one in groups])
    low, high = planes[:, PLANE_LOW:PLANE_HIGH], planes[:, PLANE_HIGH:]
    middles = (low + high)[:, :, None] / 2
    about = planes[:, PLANE_MIDDLE:PLANE_RIGHT] + middles[:, 0] * planes[:, PLANE_RIGHT:PLANE_UP]
    about += middles[:, 1] * planes[:, PLANE_UP:PLANE_NORMAL]
    reach = np.hypot(*(high - low + 2 * RIM_M).T) / 2
    is_own = np.zeros(len(pieces), np.bool_)
    near_each = tree.query_ball_point(about, reach, return_sorted=False, workers=2)
    for number, (group, found) in enumerate(zip(groups, near_each, strict=True)):
        near = np.array(found, np.int64)
        chosen = np.empty(near.size, np.int64)
        count = complete_kernel(
            values, near, group.pieces, planes[number], is_bright, is_own, chosen
        )
        if not count:
            yield group
            continue
        whole = np.concatenate([group.pieces, np.sort(chosen[:count])])
        yield group_of(values, whole) or group
