"""Why a shape in the road is a cover or none, with its outline, for the diagnostic layer."""

from __future__ import annotations

import threading

import numpy as np

from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.methods.road.covers.shape_kernels import PATCHY
from processing.methods.road.covers.street_covers import FoundCovers, StreetCover, street_covers
from processing.methods.road.diagnostics import Diagnostic, DiagnosticTest
from processing.methods.road.objects.survey import SurveyGround, survey_ground
from processing.methods.road.requested_position import RequestedPosition
from processing.recording.drive import Drive

_NEAR_M = 8.0
"""Covers so near to the place are shown: across a carriageway from its middle."""

_LEAST_SHOWN = 0.05
"""What is less likely is one of hundreds of patches of dirt."""

_TONED = Text("Difference of brightness over its spread", "明るさの差（ばらつき比）")
_RAISED = Text("Rim over the road", "縁の路面からの高さ")
_OPEN = Text("Share of points below it", "下方の点の割合")
_EVEN = Text("Unevenness of brightness around it", "周囲の明るさのむら")
_CHANCE = Text("Likelihood of a cover", "蓋である見込み")

_LEAST_TONED, _MOST_UNEVEN, _LEAST_OPEN = 1.0, 0.5, 0.08


def cover_diagnostics(asked: RequestedPosition, least: float) -> tuple[Diagnostic, ...]:
    """Shapes about a place that are covers or might be: each with its outline."""
    found = asked.drive.kept("covers", _KeptCovers).of(asked.drive)
    return tuple(
        _diagnostic(one, least)
        for one in found.covers
        if np.hypot(*(one.middle - asked.xyz)[:2]) <= _NEAR_M
    )


class _KeptCovers:
    """Covers of a drive, and the ground that they were looked for on."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._below: SurveyGround | None = None
        self._found = FoundCovers(0, (), ())

    def of(self, drive: Drive) -> FoundCovers:
        with self._lock:
            below = survey_ground((drive,), SilentMonitor())  # another when noise is known anew
            if below is not self._below:
                self._found = street_covers((drive,), _LEAST_SHOWN, SilentMonitor())
                self._below = below
            return self._found


def _diagnostic(cover: StreetCover, least: float) -> Diagnostic:
    facts = cover.facts
    tests = (
        _at_least(_TONED, 2 * facts.toned, _LEAST_TONED, ""),
        _at_least(_RAISED, cover.raised_m, PATCHY[1], "m"),
        _at_least(_OPEN, facts.open, _LEAST_OPEN, ""),
        DiagnosticTest(_EVEN, facts.uneven, _MOST_UNEVEN, "", facts.uneven <= _MOST_UNEVEN),
        _at_least(_CHANCE, cover.confidence, least, ""),
    )
    return Diagnostic(cover.middle, tests, tests[-1].is_met, cover.corners)


def _at_least(name: Text, value: float, limit: float, unit: str) -> DiagnosticTest:
    return DiagnosticTest(name, value, limit, unit, value >= limit)
