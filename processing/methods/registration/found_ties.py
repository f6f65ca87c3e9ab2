"""Ties of a whole survey, part by part."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from processing.core.monitor import Monitor
from processing.methods.registration.drift_correction import DriftCorrection
from processing.methods.registration.patches import Patches, patches_of
from processing.methods.registration.ties import NO_TIES, Ties, plane_ties
from processing.methods.registration.visits import Survey, visits_of

CHECKED = 5
"""One place in so many is kept out of the adjustment, to tell what it is worth."""


def find_ties(
    survey: Survey, corrections: Sequence[DriftCorrection] | None, monitor: Monitor
) -> Ties:
    """What visits have in common all over a survey.

    Parameters
    ----------
    corrections : sequence of DriftCorrection or None
        Points are moved by them before they are compared.

    Raises
    ------
    Cancelled
    """
    found = [NO_TIES]
    areas = survey.parts()
    for number, area in enumerate(areas):
        monitor.report(number / len(areas))
        monitor.check()
        visits = visits_of(survey, area, corrections, check=monitor.check)
        if len(visits) > 1:
            seen = [
                (visit.drive, _towards(survey, visit.drive, patches_of(visit, monitor).patches))
                for visit in visits
            ]
            found.append(plane_ties(seen))
    return Ties.joined(found)


def _towards(survey: Survey, drive: int, patches: Patches) -> Patches:
    """The same with normals towards the vehicle: thin walls and signs have two faces."""
    track = survey.tracks[survey.track_of(drive)]
    at, _ = track.places(patches.time)
    is_away = ((at - survey.origin - patches.xyz) * patches.normal).sum(axis=1) < 0
    return replace(patches, normal=np.where(is_away[:, None], -patches.normal, patches.normal))
