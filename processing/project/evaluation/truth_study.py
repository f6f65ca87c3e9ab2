"""A parameter study judged by a truth of the project: on a whole drive, or where it is quick."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import report_as_user_error
from processing.core.monitor import Monitor, PartMonitor
from processing.core.owned_files import make_marked, remove_folder
from processing.project.evaluation.parameter_study import (
    ParameterStudy,
    StudyRequest,
    TruthOf,
    study,
)
from processing.project.evaluation.truth_store import TRUTH, has_truth, read_truth
from processing.recording.columns.ordering import read_chunk
from processing.recording.drive import Drive
from processing.recording.drive_part import write_part
from processing.tools.running.runner import RunRequest, drives_of

MARGIN_M = 5.0
"""So far around the points with a known truth a tool sees the others."""

_AT_ONCE = 1 << 20
_CUTTING = 0.05


def study_by_truth(
    request: StudyRequest, truth: str, into: Path, monitor: Monitor, *, is_part: bool
) -> ParameterStudy:
    """Study a tool on drives that have a truth.

    Parameters
    ----------
    request : StudyRequest
    truth : str
        Its id.
    into : Path
        A new folder on a disk with room for a run; it is removed in the end.
    is_part : bool
        Look only at the box around the points whose truth is known, and `MARGIN_M` more. Quick,
        but what a method takes from the whole cloud it takes from the part then.

    Raises
    ------
    UserError
        As :func:`processing.project.evaluation.parameter_study.study`.
    Cancelled
    """
    with report_as_user_error(into):
        make_marked(into)
    try:
        if not is_part:
            return study(request, _truth_of(truth), monitor, into)
        return _study_of_parts(request, truth, into, monitor)
    finally:
        remove_folder(into)


def _truth_of(id_: str) -> TruthOf:
    def read(drive: Drive, start: int, stop: int) -> NDArray[np.uint8]:
        return read_truth(drive, id_, start, stop)

    return read


def _truth_of_part(drive: Drive, start: int, stop: int) -> NDArray[np.uint8]:
    return np.asarray(read_chunk(drive.folder, TRUTH, start, stop))


def _study_of_parts(
    request: StudyRequest, truth: str, into: Path, monitor: Monitor
) -> ParameterStudy:
    cutting = PartMonitor(monitor, 0.0, _CUTTING)
    low, high = _box_of_known(request.drives, truth, cutting)

    def cut(drive: Drive) -> Drive:
        return _part(drive, truth, (low, high), into / f"part-{drive.id}", cutting)

    parts = tuple(map(cut, request.drives))
    together = {one for drive in request.drives for one in drives_of(_run_on(request, drive))}
    beside = tuple(cut(drive) for drive in request.beside if drive in together)
    rest = PartMonitor(monitor, _CUTTING, 1.0)
    return study(replace(request, drives=parts, beside=beside), _truth_of_part, rest, into)


def _run_on(request: StudyRequest, drive: Drive) -> RunRequest:
    return RunRequest(request.tool, drive, None, request.beside)


def _part(
    drive: Drive,
    truth: str,
    box: tuple[NDArray[np.float64], NDArray[np.float64]],
    into: Path,
    monitor: Monitor,
) -> Drive:
    """The points of a drive in a box, and the truth beside them."""
    low, high = box
    is_known = has_truth(drive, truth)

    def is_near(start: int, stop: int) -> NDArray[np.bool_]:
        xyz = drive.xyz(slice(start, stop))
        inside: NDArray[np.bool_] = np.all((xyz >= low) & (xyz <= high), axis=1)
        return inside

    def beside(start: int, stop: int) -> Mapping[str, NDArray[np.uint8]]:
        nothing = np.zeros(stop - start, np.uint8)
        return {TRUTH: read_truth(drive, truth, start, stop) if is_known else nothing}

    return write_part(drive, is_near, into, monitor, beside=beside)


def _box_of_known(
    drives: Sequence[Drive], truth: str, monitor: Monitor
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Corners of the box about all known points, with its margin; empty where none is known."""
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for drive in drives:
        for start in range(0, drive.count, _AT_ONCE):
            monitor.check()
            stop = min(start + _AT_ONCE, drive.count)
            known = np.flatnonzero(read_truth(drive, truth, start, stop)) + start
            if known.size:
                xyz = drive.xyz(known)
                low, high = np.fmin(low, xyz.min(axis=0)), np.fmax(high, xyz.max(axis=0))
    # A part of space in plan: what stands above and below a point belongs to its surroundings.
    low[2], high[2] = -np.inf, np.inf
    return low - MARGIN_M, high + MARGIN_M
