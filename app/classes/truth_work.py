"""What judging by a truth has done in the background: functions for a job's thread."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from processing.core.monitor import Monitor, PartMonitor
from processing.core.parameters import ParameterValue
from processing.core.text import Text
from processing.image.search.clip import Clip
from processing.project.evaluation.class_evaluation import ClassEvaluation, error_map_columns
from processing.project.evaluation.parameter_study import (
    ParameterStudy,
    StudyRequest,
    VariedParameter,
)
from processing.project.evaluation.truth_making import MadeTruth, truth_as_it_stands
from processing.project.evaluation.truth_of_file import coded_truth, truth_of_file
from processing.project.evaluation.truth_study import study_by_truth
from processing.recording.drive import Drive
from processing.tools.running.runner import tool_of
from processing.tools.tool import FinishedColumns


@dataclass(frozen=True)
class StudyOptions:
    """A parameter study as somebody asks for it.

    Attributes
    ----------
    tool : str
    truth : str
        Id of the truth that judges.
    fixed : tuple of (str, value)
        The other parameters.
    varied : tuple of VariedParameter
    is_part : bool
        Only around the points whose truth is known.
    """

    tool: str
    truth: str
    fixed: tuple[tuple[str, ParameterValue], ...]
    varied: tuple[VariedParameter, ...]
    is_part: bool


def truth_by_hand_work(
    drives: Sequence[Drive], into: Path, *, clip: Clip | None, only_painted: bool
) -> Callable[[Monitor], MadeTruth]:
    """The classes of drives as they stand become a truth."""

    def work(monitor: Monitor) -> MadeTruth:
        return truth_as_it_stands(drives, into, monitor, clip=clip, only_painted=only_painted)

    return work


def truth_file_work(
    drives: Sequence[Drive], path: Path, into: Path
) -> Callable[[Monitor], MadeTruth]:
    """The classes in a file become a truth of the points that they belong to."""

    def work(monitor: Monitor) -> MadeTruth:
        return truth_of_file(drives, coded_truth(path), into, monitor)

    return work


def error_map_work(
    drives: Sequence[Drive], truth: str, evaluation: ClassEvaluation, into: Path
) -> Callable[[Monitor], tuple[tuple[Drive, FinishedColumns], ...]]:
    """A column of what was right and wrong for each drive."""

    def work(monitor: Monitor) -> tuple[tuple[Drive, FinishedColumns], ...]:
        found = []
        for number, drive in enumerate(drives):
            part = PartMonitor(monitor, number / len(drives), (number + 1) / len(drives))
            columns = error_map_columns(
                drive, truth, evaluation, into.with_name(f"{into.name}-{number}"), part
            )
            found.append((drive, columns))
        return tuple(found)

    return work


def study_work(
    request: StudyOptions, drives: tuple[Drive, ...], beside: tuple[Drive, ...], into: Path
) -> tuple[Text, Callable[[Monitor], ParameterStudy]]:
    """A tool is tried with many settings."""
    study = StudyRequest(request.tool, drives, dict(request.fixed), request.varied, beside)
    title = Text("Parameter study: {tool}", "パラメータ検討: {tool}").filled(
        tool=tool_of(request.tool).name
    )

    def work(monitor: Monitor) -> ParameterStudy:
        return study_by_truth(study, request.truth, into, monitor, is_part=request.is_part)

    return title, work
