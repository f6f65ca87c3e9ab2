"""How good runs that give classes were, by a truth: counts for each run, and a picture."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor, PartMonitor
from processing.core.scratch_folder import whole_folder
from processing.project.evaluation.truth_making import classes_as_they_stand
from processing.project.evaluation.truth_store import has_truth, read_truth
from processing.project.results.run_findings import has_finding, read_finding
from processing.project.store.runs import Run
from processing.recording.columns.columns import ColumnWriter
from processing.recording.columns.error_map import ERROR_MAP, map_errors
from processing.recording.drive import Drive
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix, is_one_of
from processing.tools.listed.registry import asked_classes
from processing.tools.tool import FinishedColumns

_AT_ONCE = 1 << 20


@dataclass(frozen=True)
class ClassEvaluation:
    """One run, or the cloud as it stands, against a truth.

    Attributes
    ----------
    tool : str
        What was asked, a key of :func:`processing.tools.listed.registry.asked_classes`.
    run : Run or None
        None: the classes as they stand now, corrections by hand and all.
    drives : tuple of str
        On which it was counted.
    counts : BinaryConfusionMatrix
        Of the points whose truth is known; positive are those that the tool looks for.
    """

    tool: str
    run: Run | None
    drives: tuple[str, ...]
    counts: BinaryConfusionMatrix


def evaluate_classes(
    runs: Sequence[Run],
    drives: Sequence[Drive],
    truth: str,
    monitor: Monitor,
    *,
    counted: Iterable[ClassEvaluation] = (),
) -> tuple[ClassEvaluation, ...]:
    """Count every run that is kept, and for each tool the classes as they stand now.

    Parameters
    ----------
    runs : sequence of Run
    drives : sequence of Drive
        Those of the project.
    truth : str
        Its id.
    counted : iterable of ClassEvaluation
        By the same truth, before: what a run said doesn't change, so it isn't counted again.

    Returns
    -------
    tuple of ClassEvaluation
        Tool by tool; the runs in their order, then the cloud as it stands.

    Raises
    ------
    MissingInput, Cancelled
    """
    known = [drive for drive in drives if has_truth(drive, truth)]
    wanted: list[tuple[str, Run | None, list[Drive]]] = []
    for tool in asked_classes():
        evaluated_runs = []
        for run in runs:
            on = [
                one for one in known if one.id in run.drives and has_finding(one, run.tool, run.id)
            ]
            if run.tool == tool and on:
                evaluated_runs.append((tool, run, on))
        if evaluated_runs:
            wanted += evaluated_runs
            wanted.append((tool, None, [one for one in known if _is_on(one, evaluated_runs)]))
    known_counts = {(one.run.id, one.drives): one.counts for one in counted if one.run is not None}
    found = []
    for number, (tool, which, on) in enumerate(wanted):
        ids = tuple(one.id for one in on)
        if which is not None and (which.id, ids) in known_counts:
            found.append(ClassEvaluation(tool, which, ids, known_counts[which.id, ids]))
            continue
        part = PartMonitor(monitor, number / len(wanted), (number + 1) / len(wanted))
        counts = BinaryConfusionMatrix(0, 0, 0, 0)
        for drive in on:
            counts += _count_run(drive, truth, tool, which, part)
        found.append(ClassEvaluation(tool, which, ids, counts))
    return tuple(found)


def error_map_columns(
    drive: Drive, truth: str, evaluation: ClassEvaluation, into: Path, monitor: Monitor
) -> FinishedColumns:
    """A picture of one evaluation: the column ``judged`` of a drive.

    Parameters
    ----------
    into : Path
        A new folder on the drive's disk.

    Raises
    ------
    MissingInput, NoSpace, Cancelled
    """
    with whole_folder(into), ColumnWriter(into) as writer:
        writer.append({ERROR_MAP: np.empty(0, np.uint8)})
        for start in range(0, drive.count, _AT_ONCE):
            monitor.check()
            monitor.report(start / drive.count)
            stop = min(start + _AT_ONCE, drive.count)
            writer.append({ERROR_MAP: evaluations_of(drive, truth, evaluation, start, stop)})
    judged = FinishedColumns(into, (ERROR_MAP,), drive.count)
    judged.keep_sums()
    return judged


def evaluations_of(
    drive: Drive, truth: str, evaluation: ClassEvaluation, start: int, stop: int
) -> NDArray[np.uint8]:
    """What is thought of the points ``start … stop − 1``: (k,) uint8 of `Judgement`.

    Raises
    ------
    MissingInput
        What the run said isn't kept, or the truth is gone.
    """
    tool, run, asked = evaluation.tool, evaluation.run, asked_classes()[evaluation.tool]
    codes = read_truth(drive, truth, start, stop)
    is_true, is_found = (
        is_one_of(codes, asked.codes),
        _read_found_points(drive, tool, run, start, stop),
    )
    if not asked.removes:
        is_true, is_found = ~is_true, ~is_found
    return map_errors(codes > 0, is_true, is_found)


def _is_on(drive: Drive, wanted: Sequence[tuple[str, Run | None, list[Drive]]]) -> bool:
    return any(drive in on for _, _, on in wanted)


def _count_run(
    drive: Drive, truth: str, tool: str, run: Run | None, monitor: Monitor
) -> BinaryConfusionMatrix:
    counts = BinaryConfusionMatrix(0, 0, 0, 0)
    for start in range(0, drive.count, _AT_ONCE):
        monitor.check()
        monitor.report(start / drive.count)
        stop = min(start + _AT_ONCE, drive.count)
        codes = read_truth(drive, truth, start, stop)
        is_known = codes > 0
        if is_known.any():
            is_found = _read_found_points(drive, tool, run, start, stop)[is_known]
            counts += BinaryConfusionMatrix.of(
                is_one_of(codes[is_known], asked_classes()[tool].codes), is_found
            )
    return counts


def _read_found_points(
    drive: Drive, tool: str, run: Run | None, start: int, stop: int
) -> NDArray[np.bool_]:
    if run is not None:
        return read_finding(drive, run.tool, run.id, start, stop)
    return is_one_of(classes_as_they_stand(drive, start, stop), asked_classes()[tool].codes)
