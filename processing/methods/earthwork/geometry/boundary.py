"""The boundary that a volume is taken in: from drawn or delivered rings, and its share of cells."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

from processing.core.errors import OutOfRange, Unsuitable
from processing.core.kernels import kernel
from processing.core.text import Text
from processing.methods.ground.filters.cells import CellGrid

Floats = NDArray[np.float64]
Extent = tuple[float, float, float, float]
"""Least easting and northing, greatest easting and northing, m."""

_SAME_POSITION_M = 1e-6
"""Corners nearer than this are one: finer than any file's digits."""

_LEAST_AREA_M2 = 1e-6
"""A boundary with less is a line."""

_WHOLE = 1e-9
"""A share of a cell that differs by less from none or all of it does so by rounding."""

_DRAW_AGAIN = Text(
    "Draw the boundary again so that its sides meet at its corners only.",
    "辺どうしが頂点以外で接したり交わったりしないように、境界を描き直してください。",
)


def boundary_polygon(rings: Sequence[Floats], extent: Extent | None = None) -> shapely.Geometry:
    """The area within rings; a ring that lies within another one is a hole in it.

    Parameters
    ----------
    rings : sequence of (n, 2) float64
        Corners in order, in either sense, closed or not, m, project CRS; heights are passed over.
    extent : tuple of float or None
        Where there is ground: the boundary has to reach into it.

    Returns
    -------
    shapely.Polygon or shapely.MultiPolygon
        Outer rings counterclockwise, holes clockwise; several parts where rings lie apart.

    Raises
    ------
    Unsuitable
        No ring; a corner that is no number; fewer than three corners; no area; sides that cross
        or touch each other.
    OutOfRange
        It lies wholly outside the extent.
    """
    if not rings:
        raise Unsuitable(
            Text("The boundary has no outline.", "境界に外周線がありません。"),
            Text("Boundary", "境界"),
            Text("Choose a closed area.", "閉じた領域を指定してください。"),
        )
    cleaned = [_corners(ring, number) for number, ring in enumerate(rings, 1)]
    _check_crossings(cleaned)
    areas = [shapely.Polygon(ring) for ring in cleaned]
    for number, area in enumerate(areas, 1):
        if area.area < _LEAST_AREA_M2:
            raise _flawed(
                Text("The boundary encloses no area.", "境界の面積がゼロです。"), number, area
            )
    # Rings don't cross, so what an odd number of them encloses is the area without its holes.
    whole = areas[0]
    for area in areas[1:]:
        whole = shapely.symmetric_difference(whole, area)
    whole = shapely.orient_polygons(whole)
    if extent is not None:
        _check_within_reach(whole, extent)
    return whole


def inside_shares(polygon: shapely.Geometry, grid: CellGrid) -> NDArray[np.float32]:
    """Share of each cell that is within a boundary, exact: (rows, columns) float32, 0 to 1.

    Parameters
    ----------
    polygon : shapely.Polygon or shapely.MultiPolygon
        Valid, as :func:`boundary_polygon` gives it, m, project CRS.

    Notes
    -----
    Each side adds, with its sign, what lies to the east of it in the rows it goes through; summed
    along a row that is the enclosed part of each cell. It takes as long as the cells and the
    cells along the sides, however many corners there are.
    """
    sums = np.zeros((grid.rows, grid.columns + 1))
    for part in shapely.get_parts(shapely.orient_polygons(polygon)):
        for ring in (part.exterior, *part.interiors):
            positions = (shapely.get_coordinates(ring) - grid.origin[:2]) / grid.size_m
            _add_ring_kernel(positions, sums)
    np.cumsum(sums, axis=1, out=sums)
    shares = sums[:, :-1]
    shares[shares < _WHOLE] = 0.0
    shares[shares > 1.0 - _WHOLE] = 1.0
    return shares.astype(np.float32)


def _corners(ring: Floats, number: int) -> Floats:
    """Corners of a ring without its closing one and without those that repeat the one before."""
    positions = np.asarray(ring, np.float64)[:, :2]
    broken = np.flatnonzero(~np.isfinite(positions).all(axis=1))
    if broken.size:
        raise Unsuitable(
            Text(
                f"Corner {broken[0] + 1} of the boundary has no position.",
                f"境界の{broken[0] + 1}番目の頂点に座標がありません。",
            ),
            _ring_name(number),
            Text("Draw the boundary again.", "境界を描き直してください。"),
        )
    if len(positions):
        is_new = np.hypot(*(positions - np.roll(positions, 1, axis=0)).T) > _SAME_POSITION_M
        positions = positions[is_new]
    if len(positions) < 3:
        raise Unsuitable(
            Text(
                f"A boundary needs three corners; this one has {len(positions)}.",
                f"境界には3つ以上の頂点が必要です（この境界は{len(positions)}点）。",
            ),
            _ring_name(number),
            Text("Choose a closed area.", "閉じた領域を指定してください。"),
        )
    return positions


def _check_crossings(rings: Sequence[Floats]) -> None:
    """Refuse sides that meet elsewhere than where one follows the other."""
    starts = np.concatenate(rings)
    ends = np.concatenate([np.roll(ring, -1, axis=0) for ring in rings])
    ring_of = np.repeat(np.arange(len(rings)), [len(ring) for ring in rings])
    first_of = np.concatenate([[0], np.cumsum([len(ring) for ring in rings])])
    sides = shapely.linestrings(np.stack([starts, ends], axis=1))
    one, other = shapely.STRtree(sides).query(sides, predicate="intersects")
    one, other = one[one < other], other[one < other]
    is_next = other == one + 1
    closes = (one == first_of[ring_of[one]]) & (other == first_of[ring_of[one] + 1] - 1)
    follows = (ring_of[one] == ring_of[other]) & (is_next | closes)
    shared = shapely.intersection(sides[one], sides[other])
    # One side that follows another shares its corner; more than that only where it turns back.
    wrong = np.flatnonzero(~follows | (shapely.length(shared) > _SAME_POSITION_M))
    if wrong.size:
        first = wrong[np.argmin(one[wrong])]
        position = shapely.Point(shapely.get_coordinates(shared[first])[0])
        if ring_of[one[first]] == ring_of[other[first]]:
            what = Text("The boundary crosses or touches itself.", "境界が自己交差しています。")
        else:
            what = Text(
                "Two outlines of the boundary cross or touch each other.",
                "境界の2つの外周線が交差または接触しています。",
            )
        raise _flawed(what, int(ring_of[one[first]]) + 1, position)


def _check_within_reach(whole: shapely.Geometry, extent: Extent) -> None:
    """Refuse a boundary beyond the ground; one whose axes are swapped is told so."""
    ground = shapely.box(*extent)
    if shapely.area(shapely.intersection(whole, ground)) > 0.0:
        return
    remedy = Text(
        "Choose a boundary on the site, in the reference system of the ground.",
        "現場内の境界を、地盤と同じ座標系で指定してください。",
    )
    swapped = shapely.transform(whole, lambda positions: positions[:, ::-1])
    if shapely.area(shapely.intersection(swapped, ground)) > 0.0:
        remedy = Text(
            "Its easting and northing seem to be swapped: give easting first.",
            "X（北）とY（東）が入れ替わっているようです。東（Y）、北（X）の順に指定してください。",
        )
    west, south, east, north = shapely.bounds(whole)
    raise OutOfRange(
        Text("The boundary lies wholly outside the ground.", "境界が地盤の範囲の外にあります。"),
        Text(
            "Boundary: easting {west:.1f} to {east:.1f}, northing {south:.1f} to {north:.1f}; "
            "ground: easting {ground[0]:.1f} to {ground[2]:.1f}, "
            "northing {ground[1]:.1f} to {ground[3]:.1f}",
            "境界: 東{west:.1f}～{east:.1f}、北{south:.1f}～{north:.1f}、"
            "地盤: 東{ground[0]:.1f}～{ground[2]:.1f}、北{ground[1]:.1f}～{ground[3]:.1f}",
        ).filled(west=west, south=south, east=east, north=north, ground=extent),
        remedy,
    )


def _flawed(what: Text, number: int, at: shapely.Geometry) -> Unsuitable:
    easting, northing = shapely.get_coordinates(at)[0]
    where = Text(
        "{ring}, at easting {easting:.3f}, northing {northing:.3f}",
        "{ring}、東{easting:.3f} 北{northing:.3f}",
    ).filled(ring=_ring_name(number), easting=easting, northing=northing)
    return Unsuitable(what, where, _DRAW_AGAIN)


def _ring_name(number: int) -> Text:
    return Text(f"Boundary, outline {number}", f"境界の外周線{number}")


@kernel
def _add_ring_kernel(positions: Floats, sums: Floats) -> None:
    """Add one closed ring, in cells: differences along each row of what it encloses.

    A piece of a side that rises by dy within a cell takes from that cell what lies to the east
    of it there, and dy from every cell beyond.
    """
    rows = sums.shape[0]
    for side in range(positions.shape[0] - 1):
        x0, y0 = positions[side, 0], positions[side, 1]
        x1, y1 = positions[side + 1, 0], positions[side + 1, 1]
        if y0 == y1:
            continue
        sign = -1.0
        if y0 > y1:
            sign = 1.0
            x0, y0, x1, y1 = x1, y1, x0, y0
        slope = (x1 - x0) / (y1 - y0)
        low, high = max(y0, 0.0), min(y1, float(rows))
        if low >= high:
            continue
        for row in range(int(low), min(int(np.ceil(high)), rows)):
            bottom, top = max(low, float(row)), min(high, row + 1.0)
            start, end = x0 + (bottom - y0) * slope, x0 + (top - y0) * slope
            _add_piece_kernel(start, end, sign * (top - bottom), sums[row])


@kernel
def _add_piece_kernel(start: float, end: float, rise: float, sums: Floats) -> None:
    """Add a piece of a side within one row: from start to end along it, rising by ``rise``."""
    columns = sums.shape[0] - 1
    if start > end:
        start, end = end, start
    width = end - start
    if start >= columns:
        return
    if end <= 0.0:
        sums[0] += rise
        return
    if start < 0.0:
        sums[0] += rise * (-start / width)
    for column in range(max(int(np.floor(start)), 0), min(int(np.floor(end)), columns - 1) + 1):
        left, right = max(start, float(column)), min(end, column + 1.0)
        part = rise * ((right - left) / width) if width > 0.0 else rise
        beyond = part * (0.5 * (left + right) - column)
        sums[column] += part - beyond
        sums[column + 1] += beyond


def warm_up() -> None:
    """Compile the kernel."""
    inside_shares(shapely.box(0.2, 0.2, 1.5, 1.5), CellGrid(np.zeros(3), 1.0, 2, 2))
