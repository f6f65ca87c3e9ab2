"""How complete and how right a map is, by one that was drawn separately of part of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from processing.core.monitor import Monitor
from processing.map.catalogue import Geometry
from processing.map.feature import Feature, Vertex
from processing.map.renewal.map_comparison import (
    ComparisonLimits,
    compare_maps,
    mapped_ground,
    share_within,
)


@dataclass(frozen=True)
class KindAgreement:
    """A kind on two maps: counts of points and areas, metres of lines.

    Attributes
    ----------
    truth : float
        On the map that was drawn separately.
    found : float
        On the map that is judged, within the other's outline.
    missed : float
        Of the truth, what the judged map lacks or has elsewhere.
    wrong : float
        Of what was found, what the truth lacks or has elsewhere.
    """

    kind: str
    is_line: bool
    truth: float
    found: float
    missed: float
    wrong: float

    @property
    def precision(self) -> float:
        """Of what was found, the share that is right; NaN where nothing was."""
        return max(0.0, 1.0 - self.wrong / self.found) if self.found else math.nan

    @property
    def recall(self) -> float:
        """Of the truth, the share that was found."""
        return max(0.0, 1.0 - self.missed / self.truth) if self.truth else math.nan


def agreement(
    truth: Sequence[Feature], judged: Sequence[Feature], tolerance_m: float, monitor: Monitor
) -> tuple[KindAgreement, ...]:
    """Judge a map by another: kinds that the truth has, within the outline around it.

    Parameters
    ----------
    tolerance_m : float
        What lies farther apart in plan is not the same.

    Raises
    ------
    Cancelled
    """
    if not truth:
        return ()
    limits = ComparisonLimits(tolerance_m, tolerance_m)
    reached = mapped_ground(truth, tolerance_m)
    differences = compare_maps(
        truth, judged, limits, lambda xy: np.ones(len(xy), np.bool_), monitor
    ).differences
    found_kinds = {(one.kind, one.geometry) for one in judged}
    agreements = []
    for kind, geometry in dict.fromkeys((one.kind, one.geometry) for one in truth):

        def own(change: str, kind: str = kind, geometry: Geometry = geometry) -> float:
            return sum(
                _amount(geometry, one.vertices)
                for one in differences
                if (one.kind, one.geometry, one.change) == (kind, geometry, change)
            )

        total = sum(
            _amount(geometry, one.vertices)
            for one in truth
            if (one.kind, one.geometry) == (kind, geometry)
        )
        found = 0.0
        for one in judged:
            if (one.kind, one.geometry) == (kind, geometry):
                share = share_within(reached, geometry, one.vertices)
                whole = share if geometry is Geometry.LINE else float(share >= 0.5)
                found += whole * _amount(geometry, one.vertices)
        is_found = (kind, geometry) in found_kinds
        missed = own("gone") + own("moved") if is_found else total
        wrong = own("new") + own("moved")
        is_line = geometry is Geometry.LINE
        agreements.append(KindAgreement(kind, is_line, total, found, missed, wrong))
    return tuple(agreements)


def _amount(geometry: Geometry, vertices: Sequence[Vertex]) -> float:
    """One of points and areas, the length in plan of lines."""
    if geometry is not Geometry.LINE:
        return 1.0
    xy = np.array([vertex.xyz[:2] for vertex in vertices])
    return float(np.hypot(*np.diff(xy, axis=0).T).sum())
