"""Truth of walls and of faces of buildings: the line in which each stands on the ground.

The line of a wall that is swept along the road, the outline of a body with a rectangle for its
plan. Its pieces are a metre long at most, so that truth can say which of them the points show.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from typing import Literal

import numpy as np

from processing.laboratory.simulate.border.along import stations
from processing.laboratory.simulate.border.parts import BorderPart
from processing.laboratory.simulate.scene.mesh import Floats, place_shape
from processing.laboratory.simulate.scene.things import NO_THING, Fact, SectionBuilder, TrueFeature
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.sweep import Sweep

WallType = Literal["wall", "retaining", "building", "other"]

_KINDS = {"retaining": "revetment_concrete", "building": "building_face"}

_PIECE_M = 1.0
_LEAST_BODY_M = np.array([1.0, 1.0, 2.0])
"""Width, depth and height of a body that is a building: porches, boxes and doors are smaller."""

_BOX_CORNERS = 8
_LEAST_RISE_M, _MOST_LEAN = 0.4, 0.35
"""Of a stretch of ground that is a retaining wall; what rises less steeply is a bank."""


def add_wall_line(
    section: StreetSection,
    built: SectionBuilder,
    instance: int,
    line: Floats,
    measures: tuple[WallType, float, float],
) -> None:
    """Add the truth of a line on the ground.

    Parameters
    ----------
    line : (n, 3) float64
        m, the street's frame.
    measures : (str, float, float)
        Its type, height above the line, m, and how far it leans back for each metre it rises.
    """
    kind, high, lean = measures
    facts: dict[str, Fact] = {
        "kind": _KINDS.get(kind, "wall"),
        "type": kind,
        "height_m": high,
        "lean": lean,
    }
    middle = (section.plan.start_m + section.plan.end_m) / 2
    built.truth.append(TrueFeature("walls", "LineString", line, facts, instance, middle))


def add_swept_wall(
    section: StreetSection,
    built: SectionBuilder,
    instance: int,
    where: tuple[float, float, float],
    measures: tuple[WallType, float, float],
) -> None:
    """Add the truth of a wall along the road: chainages from and to, offset of its face."""
    low, far, offset = where
    line = section.position(stations(low, far, _PIECE_M), offset)
    add_wall_line(section, built, instance, line, measures)


def add_body_outlines(
    section: StreetSection,
    built: SectionBuilder,
    instance: int,
    parts: Sequence[BorderPart],
    where: tuple[Floats, float],
) -> None:
    """Add the outlines of a building's bodies, placed as its parts are."""
    position, heading = where
    for corners, high, kind in _bodies(parts):
        ring = place_shape((_in_pieces(corners), np.empty((0, 3), np.int64)), position, heading)[0]
        add_wall_line(section, built, instance, ring, (kind, high, 0.0))


def add_block_outline(
    section: StreetSection,
    built: SectionBuilder,
    instance: int,
    corners: Floats,
    measures: tuple[WallType, float],
) -> None:
    """Add the outline of an upright body from the corners of its foot: (k, 3) float64."""
    kind, high = measures
    add_wall_line(section, built, instance, _in_pieces(corners), (kind, high, 0.0))


def _bodies(parts: Sequence[BorderPart]) -> Iterator[tuple[Floats, float, WallType]]:
    """Corners of the foot, height and type of each large body, in the lot's frame.

    What is no block has no upright faces: tunnels of plastic sheets.
    """
    for (vertices, _), _ in parts:
        low, high = vertices.min(axis=0), vertices.max(axis=0)
        if np.all(high - low >= _LEAST_BODY_M) and low[2] <= 0.0:
            xs, ys = (low[0], high[0]), (low[1], high[1])
            plan = [(xs[0], ys[0]), (xs[1], ys[0]), (xs[1], ys[1]), (xs[0], ys[1])]
            is_block = len(vertices) == _BOX_CORNERS
            corners = np.array([(*one, 0.0) for one in plan])
            yield corners, float(high[2]), "building" if is_block else "other"


def _in_pieces(corners: Floats) -> Floats:
    """A closed ring in pieces of a metre at most."""
    ends = np.concatenate([corners, corners[:1]])
    sides = []
    for start, end in itertools.pairwise(ends):
        count = max(1, int(np.ceil(np.linalg.norm(end - start) / _PIECE_M)))
        sides.append(start + np.arange(count)[:, None] / count * (end - start))
    return np.concatenate([*sides, ends[-1:]])


def add_ground_walls(
    section: StreetSection, built: SectionBuilder, sweep: Sweep, strip: int
) -> None:
    """Add the truth of a strip of the ground that is a retaining wall, where it is steep."""
    lines = [
        section.alignment.at(sweep.chainages[:, at], sweep.offsets[:, at], sweep.heights[:, at])
        for at in (strip, strip + 1)
    ]
    foot, top = lines
    rise = top[:, 2] - foot[:, 2]
    run = np.hypot(*(top - foot)[:, :2].T)
    is_wall = (rise >= _LEAST_RISE_M) & (run <= _MOST_LEAN * rise)
    edges = np.flatnonzero(np.diff(np.r_[0, is_wall.astype(np.int64), 0]))
    for first, end in edges.reshape(-1, 2).tolist():
        if end - first < 2:
            continue
        kept = _apart(foot[first:end])
        high = float(rise[first:end].mean())
        lean = float(np.mean(run[first:end] / rise[first:end]))
        add_wall_line(section, built, NO_THING, kept, ("retaining", high, lean))


def _apart(line: Floats) -> Floats:
    """Nodes of a line half a piece apart at least, with both ends."""
    along = np.r_[0.0, np.cumsum(np.hypot(*np.diff(line[:, :2], axis=0).T))]
    kept = [0]
    for at in range(1, len(line) - 1):
        if along[at] - along[kept[-1]] >= _PIECE_M / 2:
            kept.append(at)
    return np.asarray(line[[*kept, len(line) - 1]])
