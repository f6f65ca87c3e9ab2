"""Truth of the carriageway's edges where no curb stands: where its asphalt ends without a step.

The line, and what lies outside of it. Neither asked for nor wrong, type ``other``: the asphalt's
edge in front of a gutter with a curb behind, the foot of a curb that is lowered to 2 cm or less,
and corners of side streets, which lead away from the carriageway that was driven.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from processing.core.arrays import Flags
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.scene.things import NO_THING, Fact, SectionBuilder, TrueFeature
from processing.laboratory.simulate.street.plan import LEFT, SIDES, SidePlan
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.sweep import Sweep

_PIECE_M = 1.0
_STEP_M = 0.02
"""What rises more is a curb."""

_GUTTERS = ("apron", "drain", "rim")
_OTHER = "other"
_OUTSIDE = {
    **dict.fromkeys(_GUTTERS, "gutter"),
    "verge": "grass",
    "shoulder": "soil",
    "walk": "walk",
}
"""What lies outside, by the first strip beside the asphalt."""


def add_edges(section: StreetSection, built: SectionBuilder) -> None:
    """Add the edges of a section, and those of the corners of its side streets."""
    for side in SIDES:
        part, plan = section.layout.sides[side], section.plan.side(side)
        if side not in section.plan.junctions:
            for line, kind in _edges_of(section, part.sweep, plan):
                _add_line(built, (side, section), line, kind)
        for corner in part.corners:
            turn = corner.track.first + 1
            for line, kind in _edges_of(section, corner.sweep, plan):
                driven = turn if kind != _OTHER else 0
                _add_line(built, (side, section), line[:driven], kind)
                _add_line(built, (side, section), line[max(driven - 1, 0) :], _OTHER)


def _edges_of(section: StreetSection, sweep: Sweep, plan: SidePlan) -> Iterator[tuple[Floats, str]]:
    strip = sweep.profile.strips[0]
    is_gutter = strip.kind in _GUTTERS
    edge = _line(section, sweep, 0)
    if plan.curb == "none":
        yield edge, _OUTSIDE.get(strip.kind, _OTHER)
        return
    if is_gutter:
        yield edge, _OTHER
    stone = sweep.profile.edges[0]
    foot, top = _line(section, sweep, stone.foot), _line(section, sweep, stone.top)
    is_low = top[:, 2] - foot[:, 2] <= _STEP_M
    for first, end in _stretches(is_low):
        yield foot[first:end], _OTHER


def _line(section: StreetSection, sweep: Sweep, at: int) -> Floats:
    return section.alignment.at(sweep.chainages[:, at], sweep.offsets[:, at], sweep.heights[:, at])


def _stretches(flags: Flags) -> list[tuple[int, int]]:
    turns = np.flatnonzero(np.diff(np.r_[0, flags.astype(np.int64), 0]))
    return [(first, end) for first, end in turns.reshape(-1, 2).tolist() if end - first > 1]


def _add_line(
    built: SectionBuilder, where: tuple[int, StreetSection], line: Floats, outside: str
) -> None:
    """Add a line in pieces of half a metre to a metre."""
    side, section = where
    along = np.r_[0.0, np.cumsum(np.hypot(*np.diff(line[:, :2], axis=0).T))]
    if len(line) < 2 or along[-1] < _PIECE_M / 2:
        return
    count = int(np.ceil(along[-1] / _PIECE_M)) + 1
    at = np.linspace(0.0, along[-1], count)
    pieces = np.column_stack([np.interp(at, along, axis) for axis in line.T])
    facts: dict[str, Fact] = {
        "kind": "road_edge",
        "type": outside,
        "side": "left" if side == LEFT else "right",
    }
    middle = (section.plan.start_m + section.plan.end_m) / 2
    built.truth.append(TrueFeature("edges", "LineString", pieces, facts, NO_THING, middle))
