"""Runs with candidates whose confidences, places and kinds are known."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

import numpy as np

from processing.core.text import Text
from processing.project.results.found_features import FoundFeatures, found_features
from processing.tools.normals import NormalsParameters
from processing.tools.tool import Candidate, CandidateResult, Finder, Needs, Tool

STARTED = datetime(2026, 4, 1, 9, 30, tzinfo=UTC)


def find_nothing(_drive: object, _parameters: object, _monitor: object) -> CandidateResult:
    """A tool that looks and sees nothing."""
    return CandidateResult()


FINDER = Tool(
    id="finder",
    name=Text("Curbs", "縁石"),
    explanation=Text("Finds curbs.", "縁石を検出します。"),
    group=Text("Road", "道路"),
    needs=Needs.POINTS,
    parameters=NormalsParameters,
    version=3,
    method=Finder(find_nothing),
)


def line(number: int, confidence: float, *, start: int = 0) -> Candidate:
    """A straight line of 2 m, the number-th metre along the street, on points from ``start`` on."""
    xyz = np.array([[number, 0.0, 10.0], [number + 1.0, 0.0, 10.0], [number + 2.0, 0.0, 10.0]])
    points = start + np.array([3 * number, 3 * number + 1, 3 * number + 2])
    return Candidate("curb_lower", "line", xyz, points, confidence, {"height_m": 0.15})


def confidences(count: int, seed: int = 1) -> list[float]:
    """Different confidences between 0 and 1, in no order."""
    values = (np.arange(count) + 0.5) / count
    return np.random.default_rng(seed).permutation(values).tolist()


def found_lines(count: int, *, seed: int = 1, drive: str = "left") -> FoundFeatures:
    """A run with so many lines along the street."""
    made = tuple(line(number, one) for number, one in enumerate(confidences(count, seed)))
    return found(CandidateResult(made), drive=drive)


def found(result: CandidateResult, *, drive: str = "left") -> FoundFeatures:
    """What a run of the tool above becomes."""
    return found_features(
        result,
        FINDER,
        NormalsParameters(),
        (drive,),
        started=STARTED,
        finished=STARTED + timedelta(seconds=4),
    )
