"""Painted strokes with their truth: the centre line of each marking, and which metres show it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np
from numpy.random import Generator

from processing.laboratory.simulate.roadway.paint import Rectangle, SheetPieces, add_paint
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.scene.things import Fact, SectionBuilder, TrueFeature
from processing.laboratory.simulate.street.section import StreetSection

StrokeType = Literal["solid", "broken", "stop_line", "crosswalk_bar", "other"]

_KINDS = {"stop_line": "stop_line", "crosswalk_bar": "crosswalk_bar"}

PIECE_M = 1.0
"""Of a marking, whose points are counted together."""

_PAINTED_SHARE = 0.3
"""Of a piece; with less paint it lies in the gap of a broken line."""

_MOST_PIECES = 255


class PaintedStroke(NamedTuple):
    """One marking of the ordinance.

    Attributes
    ----------
    rectangles : tuple of Rectangle
        Of paint; a broken line has one a dash.
    type : str
    pattern_m : (dash, gap) or None
    """

    rectangles: tuple[Rectangle, ...]
    type: StrokeType
    pattern_m: tuple[float, float] | None = None


def add_strokes(
    section: StreetSection,
    built: SectionBuilder,
    strokes: Sequence[PaintedStroke],
    worn: tuple[Generator, float],
) -> None:
    """Add markings of the carriageway, each a thing of its own.

    Parameters
    ----------
    worn : (Generator, float)
        The share of small pieces that have come off, and what draws them.
    """
    start, end = section.plan.start_m, section.plan.end_m
    for stroke in strokes:
        inside = [
            (max(low, start), min(high, end), right, left)
            for low, high, right, left in stroke.rectangles
            if min(high, end) - max(low, start) >= PIECE_M / 50
        ]
        if not inside:
            continue
        instance = built.last_thing("marking")
        pieces = _pieces_of(stroke, inside, instance)
        add_paint(section, built, stroke.rectangles, worn, pieces)
        built.truth.append(_truth(section, stroke, inside, pieces))


def _pieces_of(stroke: PaintedStroke, inside: Sequence[Rectangle], instance: int) -> SheetPieces:
    is_across = stroke.type == "stop_line"
    first, last = (2, 3) if is_across else (0, 1)
    low, high = min(one[first] for one in inside), max(one[last] for one in inside)
    count = min(_MOST_PIECES, max(1, round((high - low) / PIECE_M)))
    return SheetPieces(instance, np.linspace(low, high, count + 1), is_across=is_across)


def _truth(
    section: StreetSection, stroke: PaintedStroke, inside: Sequence[Rectangle], pieces: SheetPieces
) -> TrueFeature:
    low, high, right, left = inside[0]
    if pieces.is_across:
        line = section.position(np.full(len(pieces.ends_m), (low + high) / 2), pieces.ends_m)
        wide = high - low
    else:
        line = section.position(pieces.ends_m, np.full(len(pieces.ends_m), (right + left) / 2))
        wide = left - right
    facts: dict[str, Fact] = {
        "kind": _KINDS.get(stroke.type, "marking_line"),
        "type": stroke.type,
        "width_m": wide,
        "colour": "white",
    }
    if stroke.pattern_m is not None:
        facts["pattern_m"] = list(stroke.pattern_m)
    if stroke.type == "broken":
        facts["painted"] = _painted(inside, pieces.ends_m)
    middle = (section.plan.start_m + section.plan.end_m) / 2
    return TrueFeature("markings", "LineString", line, facts, pieces.instance, middle)


def _painted(inside: Sequence[Rectangle], ends_m: Floats) -> list[float]:
    """1.0 for each piece with paint enough on it, 0.0 for one in a gap."""
    long = np.diff(ends_m)
    covered = np.zeros(long.size)
    for low, high, *_ in inside:
        covered += np.clip(np.minimum(ends_m[1:], high) - np.maximum(ends_m[:-1], low), 0.0, None)
    painted: list[float] = (covered >= _PAINTED_SHARE * long).astype(np.float64).tolist()
    return painted


def truth_line(
    section: StreetSection, instance: int, line: Floats, width_m: float, *, is_bar: bool
) -> TrueFeature:
    """The truth of a bar or a stop line that was laid on a side street."""
    kind = "crosswalk_bar" if is_bar else "stop_line"
    facts: dict[str, Fact] = {
        "kind": kind,
        "type": kind,
        "width_m": width_m,
        "colour": "white",
    }
    middle = (section.plan.start_m + section.plan.end_m) / 2
    return TrueFeature("markings", "LineString", line, facts, instance, middle)
