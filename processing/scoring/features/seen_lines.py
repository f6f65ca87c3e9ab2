"""Places along true lines that the points show, and what a result makes up beside them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Flags, Floats, Integers
from processing.scoring.features.line_positions import PolylineIndex, middle_positions
from processing.scoring.features.mapped_features import MappedFeature

STEP_M = 0.1
"""Between judged places; counts are in decimetres."""

BESIDE_M = 0.3
"""A result so near to what isn't asked for isn't judged."""


@dataclass(frozen=True)
class LinePlaces:
    """Places along lines, the line of each, and whether it is asked for."""

    xyz: Floats
    line: Integers
    is_asked: Flags


def places_of(lines: Sequence[MappedFeature], least_points: float) -> LinePlaces:
    """Places along true lines; all are asked for where the truth doesn't tell what is seen.

    Parameters
    ----------
    least_points : float
        On a metre, below which nothing could be said of it.
    """
    parts = [middle_positions(one.xyz, STEP_M) for one in lines]
    owner = np.repeat(np.arange(len(parts)), [len(one) for one in parts]).astype(np.int64)
    asked = [is_seen(one, len(part), least_points) for one, part in zip(lines, parts, strict=True)]
    return LinePlaces(
        np.concatenate([np.empty((0, 3)), *parts]),
        owner,
        np.concatenate([np.empty(0, np.bool_), *asked]),
    )


def is_seen(line: MappedFeature, count: int, least_points: float) -> Flags:
    """Which of so many places along a line lie on pieces that the points show."""
    steps = np.hypot(*np.diff(line.xyz[:, :2], axis=0).T)
    ends = np.cumsum(steps)
    at = (np.arange(count) + 0.5) * ends[-1] / count
    piece = np.minimum(np.searchsorted(ends, at), steps.size - 1)
    seen = np.ones(count, np.bool_)
    points, span = line.facts.get("piece_points"), line.facts.get("piece_in_span")
    if isinstance(points, list) and len(points) == steps.size:
        seen &= (np.array(points, np.float64) >= least_points * steps)[piece]
    if isinstance(span, list) and len(span) == steps.size:
        seen &= np.array([bool(one) for one in span])[piece]
    return seen


def made_up(
    found: Sequence[MappedFeature],
    true: tuple[Sequence[MappedFeature], LinePlaces],
    others: Sequence[MappedFeature],
    within_m: float,
) -> Flags:
    """Places along found lines that lie on no line, but for those beside what isn't asked for.

    Of several found lines along one true one the nearest is right.

    Parameters
    ----------
    true : (sequence of MappedFeature, LinePlaces)
        Lines and the places along them.
    others : sequence of MappedFeature
        True lines of other kinds, beside which nothing is judged.
    within_m : float
        How far off a line may lie.

    Returns
    -------
    (n,) bool
        Of the places every `STEP_M` along each found line, one line after the other.
    """
    lines, places = true
    if not found:
        return np.empty(0, np.bool_)
    parts = [middle_positions(one.xyz, STEP_M) for one in found]
    own = np.repeat(np.arange(len(parts)), [len(one) for one in parts])
    xyz = np.concatenate(parts)
    met = PolylineIndex([one.xyz for one in lines]).nearest(xyz, within_m)
    is_right = met.line >= 0
    nearest = PolylineIndex([one.xyz for one in found]).nearest(
        np.where(is_right[:, None], met.xyz, xyz), within_m
    )
    is_right &= nearest.line == own
    unseen = places.xyz[~places.is_asked]
    beside = PolylineIndex([one.xyz for one in others]).nearest(xyz, BESIDE_M).line >= 0
    if len(unseen):
        from scipy.spatial import cKDTree

        away, _ = cKDTree(unseen[:, :2]).query(xyz[:, :2])
        beside |= away < BESIDE_M
    return np.asarray(~is_right & ~beside)
