"""Straight pieces of lines on the screen: cut to the window, thinned and dashed by arithmetic.

Qt draws many short solid lines an order of magnitude faster than one long dashed path, and goes
wrong with coordinates beyond 32,767 px.
"""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QLineF

from processing.core.arrays import Floats, Integers

_ON_PX, _OFF_PX = 8.0, 5.0


def clip_pieces(pieces: Floats, low: Floats, high: Floats) -> tuple[Floats, Integers, Floats]:
    """Pieces within a rectangle (Liang and Barsky 1984).

    Parameters
    ----------
    pieces : (k, 2, 2) float64
        Both ends; pieces with a NaN are left out.
    low, high : (2,) float64
        Corners of the rectangle.

    Returns
    -------
    pieces : (c, 2, 2) float64
    numbers : (c,) int64
        Which piece each is a part of, rising.
    starts : (c,) float64
        Distance of its first end from that of the whole piece.
    """
    # Most pieces of a map lie beside the window: a comparison is cheaper than a division.
    one, other = pieces[:, 0], pieces[:, 1]
    touches = (np.minimum(one, other) <= high) & (np.maximum(one, other) >= low)
    numbers = np.flatnonzero(touches[:, 0] & touches[:, 1])
    start, way = pieces[numbers, 0], pieces[numbers, 1] - pieces[numbers, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        first, second = (low - start) / way, (high - start) / way
    is_still = way == 0  # inside in this direction: it touches
    enters = np.where(is_still, 0.0, np.minimum(first, second))
    leaves = np.where(is_still, 1.0, np.maximum(first, second))
    enter = np.maximum(enters[:, 0], enters[:, 1]).clip(0.0)
    leave = np.minimum(leaves[:, 0], leaves[:, 1]).clip(max=1.0)
    inside = enter <= leave
    start, way, enter, leave = start[inside], way[inside], enter[inside], leave[inside]
    cut = np.stack([start + enter[:, None] * way, start + leave[:, None] * way], axis=1)
    return cut, numbers[inside], enter * np.hypot(*way.T)


def thin_pieces(pieces: Floats, step_px: float) -> Floats:
    """Pieces between whole steps, without those that shrink to nothing: for very many."""
    whole = np.rint(pieces / step_px) * step_px
    moves = whole[:, 0] != whole[:, 1]
    kept: Floats = whole[moves[:, 0] | moves[:, 1]]
    return kept


def dash_pieces(pieces: Floats, begins: Floats) -> Floats:
    """The dashes along pieces.

    Parameters
    ----------
    pieces : (k, 2, 2) float64
        px.
    begins : (k,) float64
        How far along its line each piece begins, px: the pattern goes on over a line's corners.

    Returns
    -------
    (d, 2, 2) float64
    """
    way = pieces[:, 1] - pieces[:, 0]
    lengths = np.hypot(*way.T)
    period = _ON_PX + _OFF_PX
    first = np.floor(begins / period).astype(np.int64)
    counts = np.floor((begins + lengths) / period).astype(np.int64) - first + 1
    of_piece = np.repeat(np.arange(len(pieces)), counts)
    within = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    dash_at = (first[of_piece] + within) * period - begins[of_piece]
    start = np.maximum(dash_at, 0.0)
    stop = np.minimum(dash_at + _ON_PX, lengths[of_piece])
    is_line = stop > start
    of_piece, start, stop = of_piece[is_line], start[is_line], stop[is_line]
    unit = way[of_piece] / lengths[of_piece][:, None]
    at = pieces[of_piece, 0]
    return np.stack([at + start[:, None] * unit, at + stop[:, None] * unit], axis=1)


def as_lines(pieces: Floats) -> list[QLineF]:
    """Pieces as Qt draws them."""
    return list(map(QLineF, *pieces.reshape(-1, 4).T.tolist())) if len(pieces) else []
