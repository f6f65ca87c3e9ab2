"""Removing drives from a project: the step that does it, and what goes with them."""

from __future__ import annotations

from collections.abc import Sequence

from processing.map.change import Change
from processing.map.feature import Feature, Status
from processing.project.project import Project
from processing.recording.drive import Drive


def removal_of(project: Project, drives: Sequence[Drive]) -> Change:
    """The step that takes drives out of a project; undone, it brings all back.

    What was drawn or accepted stays, with its places. Candidates that nobody judged go where they
    rest on points of these drives alone; those that rest on no points, where their run used no
    other drive.
    """
    ids = {drive.id for drive in drives}
    used_by = {run.id: set(run.drives) for run in project.runs.all()}

    def goes(feature: Feature) -> bool:
        if feature.status is not Status.CANDIDATE:
            return False
        rests = {one.measured.drive for one in feature.vertices if one.measured is not None}
        on = rests or used_by.get(feature.provenance.run, set())
        return bool(on) and on <= ids

    return Change(
        removed=tuple(feature for feature in project.features.all() if goes(feature)),
        removed_drives=tuple(project.listed_drive(drive) for drive in drives),
    )
