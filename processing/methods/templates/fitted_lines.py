"""Candidate lines of a walk: bridged, split, simplified, resting on measured points."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.image.search.nearest import nearest_point
from processing.map.drafting.needed_positions import needed_positions
from processing.methods.templates.fit import FitSettings, TemplatePath
from processing.methods.templates.profile_template import MadeLine, ProfileTemplate
from processing.recording.drive import Drive

_Floats = NDArray[np.float64]
_Integers = NDArray[np.int64]

_SIMPLER_M = 0.005
"""Vertices that lie no farther from a line without them are left out: a scanner's noise."""

_RESTS_WITHIN_M = 0.05
"""A measured point so near to a vertex is one that it rests on; by judgement."""

_FEWEST_POSITIONS = 3
"""Of a line that is kept: two sections may show by chance what looks like the shape."""

_SAMPLES_PER_METRE = 4
"""Scores asked for the mean of each metre."""


@dataclass(frozen=True)
class FittedLine:
    """One line that a template made.

    Attributes
    ----------
    kind : str
        Id of a feature kind.
    edge : str
        ``upper`` or ``lower`` where the template makes lines of one kind at different heights.
    xyz : (n, 3) float64
        m, project CRS.
    points : (n,) int64
        The measured point nearest to each position, within 5 cm; −1: none.
    scores : (m,) float64
        Of each metre from the line's start, the last one may be shorter.
    """

    kind: str
    edge: str
    xyz: _Floats
    points: _Integers
    scores: _Floats

    @property
    def length_m(self) -> float:
        """Length in space."""
        return float(np.linalg.norm(np.diff(self.xyz, axis=0), axis=1).sum())

    @property
    def confidence(self) -> float:
        """Mean score over the length."""
        return float(self.scores.mean())


def fitted_lines(
    drive: Drive, walk: TemplatePath, settings: FitSettings, monitor: Monitor
) -> tuple[FittedLine, ...]:
    """The lines of a walk, in its order, those of one stretch beside each other.

    A gap of up to the longest one is crossed in a straight line; at a longer one a line ends.
    Places are left out where the line stays within 5 mm without them.
    """
    lines = []
    for start, end in _stretches(walk, settings):
        for made in walk.template.lines:
            monitor.check()
            lines.append(_line(drive, walk, made, slice(start, end), settings))
    return tuple(lines)


def _stretches(walk: TemplatePath, settings: FitSettings) -> list[tuple[int, int]]:
    """First and end position of each line."""
    fits = np.flatnonzero(walk.scores >= settings.least_score)
    between = _along(walk.positions[fits])
    gaps = np.diff(between, prepend=-math.inf) > settings.longest_gap_m + settings.step_m
    parts = np.split(fits, np.flatnonzero(gaps[1:]) + 1)
    return [(int(part[0]), int(part[-1]) + 1) for part in parts if part.size >= _FEWEST_POSITIONS]


def _line(
    drive: Drive, walk: TemplatePath, made: MadeLine, stretch: slice, settings: FitSettings
) -> FittedLine:
    scores = walk.scores[stretch]
    positions = _positions(walk, made)[stretch]
    fits = scores >= settings.least_score
    xyz = positions[fits]
    xyz = xyz[needed_positions(xyz, _SIMPLER_M)]
    points = [nearest_point(drive, position, _RESTS_WITHIN_M) for position in xyz]
    return FittedLine(
        made.kind,
        _edge(walk.template, made),
        xyz,
        np.array(points, dtype=np.int64),
        _per_metre(_along(walk.positions[stretch]), scores),
    )


def _positions(walk: TemplatePath, made: MadeLine) -> _Floats:
    """(n, 3) where a vertex of the template came to lie."""
    offset, height = made.at
    cos, sin = np.cos(walk.tilts_rad), np.sin(walk.tilts_rad)
    across, up = offset * cos - height * sin, offset * sin + height * cos
    east, north = np.sin(walk.headings_rad), -np.cos(walk.headings_rad)
    return walk.positions + np.column_stack([across * east, across * north, up])


def _per_metre(along: _Floats, scores: _Floats) -> _Floats:
    """Mean score of the positions in each metre, linear between them."""
    step_m = 1.0 / _SAMPLES_PER_METRE
    middles = np.arange(0.0, max(along[-1], 1.0), step_m) + step_m / 2
    between = np.interp(middles, along, scores)
    metre = middles.astype(np.int64)
    means: _Floats = np.bincount(metre, between) / np.bincount(metre)
    return means


def _along(positions: _Floats) -> _Floats:
    """(n,) plan distance from the first position along the line."""
    steps = np.linalg.norm(np.diff(positions[:, :2], axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def _edge(template: ProfileTemplate, made: MadeLine) -> str:
    heights = [line.at[1] for line in template.lines if line.kind == made.kind]
    if min(heights) == max(heights):
        return ""
    return {max(heights): "upper", min(heights): "lower"}.get(made.at[1], "")
