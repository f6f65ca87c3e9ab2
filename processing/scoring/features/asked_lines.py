"""Lines by length in plan: which stretches are asked for, and what of a result lies on none."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Flags, Floats, Integers
from processing.scoring.features.line_positions import PolylineIndex, middle_positions
from processing.scoring.features.mapped_features import MappedFeature


@dataclass(frozen=True)
class ScoredLineLimits:
    """How lines are judged.

    Attributes
    ----------
    tolerance_m : float
        In plan, from line to line.
    step_m : float
        Between judged places.
    least_points : float
        On a metre, below which nothing could be said of it.
    beside_m : float
        A result so near to what isn't asked for isn't judged.
    """

    tolerance_m: float
    step_m: float
    least_points: float
    beside_m: float


@dataclass(frozen=True)
class AskedPlaces:
    """Places along lines, the line of each, and whether it is asked for."""

    xyz: Floats
    line: Integers
    is_asked: Flags


def asked_places(lines: Sequence[MappedFeature], limits: ScoredLineLimits) -> AskedPlaces:
    """Places along true lines; all are asked for where the truth doesn't tell what is seen."""
    parts = [middle_positions(one.xyz, limits.step_m) for one in lines]
    owner = np.repeat(np.arange(len(parts)), [len(one) for one in parts]).astype(np.int64)
    asked = [
        is_seen(one, len(part), limits.least_points) for one, part in zip(lines, parts, strict=True)
    ]
    return AskedPlaces(
        np.concatenate([np.empty((0, 3)), *parts]),
        owner,
        np.concatenate([np.empty(0, np.bool_), *asked]),
    )


def is_seen(line: MappedFeature, count: int, least_points: float) -> Flags:
    """Which of some equal pieces of a true line have points enough and were passed."""
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


def made_up_places(
    found: Sequence[MappedFeature],
    true: tuple[Sequence[MappedFeature], AskedPlaces],
    others: Sequence[MappedFeature],
    limits: ScoredLineLimits,
) -> Flags:
    """Places of found lines that lie on no line, but for those beside what isn't asked for.

    Of several found lines along one true one the nearest is right.

    Parameters
    ----------
    others : sequence of MappedFeature
        Lines that are neither asked for nor wrong.

    Returns
    -------
    (n,) bool
        Of the places along each found line, one line after the other.
    """
    lines, places = true
    if not found:
        return np.empty(0, np.bool_)
    parts = [middle_positions(one.xyz, limits.step_m) for one in found]
    own = np.repeat(np.arange(len(parts)), [len(one) for one in parts])
    xyz = np.concatenate(parts)
    met = PolylineIndex([one.xyz for one in lines]).nearest(xyz, limits.tolerance_m)
    is_right = met.line >= 0
    nearest = PolylineIndex([one.xyz for one in found]).nearest(
        np.where(is_right[:, None], met.xyz, xyz), limits.tolerance_m
    )
    is_right &= nearest.line == own
    unseen = places.xyz[~places.is_asked]
    index = PolylineIndex([one.xyz for one in others])
    beside = index.nearest(xyz, limits.beside_m).line >= 0
    if len(unseen):
        from scipy.spatial import cKDTree

        away, _ = cKDTree(unseen[:, :2]).query(xyz[:, :2])
        beside |= away < limits.beside_m
    return np.asarray(~is_right & ~beside)
