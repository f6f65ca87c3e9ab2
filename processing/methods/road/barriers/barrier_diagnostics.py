"""Why what stands beside a place in a section is a barrier or none, for the diagnostic layer."""

from __future__ import annotations

import math

import numpy as np

from processing.core.arrays import Floats
from processing.core.text import Text
from processing.methods.road.asked_points import points_beside
from processing.methods.road.barriers.barrier_confidence import likeliest
from processing.methods.road.barriers.barrier_facts import VehicleWay, WindowFacts, windows_of
from processing.methods.road.barriers.strip_kernels import STEP_M
from processing.methods.road.barriers.strip_profiles import profile_about
from processing.methods.road.diagnostics import Diagnostic, DiagnosticTest
from processing.methods.road.requested_position import RequestedPosition

_ABOUT_M = 2.6
"""About the place, so that 3 m along the way and what lies beside are seen."""

_ALONG_M, _ASIDE_M = 1.5, 0.4
_GROUND_SHARE = 0.1
_FEWEST = 20
_BAND_M = 0.05

_HIGH = Text("Height above the ground", "地面からの高さ")
_FULL = Text("Share of its length that is filled", "連なっている割合")
_EVEN = Text("Share of it with the same top", "上端の高さがそろう割合")
_ROUGH = Text("Scatter about a plane", "面からのばらつき")
_CHANCE = Text("Likelihood of a barrier", "防護柵・柵である見込み")

_LEAST_HIGH_M, _LEAST_FULL, _LEAST_EVEN, _MOST_ROUGH_M = 0.45, 0.5, 0.5, 0.05
"""What almost all barriers keep; their likelihood weighs these and more."""


def barrier_diagnostics(
    asked: RequestedPosition, least_confidence: float
) -> tuple[Diagnostic, ...]:
    """The cross profile at a place: the band in which something stands, and what speaks for it."""
    local = points_beside(asked, _ABOUT_M)
    if len(local) < _FEWEST:
        return ()
    right = asked.scanlines.rights[len(asked.scanlines.rights) // 2]
    right = right / max(float(np.hypot(*right)), 1e-9)
    forward = np.array([-right[1], right[0]])
    # Within 1.5 m before and behind: others would show a curve's neighbours.
    kept = local[np.abs(local[:, :2] @ forward) <= _ALONG_M]
    if len(kept) < _FEWEST:
        return ()
    ground = float(np.quantile(kept[:, 2], _GROUND_SHARE))
    at = np.arange(-_ALONG_M, _ALONG_M + STEP_M / 2, STEP_M)
    profile = profile_about(kept, at[:, None] * forward, ground)
    windows = windows_of(profile, VehicleWay(np.empty((0, 2))))
    if not windows:
        return ()
    facts, chance = likeliest(windows[0].options)
    middle = profile.nodes[len(profile.nodes) // 2]
    foot = float(profile.foot[len(profile.foot) // 2])
    tests = _tests(facts, chance, least_confidence)
    ring = np.array(
        [
            [*(middle + side * _BAND_M * right), foot + up]
            for side, up in ((-1, 0.0), (1, 0.0), (1, facts.top), (-1, facts.top))
        ]
    )
    top = np.array([*middle, foot + facts.top])
    return (
        Diagnostic(
            top + asked.xyz,
            tests,
            tests[-1].is_met,
            outline=ring + asked.xyz,
            points=_band_points(kept, profile.nodes, (foot, facts.top)) + asked.xyz,
        ),
    )


def _tests(facts: WindowFacts, chance: float, least: float) -> tuple[DiagnosticTest, ...]:
    rough_m = facts.rough * 0.05
    return (
        DiagnosticTest(_HIGH, facts.top, _LEAST_HIGH_M, "m", facts.top >= _LEAST_HIGH_M),
        DiagnosticTest(_FULL, facts.full, _LEAST_FULL, "", facts.full >= _LEAST_FULL),
        DiagnosticTest(_EVEN, facts.even, _LEAST_EVEN, "", facts.even >= _LEAST_EVEN),
        DiagnosticTest(_ROUGH, rough_m, _MOST_ROUGH_M, "m", rough_m <= _MOST_ROUGH_M),
        DiagnosticTest(_CHANCE, chance, least, "", math.isfinite(chance) and chance >= least),
    )


def _band_points(local: Floats, nodes: Floats, heights: tuple[float, float]) -> Floats:
    """Points of the band: near its line, between its foot and its top."""
    way = nodes[-1] - nodes[0]
    way = way / max(float(np.hypot(*way)), 1e-9)
    away = local[:, :2] - nodes[0]
    aside = np.abs(away[:, 0] * way[1] - away[:, 1] * way[0])
    foot, top = heights
    high = local[:, 2] - foot
    chosen = (aside <= _ASIDE_M / 2) & (high > 2 * _BAND_M) & (high <= top + _BAND_M)
    return np.asarray(local[chosen])
