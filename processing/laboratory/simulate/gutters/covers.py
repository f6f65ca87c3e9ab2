"""Lids and gratings in their places: frames, corners, holes, what dirt hides of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.gutters.beds import Channel
from processing.laboratory.simulate.gutters.dirt import Heap
from processing.laboratory.simulate.gutters.lid_shapes import (
    CELLS_ACROSS,
    CELLS_ALONG,
    CoverShape,
    Grating,
    Lid,
    grating_pieces,
    lid_pieces,
)
from processing.laboratory.simulate.gutters.runs import CoverPosition, CoverStyle, CoverTilts
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.street.plan import LEFT

_CHIP_M, _CLEAR_M = (0.02, 0.06), 0.01
"""Length of a broken edge across the gutter; what is left of a lid's end beside it at least."""

_HIDDEN_M = 0.003  # a cell under so much dirt does not show


@dataclass(frozen=True)
class CoverPlacement:
    """Where covers lie.

    Attributes
    ----------
    middles : (n, 3) float64
        Of their tops, m, the street's frame.
    axes : (n, 3, 3) float64
        Rows: along the gutter, to the left, up.
    """

    middles: Floats
    axes: Floats

    def moved(self, number: int, vertices: Floats) -> Floats:
        """Vertices of one cover's own frame in the street's."""
        moved: Floats = self.middles[number] + vertices @ self.axes[number]
        return moved


@dataclass(frozen=True)
class HoleRow:
    """A cover's drain holes.

    Attributes
    ----------
    notches : tuple of (float, float)
        From and to across the lid, m from its middle to the left.
    instance : int
        The cover's.
    """

    count: int
    long_m: float
    wide_m: float
    notches: tuple[tuple[float, float], ...]
    instance: int = 0

    def of(self, instance: int) -> HoleRow:
        """The same of a cover."""
        return replace(self, instance=instance)


def cover_placement(
    line: Floats, across: Floats, arcs: Floats, positions: Sequence[CoverPosition], lie: CoverTilts
) -> CoverPlacement:
    """Where the covers of a run lie: on chords of the lids' middle line, on the bed's height.

    Parameters
    ----------
    line : (n, 3) float64
        The middle line at the bed's nodes.
    across : (n, 3) float64
        From the bed's inner to its outer edge.
    arcs : (n,) float64
        m along the line.
    """
    starts = np.array([one.start_m for one in positions])
    ends = starts + [one.long_m for one in positions]
    first, last, side = (
        np.column_stack([np.interp(at, arcs, of[:, axis]) for axis in range(3)])
        for at, of in ((starts, line), (ends, line), ((starts + ends) / 2, across))
    )
    along = _unit(last - first)
    is_left = np.cross(along, side)[:, 2:] > 0
    left = np.where(is_left, side, -side)
    up = _unit(np.cross(along, left))
    left = np.cross(up, along)
    turned = np.array([one.turned_rad for one in positions])[:, None]
    along, left = (
        np.cos(turned) * along + np.sin(turned) * left,
        np.cos(turned) * left - np.sin(turned) * along,
    )
    along = _unit(along + lie.pitched[:, None] * up)
    up = _unit(np.cross(along, left + lie.rolled[:, None] * up))
    left = np.cross(up, along)
    middles = (first + last) / 2 + lie.raised[:, None] * up
    return CoverPlacement(middles, np.stack([along, left, up], axis=1))


def _unit(directions: Floats) -> Floats:
    unit: Floats = directions / np.linalg.norm(directions, axis=1)[:, None]
    return unit


def corners_of(covers: CoverPlacement, number: int, long_m: float, wide_m: float) -> Floats:
    """A cover's top as a closed ring: (5, 3) float64, m, anticlockwise from its rear right."""
    x, y = long_m / 2, wide_m / 2
    ring = np.array([[-x, -y, 0.0], [x, -y, 0.0], [x, y, 0.0], [-x, y, 0.0], [-x, -y, 0.0]])
    return covers.moved(number, ring)


def holes_of(
    habit: CoverStyle, wide_m: float, position: CoverPosition, *, is_other: bool, is_blind: bool
) -> HoleRow:
    """The holes of a cover; a lid of another mould (`is_other`) has a single one, a blind none."""
    kind = habit.kind
    if position.what == "grating" or is_blind:
        return HoleRow(0, 0.0, 0.0, ())
    half = kind.hole_wide_m / 2
    if kind.holes == 1 or is_other:
        return HoleRow(1, kind.hole_long_m, kind.hole_wide_m, ((-half, half),))
    at = habit.notch_at * wide_m
    notches = ((-at - half, half - at), (at - half, at + half))
    return HoleRow(2, kind.hole_long_m, kind.hole_wide_m, notches)


def cover_pieces(
    random: Generator,
    gutter: tuple[CoverStyle, Channel],
    position: CoverPosition,
    holes: HoleRow,
    *,
    is_chipped: bool,
) -> CoverShape:
    """The shape of a lid or a grating."""
    habit, channel = gutter
    wide = channel.opening_m - 2 * habit.gap_m
    if position.what == "grating":
        # Bars as in makers' tables: 5–8 mm wide every 20–33 mm, fine ones (細目) every 15 mm.
        bar = float(random.uniform(0.005, 0.008))
        pitch = float(random.choice([0.015, random.uniform(0.02, 0.033)], p=[0.15, 0.85]))
        high = min(channel.thick_m, float(random.uniform(0.03, 0.06)))
        return grating_pieces(Grating(position.long_m, wide, high, max(pitch, 2 * bar), bar))
    depth = max(holes.long_m, habit.kind.hole_long_m) / 2 - 0.001
    is_cut = min(abs(position.long_m - one) for one in habit.lengths_m) > 1e-6
    depths = (depth, 0.0 if is_cut else depth)
    notches = _with_chip(random, holes.notches, wide) if is_chipped else holes.notches
    depths = depths if notches else (0.0, 0.0)
    return lid_pieces(Lid(position.long_m, wide, channel.thick_m - 0.005, notches, depths))


def _with_chip(
    random: Generator, notches: tuple[tuple[float, float], ...], wide_m: float
) -> tuple[tuple[float, float], ...]:
    """Holes of a lid and a place where its end has broken away, where one is free of holes."""
    long = float(random.uniform(*_CHIP_M))
    low = float(random.uniform(-wide_m / 2 + _CLEAR_M, wide_m / 2 - _CLEAR_M - long))
    chip = low, low + long
    if any(chip[0] < right + _CLEAR_M and left - _CLEAR_M < chip[1] for left, right in notches):
        return notches
    return tuple(sorted((*notches, chip)))


def uncovered_share(
    heaps: Sequence[Heap], position: CoverPosition, wide_m: float, middle_m: float, side: int
) -> float:
    """Share of a cover's top that lies under no soil, leaves or grass."""
    x = (np.arange(CELLS_ALONG) + 0.5) / CELLS_ALONG - 0.5
    y = (np.arange(CELLS_ACROSS) + 0.5) / CELLS_ACROSS - 0.5
    along, left = np.meshgrid(x * position.long_m, y * wide_m, indexing="ij")
    arcs = (position.start_m + position.long_m / 2 + along).ravel()
    outwards = (middle_m + (left if side == LEFT else -left)).ravel()
    is_hidden = np.zeros(arcs.size, bool)
    for heap in heaps:
        if heap.along[0] <= arcs[-1] and heap.along[-1] >= arcs[0]:
            is_hidden |= heap.thickness_at(arcs, outwards) > _HIDDEN_M
    return round(1.0 - float(is_hidden.mean()), 3)


def plugs_between(
    covers: CoverPlacement,
    positions: Sequence[CoverPosition],
    rows: Sequence[HoleRow | None],
    number: int,
    *,
    depth_m: float,
) -> Iterator[Floats]:
    """Level tops (4, 3) of the soil in the holes between a lid and the next one."""
    row, after = rows[number], rows[number + 1]
    if row is None or after is None or not row.count or not after.count:
        return
    gap = positions[number + 1].start_m - positions[number].start_m - positions[number].long_m
    end = positions[number].long_m / 2
    low, high = end - row.long_m / 2 - 0.01, end + gap + row.long_m / 2 + 0.01
    for left, right in row.notches:
        corners = np.array(
            [
                [low, left - 0.01, -depth_m],
                [high, left - 0.01, -depth_m],
                [high, right + 0.01, -depth_m],
                [low, right + 0.01, -depth_m],
            ]
        )
        yield covers.moved(number, corners)
