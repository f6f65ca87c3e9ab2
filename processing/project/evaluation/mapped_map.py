"""A project's own map as scores take it: what a person agreed to, and what a run had found."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from processing.core.errors import MissingInput
from processing.core.text import Text
from processing.map.feature import Feature, Status
from processing.project.project import Project
from processing.scoring.features.mapped_features import MappedFeature, MappedFile


def agreed_map(project: Project, path: Path) -> MappedFile:
    """What was drawn by hand, and the candidates that were accepted, as they are now."""
    agreed = (one for one in project.features.all() if one.status is Status.ACCEPTED)
    return mapped_of(agreed, path, project.crs)


def found_map(project: Project, path: Path, tool: str) -> MappedFile:
    """What the last run of a tool found, whatever became of it.

    Raises
    ------
    MissingInput
        The tool was never run on the project.
    BadFile
        The history is damaged.
    """
    runs = [run for run in project.runs.all() if run.tool == tool]
    if not runs:
        raise MissingInput(
            Text("The tool was not run in this project.", "このツールは実行されていません。"),
            Text.same(f"{path}, {tool}"),
            Text("Run it first, or name a file.", "先に実行するか、ファイルを指定してください。"),
        )
    return mapped_of(project.history.additions_of(runs[-1].id), path, project.crs)


def mapped_of(features: Iterable[Feature], path: Path, crs: str) -> MappedFile:
    """Features of a map as scores take them; the path is for messages."""
    return MappedFile(
        path,
        crs,
        tuple(
            MappedFeature(
                number,
                one.geometry.value,
                np.array([vertex.xyz for vertex in one.vertices], np.float64),
                {
                    **one.attributes,
                    "kind": one.kind,
                    "confidence": one.provenance.confidence,
                    "status": one.status.value,
                },
            )
            for number, one in enumerate(features, 1)
        ),
    )
