"""True curbs cut into the sections that are judged, with what the points show of each."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from processing.core.arrays import Floats
from processing.core.text import Text
from processing.scoring.features.line_positions import between, length_m
from processing.scoring.features.mapped_features import MappedFeature, MappedFile

SECTION_M = 2.0
"""Mms.md 6.4: what is judged at a time."""

COVERED_SHARE = 0.5
"""A true section is asked for if the points show most of it."""

_SLIVER_M = 0.5  # a rest so short belongs to the section before it


@dataclass(frozen=True)
class TrueSection:
    """Some two metres of one true edge.

    Attributes
    ----------
    xyz : (n, 3) float64
        Its corners, m.
    kind : str
        ``curb``, ``dropped`` or ``back``.
    is_asked : bool
        Whether it has to be found: it is no rear edge, the vehicle passed it and points show it.
    step_m : float
        The curb's mean step; NaN where the truth has none.
    """

    xyz: Floats
    kind: str
    is_asked: bool
    step_m: float


def pieces_of(line: Floats) -> list[Floats]:
    """A line cut every two metres; a short rest belongs to the last piece."""
    long_m = length_m(line)
    count = max(1, math.ceil((long_m - _SLIVER_M) / SECTION_M))
    cuts = [*(number * SECTION_M for number in range(count)), long_m]
    return [between(line, start, end) for start, end in itertools.pairwise(cuts)]


def kind_of(line: MappedFeature) -> str:
    """What a line is: ``curb`` where it doesn't say, ``back`` for the rear edge of kerb stones."""
    named = line.facts.get("type")
    return "back" if "back" in (named, line.facts.get("edge")) else str(named or "curb")


def sections_of(truth: MappedFile, lines: Sequence[MappedFeature]) -> list[TrueSection]:
    """The sections of true edges; those that the truth lists, or else every two metres.

    Raises
    ------
    BadFile
        The list of sections, or a number in it, isn't what it should be.
    """
    return [section for line in lines for section in _sections(truth, line)]


def _sections(truth: MappedFile, line: MappedFeature) -> Iterator[TrueSection]:
    kind = kind_of(line)
    step_m = truth.number(line, "height_m")
    listed = line.facts.get("sections")
    if listed is None:
        parts = [(piece, True) for piece in pieces_of(line.xyz)]
    elif isinstance(listed, list):
        spans = [_span(truth, line, one) for one in listed]
        parts = [(between(line.xyz, start, end), seen) for start, end, seen in spans]
    else:
        raise truth.wrong(line, "sections", Text("a list", "リスト"))
    for xyz, is_seen in parts:
        if length_m(xyz) > 0:
            yield TrueSection(xyz, kind, is_seen and kind != "back", step_m)


def _span(truth: MappedFile, line: MappedFeature, one: object) -> tuple[float, float, bool]:
    """From where to where a listed section is, and whether it is shown."""
    facts = one if isinstance(one, dict) else {}
    values = [facts.get("u0"), facts.get("u1"), facts.get("covered", 1.0)]
    numbers = [float(v) for v in values if isinstance(v, (int, float))]
    if len(numbers) < len(values):
        raise truth.wrong(line, "sections", Text.same("u0, u1, covered"))
    is_seen = facts.get("in_span") is not False and numbers[2] >= COVERED_SHARE
    return numbers[0], numbers[1], is_seen
