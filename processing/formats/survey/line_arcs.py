"""Arcs of circles in lines of vertices: what the extended DM writes as one element (E4).

A line that was drawn as an arc has many vertices on one circle. An arc stands for them only where
it says the same: in plan and in height, to the width of what drawing it left open.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from processing.core.arrays import Floats
from processing.formats.survey.sheet_cuts import PlaceMm

_FEWEST = 5
"""Vertices of an arc: any three lie on a circle, four do by chance."""

_OFF_MM = 3.0
"""Of a vertex beside the circle: rounded to whole millimetres in both axes, and as much again."""

_CHORD_MM = 20.0
"""Of a chord beside the circle: twice what arcs are drawn to."""

_HEIGHT_MM = 10.0
_BENT_MM = 30.0
"""An arc stands out from its chord by more: what doesn't is a straight line."""


def line_parts(places: Sequence[PlaceMm]) -> Iterator[tuple[bool, tuple[PlaceMm, ...]]]:
    """A line as straight parts and arcs in their order: whether it is an arc, and its places.

    An arc has its first, a middle and its last place. Each part begins where the one before ends.
    """
    xyz = np.array(places, dtype=np.float64)
    begin = at = 0
    while at + _FEWEST <= len(places):
        end = _arc_end(xyz, at)
        if end is None:
            at += 1
            continue
        if at > begin:
            yield False, tuple(places[begin : at + 1])
        yield True, (places[at], places[(at + end) // 2], places[end])
        begin = at = end
    if begin < len(places) - 1:
        yield False, tuple(places[begin:])


def _arc_end(xyz: Floats, start: int) -> int | None:
    """The last place up to which an arc stands for the vertices from a start; None without one."""
    end = start + _FEWEST - 1
    if not _is_arc(xyz[start : end + 1]):
        return None
    step = 1
    while True:  # ever longer steps, then ever shorter ones
        if end + step < len(xyz) and _is_arc(xyz[start : end + step + 1]):
            end += step
            step *= 2
        elif step > 1:
            step //= 2
        else:
            return end


def _is_arc(xyz: Floats) -> bool:
    middle = (len(xyz) - 1) // 2
    centre = _centre(xyz[[0, middle, -1], :2])
    if centre is None:
        return False
    away = xyz[:, :2] - centre
    radii = np.hypot(*away.T)
    radius = radii[0]
    if np.abs(radii - radius).max() > _OFF_MM:
        return False
    turns = np.diff(np.unwrap(np.arctan2(away[:, 1], away[:, 0])))
    whole = float(turns.sum())
    one_way = bool((turns > 0).all() or (turns < 0).all()) and abs(whole) < 1.9 * np.pi
    chords = radius * (1 - np.cos(turns / 2))
    bent = radius * (1 - np.cos(min(abs(whole), np.pi) / 2))
    if not one_way or chords.max() > _CHORD_MM or bent < _BENT_MM:
        return False
    along = np.concatenate([[0.0], np.cumsum(np.abs(turns))])
    heights = np.interp(along, along[[0, middle, -1]], xyz[[0, middle, -1], 2])
    return bool(np.abs(heights - xyz[:, 2]).max() <= _HEIGHT_MM)


def _centre(three: Floats) -> Floats | None:
    """Of the circle through three places in plan; None where they lie on a line."""
    a, b = three[1] - three[0], three[2] - three[0]
    twice = 2 * (a[0] * b[1] - a[1] * b[0])
    if twice == 0:
        return None
    aa, bb = a @ a, b @ b
    offset: Floats = np.array([b[1] * aa - a[1] * bb, a[0] * bb - b[0] * aa]) / twice
    centre: Floats = three[0] + offset
    return centre
