"""A template as arrays, cut into bins along its shape, for the kernels that fit it."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from processing.methods.templates.fit_kernels import (
    ALONG_U,
    ALONG_V,
    LENGTH,
    SEGMENT,
    EmptyZones,
)
from processing.methods.templates.profile_template import ProfilePoint, ProfileTemplate
from processing.methods.templates.slab import SlabBox

_Floats = NDArray[np.float64]

_BIN_M = 0.02
"""Length of the shape in which points are counted together: the usual tolerance."""

_LEAST_REACH_M, _MOST_REACH_M, _REACH_TOLERANCES = 0.10, 0.30, 3
"""How far off the shape points count against it, at least and at most, and in tolerances at least:
about a low curb's height, and what is beside any curb. By trial."""

_SHORTEST_M = 1e-4
"""Pieces no longer than this have no direction; templates are written to the tenth of a mm."""


@dataclass(frozen=True)
class FittableTemplate:
    """A template ready to be fitted.

    Attributes
    ----------
    template : ProfileTemplate
    segments : (k, SEGMENT) float64
        Straight pieces; see `fit_kernels`.
    zones : EmptyZones
    tolerance_m : float
    reach_m : float
        Points within it that don't lie on the shape count against it: as far as the shape is high,
        so that a curb that isn't there is missed where the ground lies level instead.
    """

    template: ProfileTemplate
    segments: _Floats
    zones: EmptyZones
    tolerance_m: float
    reach_m: float

    @staticmethod
    def of(template: ProfileTemplate, tolerance_m: float = 0.0) -> FittableTemplate:
        """The arrays of a template, with a tolerance of its own or another one."""
        tolerance = tolerance_m or template.tolerance_m
        heights = [position[1] for position in template.vertices]
        reach = max(heights) - min(heights) + 2 * tolerance
        least = _REACH_TOLERANCES * tolerance
        return FittableTemplate(
            template,
            _segments(template),
            _zones(template),
            tolerance,
            min(max(reach, _LEAST_REACH_M, least), max(_MOST_REACH_M, least)),
        )

    @cached_property
    def weak_direction(self) -> tuple[float, float]:
        """Unit vector (across, up) in which the shape may be moved with the least effect."""
        along = self.segments[:, [ALONG_U, ALONG_V]]
        scatter = (along * self.segments[:, LENGTH, None]).T @ along
        across, up = np.linalg.eigh(scatter)[1][:, 1]
        return float(across), float(up)

    def box(self, more_m: float) -> SlabBox:
        """What a fit looks at, and some more around."""
        left, right, low, high = self.template.box
        aside = self.reach_m + more_m
        return SlabBox(left - aside, right + aside, low - aside, high + aside)


def _segments(template: ProfileTemplate) -> _Floats:
    pieces = [
        (one, other)
        for profile in template.shape
        for one, other in itertools.pairwise(profile)
        if math.dist(one, other) > _SHORTEST_M
    ]
    lines = []
    bins = 0
    for one, other in pieces:
        length = math.dist(one, other)
        along = (other[0] - one[0]) / length, (other[1] - one[1]) / length
        count = max(1, round(length / _BIN_M))
        joined = (float(_touching(pieces, end) > 1) for end in (one, other))
        lines.append([*one, *along, length, bins, count, *joined])
        bins += count
    return np.array(lines, dtype=np.float64).reshape(-1, SEGMENT)


def _touching(pieces: list[tuple[ProfilePoint, ProfilePoint]], position: ProfilePoint) -> int:
    """How many pieces end at a position."""
    return sum(math.dist(position, end) <= _SHORTEST_M for piece in pieces for end in piece)


def _zones(template: ProfileTemplate) -> EmptyZones:
    positions = [position for ring in template.empty for position in ring]
    starts = np.cumsum([0, *(len(ring) for ring in template.empty)])
    corners = np.array(positions, dtype=np.float64).reshape(-1, 2)
    return EmptyZones(corners, starts.astype(np.int64))
