"""Candidates on a recorded street, to review in benchmarks and tests."""

from __future__ import annotations

import numpy as np

from processing.image.images_of_drives import image_of
from processing.recording.drive import Drive
from processing.tools.tool import Candidate, CandidateResult

_ASIDE = (0.30, 0.42, 0.5, 0.58, 0.70)
"""Where in a row of the image, from its left end: sidewalk, curb and road on both sides."""

_HALF_ROWS = 12
_REACH_PX = 60


def street_candidates(drive: Drive, count: int, seed: int = 4) -> CandidateResult:
    """So many candidates along a drive on measured points, of confidences in no order.

    Every third one is a point, the others are lines of three vertices.
    """
    random = np.random.default_rng(seed)
    rows = image_of(drive, drive.image_kinds[0]).rows
    middles = np.linspace(0.08 * rows, 0.92 * rows, count).astype(int).tolist()
    confidences = random.uniform(0.2, 0.99, count).tolist()
    made = (
        _candidate(drive, row, number, confidence)
        for number, (row, confidence) in enumerate(zip(middles, confidences, strict=True))
    )
    return CandidateResult(tuple(one for one in made if one is not None))


def _candidate(drive: Drive, row: int, number: int, confidence: float) -> Candidate | None:
    """None where the row has no points at that side."""
    image = image_of(drive, drive.image_kinds[0])
    column = int(_ASIDE[number % len(_ASIDE)] * image.width)
    is_point = number % 3 == 0
    rows = (row,) if is_point else (row - _HALF_ROWS, row, row + _HALF_ROWS)
    points = np.array([image.nearest_filled(one, column, _REACH_PX) for one in rows])
    if (points < 0).any():
        return None
    xyz = drive.xyz(points)
    if is_point:
        return Candidate("street_tree", "point", xyz, points, confidence, {})
    return Candidate("curb_upper", "line", xyz, points, confidence, {})
