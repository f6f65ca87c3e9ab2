"""Lids and gratings as they leave the works: plates with notches at both ends, grids of bars.

A lid's notch is half a drain hole; two lids that meet make a whole one. In its own frame a lid's
top is the plane z = 0, x runs along the gutter and y across it, both about the middle. Pieces
0 to 23 are the cells of a raster of the top, six along by four across (cell = row along × 4 +
column across); piece 24 is everything else, the sides and the walls of the notches.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from processing.laboratory.simulate.scene.mesh import Floats, Integers

CELLS_ALONG, CELLS_ACROSS = 6, 4
SIDES_PIECE = CELLS_ALONG * CELLS_ACROSS

_FRAME_WIDE_M = 0.005
_CROSS_PITCH_M = 0.1
_CROSS_WIDE_M = 0.006
_CROSS_BELOW_M = 0.004


@dataclass(frozen=True)
class LidKind:
    """A lid's mould; lengths in m.

    Attributes
    ----------
    holes : int
        In a row across the gutter.
    hole_long_m : float
        Along the gutter, of the whole hole that two lids make.
    hole_wide_m : float
        Across it.
    share : float
        How often it is met.
    """

    holes: int
    wide_m: float
    hole_long_m: float
    hole_wide_m: float
    share: float


# Counted on 3.6 km of national route 411 (Takahashi 2022, table 7-2).
LID_KINDS = (
    LidKind(2, 0.38, 0.030, 0.100, 0.665),
    LidKind(2, 0.44, 0.030, 0.105, 0.156),
    LidKind(2, 0.53, 0.037, 0.190, 0.089),
    LidKind(2, 0.66, 0.030, 0.185, 0.045),
    LidKind(2, 0.53, 0.030, 0.185, 0.009),
    LidKind(2, 0.38, 0.037, 0.110, 0.003),
    LidKind(1, 0.40, 0.050, 0.180, 0.032),
    LidKind(1, 0.40, 0.030, 0.100, 0.001),
    LidKind(1, 0.39, 0.040, 0.100, 0.001),
)


@dataclass(frozen=True)
class CoverShape:
    """A shape in its own frame: (n, 3) float64 m, (m, 3) int64, (m,) int64 pieces."""

    vertices: Floats
    triangles: Integers
    piece: Integers


@dataclass(frozen=True)
class Lid:
    """One lid's measures; lengths in m.

    Attributes
    ----------
    notches : tuple of (float, float)
        From and to of each notch across the lid, m from its middle, rising.
    depths_m : (float, float)
        Of the notches into the end at −x and into that at +x; 0 for an end without.
    """

    long_m: float
    wide_m: float
    thick_m: float
    notches: tuple[tuple[float, float], ...]
    depths_m: tuple[float, float]


@dataclass(frozen=True)
class Grating:
    """One grating's measures, m: bars lie across the gutter, `pitch_m` from middle to middle."""

    long_m: float
    wide_m: float
    high_m: float
    pitch_m: float
    bar_m: float


def lid_pieces(lid: Lid) -> CoverShape:
    """A lid with its notches cut out: top and sides, no underside (the channel's dark)."""
    half = lid.long_m / 2
    xs = np.linspace(-half, half, CELLS_ALONG + 1)
    ys = np.linspace(-lid.wide_m / 2, lid.wide_m / 2, CELLS_ACROSS + 1)
    rectangles = [
        (xs[row], xs[row + 1], ys[column], ys[column + 1], row * CELLS_ACROSS + column)
        for row in range(1, CELLS_ALONG - 1)
        for column in range(CELLS_ACROSS)
    ]
    for row, end, direction in ((0, -half, 1.0), (CELLS_ALONG - 1, half, -1.0)):
        depth = lid.depths_m[0 if direction > 0 else 1]
        inner, cut = xs[1 if direction > 0 else -2], end + direction * depth
        rectangles += [
            (
                min(cut, inner),
                max(cut, inner),
                ys[column],
                ys[column + 1],
                row * CELLS_ACROSS + column,
            )
            for column in range(CELLS_ACROSS)
        ]
        if depth > 0:
            rectangles += [
                (min(end, cut), max(end, cut), near, far, row * CELLS_ACROSS + column)
                for near, far, column in _beside_notches(ys, lid.notches)
            ]
    top = _flat(np.array(rectangles))
    return _joined([top, _skirt(_outline(lid), lid.thick_m)])


def _beside_notches(
    ys: Floats, notches: tuple[tuple[float, float], ...]
) -> list[tuple[float, float, int]]:
    """What is left of an end's edge between its notches, cut at the raster's columns."""
    breaks = np.unique(np.concatenate([ys, np.ravel(notches)]))
    middles = (breaks[1:] + breaks[:-1]) / 2
    columns = np.clip(np.searchsorted(ys, middles) - 1, 0, CELLS_ACROSS - 1)
    return [
        (float(low), float(high), int(column))
        for low, high, middle, column in zip(breaks[:-1], breaks[1:], middles, columns, strict=True)
        if not any(one <= middle <= other for one, other in notches)
    ]


def _outline(lid: Lid) -> Floats:
    """The top's outline, anticlockwise, closed: (n, 2)."""
    half, side = lid.long_m / 2, lid.wide_m / 2
    first, last = lid.depths_m
    points = [(half, -side)]
    for low, high in lid.notches if last > 0 else ():
        points += [(half, low), (half - last, low), (half - last, high), (half, high)]
    points += [(half, side), (-half, side)]
    for low, high in lid.notches[::-1] if first > 0 else ():
        points += [(-half, high), (first - half, high), (first - half, low), (-half, low)]
    points += [(-half, -side), (half, -side)]
    return np.array(points)


def _flat(rectangles: Floats) -> CoverShape:
    """Level rectangles at z = 0 from rows of x0, x1, y0, y1, piece."""
    x0, x1, y0, y1, piece = rectangles.T
    corners = np.stack(
        [
            np.column_stack([x, y, np.zeros_like(x)])
            for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
        ],
        axis=1,
    )
    return CoverShape(
        corners.reshape(-1, 3), quads(len(rectangles)), np.repeat(piece.astype(np.int64), 2)
    )


def _skirt(outline: Floats, deep_m: float) -> CoverShape:
    """Upright faces below a closed outline."""
    top = np.column_stack([outline, np.zeros(len(outline))])
    low = top - [0.0, 0.0, deep_m]
    corners = np.stack([low[:-1], low[1:], top[1:], top[:-1]], axis=1)
    count = len(outline) - 1
    return CoverShape(
        corners.reshape(-1, 3), quads(count), np.full(2 * count, SIDES_PIECE, np.int64)
    )


def quads(count: int) -> Integers:
    """Triangles of faces of four corners each that follow each other: (2 count, 3) int64."""
    quad = np.array([[0, 1, 2], [0, 2, 3]])
    triangles: Integers = (4 * np.arange(count)[:, None, None] + quad).reshape(-1, 3)
    return triangles


def _joined(parts: list[CoverShape]) -> CoverShape:
    starts = np.cumsum([0, *(len(one.vertices) for one in parts[:-1])])
    return CoverShape(
        np.concatenate([one.vertices for one in parts]),
        np.concatenate([one.triangles + at for one, at in zip(parts, starts, strict=True)]),
        np.concatenate([one.piece for one in parts]),
    )


def grating_pieces(grating: Grating) -> CoverShape:
    """A grating of real bars with open gaps: bearing bars, thinner cross bars, a frame."""
    half, side = grating.long_m / 2, grating.wide_m / 2
    count = max(2, round(grating.long_m / grating.pitch_m))
    middles = (np.arange(count) + 0.5) * grating.long_m / count - half
    ys = np.linspace(-side, side, CELLS_ACROSS + 1)
    rows = np.minimum(((middles + half) / grating.long_m * CELLS_ALONG).astype(int), 5)
    thick = grating.bar_m / 2
    tops = [
        (x - thick, x + thick, ys[column], ys[column + 1], row * CELLS_ACROSS + column)
        for x, row in zip(middles, rows, strict=True)
        for column in range(CELLS_ACROSS)
    ]
    sides = np.concatenate([middles - thick, middles + thick])
    crosses = max(1, round(grating.wide_m / _CROSS_PITCH_M) - 1)
    between = np.linspace(-side, side, crosses + 2)[1:-1]
    bars = [
        (-half, half, y - _CROSS_WIDE_M / 2, y + _CROSS_WIDE_M / 2, _CROSS_BELOW_M, SIDES_PIECE)
        for y in between
    ]
    for sign in (-1.0, 1.0):
        ends = sorted((sign * half, sign * (half - _FRAME_WIDE_M)))
        edges = sorted((sign * side, sign * (side - _FRAME_WIDE_M)))
        bars += [(ends[0], ends[1], -side, side, 0.0, SIDES_PIECE)]
        bars += [(-half, half, edges[0], edges[1], 0.0, SIDES_PIECE)]
    return _joined(
        [
            _flat(np.array(tops)),
            _walls(sides, side, grating.high_m),
            _bars(np.array(bars), grating.high_m),
        ]
    )


def _walls(xs: Floats, side_m: float, high_m: float) -> CoverShape:
    """Upright faces across the gutter at some x, from −side to side."""
    corners = np.array(
        [
            [0.0, -side_m, 0.0],
            [0.0, side_m, 0.0],
            [0.0, side_m, -high_m],
            [0.0, -side_m, -high_m],
        ]
    )
    vertices = corners + np.column_stack([xs, np.zeros((xs.size, 2))])[:, None]
    piece = np.full(2 * xs.size, SIDES_PIECE, np.int64)
    return CoverShape(vertices.reshape(-1, 3), quads(xs.size), piece)


def _bars(bars: Floats, high_m: float) -> CoverShape:
    """Upright bars from rows of x0, x1, y0, y1, depth of the top, piece: top and four sides."""
    x0, x1, y0, y1, below, piece = bars.T
    corners = [
        np.column_stack([x, y, z])
        for z in (-below, np.full_like(below, -high_m))
        for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
    ]
    vertices = np.stack(corners, axis=1).reshape(-1, 3)
    faces = [[0, 1, 2], [0, 2, 3]]
    for one in range(4):
        other = (one + 1) % 4
        faces += [[one, one + 4, other + 4], [one, other + 4, other]]
    first = 8 * np.arange(len(bars))[:, None, None]
    triangles = (first + np.array(faces)).reshape(-1, 3)
    sides = np.full((len(bars), len(faces)), SIDES_PIECE, np.int64)
    sides[:, :2] = piece.astype(np.int64)[:, None]
    return CoverShape(vertices, triangles, sides.ravel())
