"""Wiring of the evaluation of classes: truths, runs judged by them, and parameter studies."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from PySide6.QtCore import QCoreApplication, QObject
from PySide6.QtGui import QIcon
from PySide6.QtWidgets import QFileDialog, QMessageBox

from app.classes.evaluation_files import write_classes_file, write_study_file
from app.classes.truth_evaluations import TruthEvaluations
from app.classes.truth_work import StudyOptions
from app.window.window_parts import WindowParts
from processing.core.errors import UserError
from processing.core.parameters import ParameterValue
from processing.core.text import Text
from processing.formats.format import Content
from processing.formats.registry import FORMATS
from processing.project.evaluation.class_evaluation import ClassEvaluation
from processing.project.evaluation.parameter_study import can_vary
from processing.project.evaluation.study_store import KeptStudy
from processing.project.evaluation.truth_making import CheckedPoints
from processing.project.evaluation.truth_store import Truth
from processing.project.results.found_features import parameter_values
from processing.tools.running.runner import tool_of

_WROTE = Text("Wrote {path}.", "{path} を書き出しました。")


def connect_classes(parts: WindowParts) -> None:
    """Connect the pages of the evaluation with the document; again for new ones."""
    wiring = _ClassWiring(parts)
    panel, studies, evaluations = parts.class_panel, parts.study_panel, parts.of(TruthEvaluations)
    evaluations.truths_changed.connect(wiring.show_truths)
    evaluations.studies_changed.connect(wiring.show_studies)
    evaluations.judged.connect(panel.show_evaluations)
    evaluations.truth_made.connect(wiring.on_evaluations_truth_made)
    evaluations.study_made.connect(wiring.on_evaluations_study_made)
    parts.document.reported.connect(panel.refresh)
    panel.error_map_requested.connect(evaluations.judge)
    panel.points_requested.connect(wiring.on_panel_points_requested)
    panel.export_requested.connect(wiring.on_panel_export_requested)
    panel.truths.making_requested.connect(wiring.on_truths_making_requested)
    panel.truths.loading_requested.connect(wiring.on_truths_loading_requested)
    panel.truths.removal_requested.connect(wiring.on_truths_removal_requested)
    panel.truths.truth_chosen.connect(wiring.on_truths_truth_chosen)
    studies.study_requested.connect(wiring.on_studies_study_requested)
    studies.values_wanted.connect(wiring.on_studies_values_wanted)
    studies.export_requested.connect(wiring.on_studies_export_requested)
    studies.removal_requested.connect(evaluations.remove_study)
    studies.ask_values_from(wiring.values_of)
    parts.processing_panel.values_changed.connect(studies.refresh)
    wiring.show_truths()
    wiring.show_studies()


class _ClassWiring(QObject):
    """What has to be translated between the pages and the document."""

    def __init__(self, parts: WindowParts) -> None:
        super().__init__(parts.window.centralWidget())  # goes with the widgets
        self._parts = parts
        self._evaluations = parts.of(TruthEvaluations)

    def show_truths(self) -> None:
        self._parts.class_panel.truths.show_truths(self._evaluations.truths())
        self.on_truths_truth_chosen()

    def show_studies(self) -> None:
        self._parts.study_panel.show_studies(self._evaluations.studies())

    def values_of(self, tool: str) -> Mapping[str, ParameterValue]:
        """A tool's parameters as its form has them."""
        parameters = self._parts.processing_panel.parameters_of(tool)
        values = parameter_values(tool_of(tool), parameters)
        return {one.id: value for one in can_vary(tool) if (value := values[one.id]) is not None}

    def on_evaluations_truth_made(self, truth: Truth) -> None:
        self._parts.class_panel.truths.choose(truth.id)

    def on_evaluations_study_made(self, kept: KeptStudy) -> None:
        self._parts.study_panel.show_studies(self._evaluations.studies(), chosen=kept.id)

    def on_truths_truth_chosen(self) -> None:
        why_not = ""
        if not self._parts.class_panel.truths.truth:
            why_not = QCoreApplication.translate(
                "ClassWiring", "Make a truth on the page of point classes first."
            )
        self._parts.study_panel.form.refuse(why_not)

    def on_truths_making_requested(self, checked: CheckedPoints) -> None:
        self._evaluations.make_truth(checked, self._parts.scene_view.clipping.clip)

    def on_truths_loading_requested(self) -> None:
        project = self._parts.document.project
        if project is None:
            return
        path, _ = QFileDialog.getOpenFileName(
            self._parts.window,
            QCoreApplication.translate("ClassWiring", "Take the truth from a file"),
            str(project.folder.parent),
            FORMATS.filter_read(Content.CLASSES).in_language(self._parts.language),
        )
        if path:
            self._evaluations.load_truth(Path(path))

    def on_truths_removal_requested(self, truth: str) -> None:
        """Forgotten for good, so it is asked for."""
        box = QMessageBox(self._parts.window)
        box.setWindowTitle(QCoreApplication.translate("ClassWiring", "Forget a truth"))
        box.setText(
            QCoreApplication.translate(
                "ClassWiring", "The truth is removed from the project for good. Forget it?"
            )
        )
        forget = box.addButton(
            QCoreApplication.translate("ClassWiring", "Forget it"),
            QMessageBox.ButtonRole.DestructiveRole,
        )
        cancel = box.addButton(QMessageBox.StandardButton.Cancel)
        cancel.setIcon(QIcon())  # no other button has one

        def decide() -> None:
            if box.clickedButton() is forget:
                self._evaluations.remove_truth(truth)
            box.deleteLater()

        box.finished.connect(decide)
        box.open()

    def on_panel_points_requested(self, truth: str, evaluation: ClassEvaluation) -> None:
        self._evaluations.show_points(truth, evaluation)

    def on_panel_export_requested(self) -> None:
        panel = self._parts.class_panel
        truth = panel.truth
        path = self._asked_path("classes.csv")
        if path is not None and truth is not None:
            name = truth.name.in_language(self._parts.language)
            self._write(
                path, lambda: write_classes_file(path, panel.evaluations, name, never=self._never())
            )

    def on_studies_study_requested(self) -> None:
        form = self._parts.study_panel.form
        self._evaluations.study(
            StudyOptions(
                tool=form.tool,
                truth=self._parts.class_panel.truths.truth,
                fixed=tuple(self.values_of(form.tool).items()),
                varied=form.varied,
                is_part=form.is_part,
            )
        )

    def on_studies_values_wanted(self, tool: str, values: Mapping[str, ParameterValue]) -> None:
        self._parts.processing_panel.use_values(tool, values)
        self._parts.window.show_panel("processing")

    def on_studies_export_requested(self, ending: str) -> None:
        panel = self._parts.study_panel
        kept = panel.kept
        path = self._asked_path(f"study.{ending}")
        if path is not None and kept is not None:
            self._write(
                path, lambda: write_study_file(path, kept.study, panel.plot, never=self._never())
            )

    def _never(self) -> tuple[Path, ...]:
        drives = self._parts.document.drives()
        return tuple(file for drive in drives for file in drive.delivered_files)

    def _asked_path(self, name: str) -> Path | None:
        project = self._parts.document.project
        if project is None:
            return None
        title = QCoreApplication.translate("ViewWiring", "Write the evaluation")
        start = str(project.folder.parent / name)
        files = next(one for one in FORMATS if Path(name).suffix in one.endings).file_filter
        shown = files.in_language(self._parts.language)
        chosen, _ = QFileDialog.getSaveFileName(self._parts.window, title, start, shown)
        return Path(chosen) if chosen else None

    def _write(self, path: Path, write: Callable[[], None]) -> None:
        try:
            write()
        except UserError as error:
            self._parts.document.refused.emit(error)
            return
        self._parts.document.reported.emit(_WROTE.filled(path=path.name))
