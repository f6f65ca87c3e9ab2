"""Following a road marking: the bright stripe in the profile of intensities, again and again."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.image.tracing.trace_points import PointsBetween
from processing.image.tracing.trace_search import TracePoint

MIDDLE, LEFT, RIGHT = 0.0, 1.0, -1.0
"""Which line of the stripe is followed; left and right in the direction of the trace."""

_REACH_M = 0.5
"""A stripe is looked for so far around a click: half of the widest and some road. By trial; no
measurement is recorded."""

_ALONG_M = 0.3
"""Half the length of line that is looked at: several rows. By trial; no measurement is recorded."""

_NARROWEST_M, _WIDEST_M = 0.05, 0.60
"""Markings are 10 to 45 cm wide."""

_FEWEST, _FEWEST_BRIGHT = 20, 5
"""Points of a profile, and bright and dark ones among them. By trial; no measurement is
recorded."""

_LEAST_CONTRAST = 2.5
"""Difference of the means of bright and dark points, in standard deviations. By trial; no
measurement is recorded."""

_FLATTEST_M = 0.02
"""Points lie within so much of a plane, standard deviation: a marking is on the road. By trial; no
measurement is recorded."""

_ROAD_M, _LEAST_SPREAD = 0.15, 1e-9
"""Road beside a stripe that is looked at too, m; guard where all are equally bright."""

_WIDTH_M = 0.06
"""A stripe may change its width so much from place to place: a spacing of points on either side."""

_BESIDE_M = 0.12
"""As in `trace_edges`."""

_PURE = 0.75
"""So much of the stripe is bright, and of what is beside it dark. By trial; no measurement is
recorded."""


class MarkingFollower:
    """Follows the middle or a border of a painted stripe.

    The look of a stripe: which of its lines is followed; its width, m.

    Parameters
    ----------
    intensity : (n,) float64
        Of the points of the cloud.
    """

    def __init__(self, cloud: PointsBetween, intensity: Floats) -> None:
        self._cloud = cloud
        self._intensity = intensity

    def positions_at(self, xyz: Floats) -> Sequence[TracePoint]:
        """The line of a stripe nearest to a place within 12 cm of it; none on plain ground."""
        near = self._cloud.near(xyz, _REACH_M)
        heading = _first_heading(self._cloud.xyz[near] - xyz, self._intensity[near])
        if heading is None:
            return []
        start = TracePoint(xyz, heading, 0.0, 0.0, (MIDDLE, math.nan))
        stripe = self._stripe(start, _REACH_M)
        if stripe is None:
            return []
        stripe = self._stripe(replace(stripe, xyz=xyz), _REACH_M) or stripe
        lines = [_line(stripe, side) for side in (MIDDLE, LEFT, RIGHT)]
        nearest = min(lines, key=lambda line: float(np.linalg.norm(line.xyz - xyz)))
        return [nearest] if np.linalg.norm(nearest.xyz - xyz) <= _BESIDE_M else []

    def positions_near(
        self, expected: TracePoint, slack_m: float
    ) -> Sequence[tuple[TracePoint, float]]:
        """The line again near an expected place, with how unlike the stripe's width is."""
        side, width = expected.look
        stripe = self._stripe(_middle(expected), width / 2 + slack_m + _ROAD_M)
        if stripe is None:
            return []
        found = _line(stripe, side)
        unlike = ((stripe.look[1] - width) / _WIDTH_M) ** 2
        off = float(np.linalg.norm(found.xyz - expected.xyz))
        return [(found, unlike)] if off <= slack_m and unlike <= 1.0 else []

    def turned(self, position: TracePoint) -> TracePoint:
        """The same line for the opposite direction."""
        side, width = position.look
        return TracePoint(
            position.xyz,
            position.heading_rad + math.pi,
            -position.grade,
            -position.curvature,
            (-side, width),
        )

    def _stripe(self, expected: TracePoint, across_m: float) -> TracePoint | None:
        """The brightest stripe across an expected direction: its middle, better directed."""
        near = self._cloud.near(expected.xyz, math.hypot(across_m, _ALONG_M))
        local = self._cloud.xyz[near] - expected.xyz
        cos, sin = math.cos(expected.heading_rad), math.sin(expected.heading_rad)
        along, across = local[:, 0] * cos + local[:, 1] * sin, local[:, 1] * cos - local[:, 0] * sin
        inside = (np.abs(along) <= _ALONG_M) & (np.abs(across) <= across_m)
        if int(inside.sum()) < _FEWEST:
            return None
        along, across, height = along[inside], across[inside], local[inside, 2]
        design = np.column_stack([along, across, np.ones(along.size)])
        plane = np.linalg.lstsq(design, height, rcond=None)[0]
        if float(np.std(height - design @ plane)) > _FLATTEST_M:
            return None
        is_bright = _bright(self._intensity[near][inside])
        borders = None if is_bright is None else _borders(across, is_bright)
        if is_bright is None or borders is None:
            return None
        middle, width = (borders[0] + borders[1]) / 2, borders[1] - borders[0]
        on_stripe = is_bright & (across >= borders[0]) & (across <= borders[1])
        turn = _slope(along[on_stripe], across[on_stripe])
        position = np.array([-sin * middle, cos * middle, plane[1] * middle + plane[2]])
        return TracePoint(
            expected.xyz + position,
            expected.heading_rad + math.atan(turn),
            float(plane[0] + turn * plane[1]),
            0.0,
            (MIDDLE, width),
        )


def _bright(intensity: Floats) -> NDArray[np.bool_] | None:
    """Which points are paint: the split with the least spread on both sides (Otsu 1979)."""
    ordered = np.sort(intensity)
    count = np.arange(1, ordered.size)
    sums = np.cumsum(ordered)[:-1]
    low, high = sums / count, (ordered.sum() - sums) / (ordered.size - count)
    split = int((count * (ordered.size - count) * (high - low) ** 2).argmax())
    is_bright = np.asarray(intensity > ordered[split])
    if min(int(is_bright.sum()), int((~is_bright).sum())) < _FEWEST_BRIGHT:
        return None
    spread = math.hypot(float(intensity[is_bright].std()), float(intensity[~is_bright].std()))
    contrast = float(intensity[is_bright].mean() - intensity[~is_bright].mean())
    return is_bright if contrast > _LEAST_CONTRAST * max(spread, _LEAST_SPREAD) else None


def _borders(across: Floats, is_bright: NDArray[np.bool_]) -> tuple[float, float] | None:
    """The stretch that holds the most bright points and the fewest dark ones."""
    order = np.argsort(across)
    sorted_across = across[order]
    score = np.concatenate([[0], np.cumsum(np.where(is_bright[order], 1, -1))])
    lowest = np.minimum.accumulate(score)
    last = int((score - lowest).argmax())
    first = int(np.flatnonzero(score[: last + 1] == lowest[last])[-1])
    if first == 0 or last == across.size or last - first < _FEWEST_BRIGHT:
        return None
    pure = (score[last] - score[first]) / (last - first)
    left = float(sorted_across[first - 1] + sorted_across[first]) / 2
    right = float(sorted_across[last - 1] + sorted_across[last]) / 2
    is_stripe = _NARROWEST_M <= right - left <= _WIDEST_M and pure >= 2 * _PURE - 1
    return (left, right) if is_stripe else None


def _first_heading(local: Floats, intensity: Floats) -> float | None:
    """The long axis of the bright points around a place."""
    is_bright = _bright(intensity) if intensity.size >= _FEWEST else None
    if is_bright is None:
        return None
    bright = local[is_bright][:, :2]
    values, vectors = np.linalg.eigh(np.cov(bright.T))
    # A stripe 45 cm wide in a circle of 1 m: variances of 0.017 and 0.06.
    if values[1] < 2 * values[0]:
        return None
    return math.atan2(vectors[1, 1], vectors[0, 1])


def _slope(along: Floats, across: Floats) -> float:
    spread = float(((along - along.mean()) ** 2).sum())
    if spread <= 0:
        return 0.0
    return float(((along - along.mean()) * (across - across.mean())).sum()) / spread


def _line(stripe: TracePoint, side: float) -> TracePoint:
    """A border of a stripe from its middle."""
    return replace(stripe, xyz=stripe.xyz + _aside(stripe, side), look=(side, stripe.look[1]))


def _middle(line: TracePoint) -> TracePoint:
    side, width = line.look
    return replace(line, xyz=line.xyz - _aside(line, side), look=(MIDDLE, width))


def _aside(position: TracePoint, side: float) -> Floats:
    left = np.array([-math.sin(position.heading_rad), math.cos(position.heading_rad), 0.0])
    return np.asarray(side * position.look[1] / 2 * left) if side else np.zeros(3)
