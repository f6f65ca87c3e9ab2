"""ErrorMapColumns: points coloured by what was right and wrong, kept up to date while painting."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject

from app.classes.truth_work import error_map_work
from app.document.document import Document
from app.document.job_results import JobResultApplier
from app.jobs.jobs import JobLane
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.labels.label_column import write_codes
from processing.project.evaluation.class_evaluation import ClassEvaluation, evaluations_of
from processing.project.evaluation.truth_store import has_truth
from processing.project.project import Project
from processing.recording.columns.columns import column_path
from processing.recording.columns.error_map import ERROR_MAP
from processing.recording.drive import Drive
from processing.scoring.points.confusion_matrix import BinaryConfusionMatrix
from processing.tools.listed.registry import asked_classes
from processing.tools.tool import FinishedColumns

_JUDGING = Text("Evaluation", "評価")
_SHOWN = "judged_by"
"""Setting: the truth and the tool whose classes as they stand are shown; empty for a run."""

_AT_ONCE = 1 << 20


@dataclass(frozen=True)
class _Shown:
    truth: str
    evaluation: ClassEvaluation


class ErrorMapColumns(QObject):
    """Makes the column ``judged``, and follows the labels where it shows the classes as they stand.

    Parameters
    ----------
    document : Document
    adoption : JobResultApplier
        Of whoever owns this; gives up when the project is closed.
    """

    def __init__(self, document: Document, adoption: JobResultApplier, parent: QObject) -> None:
        super().__init__(parent)
        self._document = document
        self._job_results = adoption
        self._shown: _Shown | None = None
        self._waiting: dict[str, list[NDArray[np.int64]]] = {}
        self._is_at_it = False
        document.opened.connect(self._on_document_opened)
        document.closed.connect(self._forget)
        document.shared.map_changes.labels_changed.connect(self._on_map_labels_changed)

    def show(self, project: Project, truth: str, evaluation: ClassEvaluation) -> str:
        """Colour the points by an evaluation, in all views; gives the job's id."""
        drives = [self._document.drive(id_) for id_ in evaluation.drives]
        work = error_map_work(drives, truth, evaluation, project.temporary_folder())

        def take(found: tuple[tuple[Drive, FinishedColumns], ...]) -> None:
            self._take(found)
            self._shown = _Shown(truth, evaluation) if evaluation.run is None else None
            noted = {"truth": truth, "tool": evaluation.tool} if self._shown else {}
            project.settings.put(_SHOWN, {**noted})
            self._document.shared.view_settings.change_look(attribute=ERROR_MAP)
            self._go_on()

        self._waiting.clear()
        return self._job_results.start(project, _JUDGING, work, take)

    def _on_map_labels_changed(self, drive_id: str, points: NDArray[np.int64]) -> None:
        """No points: all of the drive."""
        self._waiting.setdefault(drive_id, []).append(points)
        self._go_on()

    def _go_on(self) -> None:
        """Judge again what was painted since; what comes meanwhile is done together afterwards."""
        project, shown = self._document.project, self._shown
        if shown is None:
            self._waiting.clear()
        if project is None or shown is None or self._is_at_it or not self._waiting:
            return
        waiting, self._waiting = self._waiting, {}
        drives = {
            id_: drive
            for id_ in waiting
            if id_ in shown.evaluation.drives
            and has_truth(drive := self._document.drive(id_), shown.truth)
        }
        some = {id_: _join_points(waiting[id_]) for id_ in drives if all(map(len, waiting[id_]))}
        whole = [drive for id_, drive in drives.items() if id_ not in some]
        into = project.temporary_folder()

        def work(monitor: Monitor) -> tuple[tuple[Drive, FinishedColumns], ...]:
            for id_, points in some.items():
                _judge_again(drives[id_], shown, points, monitor)
            return error_map_work(whole, shown.truth, shown.evaluation, into)(monitor)

        def take(found: tuple[tuple[Drive, FinishedColumns], ...]) -> None:
            self._is_at_it = False
            self._take(found)
            for id_, points in some.items():
                self._document.tiles.drop_relabelled(drives[id_], points)
                self._document.shared.map_changes.error_maps_changed.emit(id_, points)
            self._go_on()

        self._is_at_it = True
        self._job_results.start(
            project, _JUDGING, work, take, lane=JobLane.INTERACTIVE, otherwise=self._on_job_failed
        )

    def _take(self, found: tuple[tuple[Drive, FinishedColumns], ...]) -> None:
        for drive, columns in found:
            columns.hand_over(drive.columns)
            self._document.tiles.drop(drive.id)
            self._document.shared.map_changes.drive_columns_changed.emit(drive.id)

    def _on_job_failed(self) -> None:
        self._is_at_it = False

    def _on_document_opened(self) -> None:
        """Go on following what was shown when the project was closed."""
        project = self._document.project
        noted = None if project is None else project.settings.get(_SHOWN)
        if project is None or not isinstance(noted, Mapping):
            return
        truth, tool = str(noted.get("truth", "")), str(noted.get("tool", ""))
        on = [
            drive.id
            for drive in project.drives
            if has_truth(drive, truth) and drive.columns.has(ERROR_MAP)
        ]
        if tool in asked_classes() and on:
            counts = BinaryConfusionMatrix(0, 0, 0, 0)  # nobody asks for them here
            self._shown = _Shown(truth, ClassEvaluation(tool, None, tuple(on), counts))

    def _forget(self) -> None:
        self._shown, self._is_at_it = None, False
        self._waiting.clear()


def _join_points(points: list[NDArray[np.int64]]) -> NDArray[np.int64]:
    return np.unique(np.concatenate(points))


def _judge_again(drive: Drive, shown: _Shown, points: NDArray[np.int64], monitor: Monitor) -> None:
    """Write what is thought of some points now into the column, a stretch at a time."""
    if not drive.columns.has(ERROR_MAP):
        return
    path = column_path(drive.folder, ERROR_MAP)
    ends = np.searchsorted(points, np.arange(0, drive.count + _AT_ONCE, _AT_ONCE))
    for first, end in zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True):
        if end > first:
            monitor.check()
            some = points[first:end]
            start = int(some[0])
            codes = evaluations_of(drive, shown.truth, shown.evaluation, start, int(some[-1]) + 1)
            write_codes(path, some, codes[some - start])
