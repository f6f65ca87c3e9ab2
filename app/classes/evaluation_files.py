"""Evaluations and studies as files: the table as CSV, the plot as PNG or PDF."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Protocol

from PySide6.QtCore import QMarginsF, QRectF, QSizeF, Qt
from PySide6.QtGui import QFont, QGuiApplication, QImage, QPageSize, QPainter, QPdfWriter

from processing.core.errors import NoSpace, Unsuitable
from processing.core.safe_write import write_safely
from processing.core.text import Text
from processing.formats.format import Content
from processing.formats.registry import FORMATS
from processing.project.evaluation.class_evaluation import ClassEvaluation
from processing.project.evaluation.class_tables import write_class_evaluations, write_study
from processing.project.evaluation.evaluation_table import write_evaluation
from processing.project.evaluation.parameter_study import ParameterStudy
from processing.project.evaluation.run_evaluation import RunEvaluation
from widgets.panels.class_evaluation.study_plot import StudyPlot
from widgets.panels.reliability_plot import PlotColours, ReliabilityPlot

_SIDE_MM = 150.0
_PNG_PX = 1800
_FONT_MM = 3.5
_PDF_DPI = 600
_MM_PER_INCH = 25.4


def write_evaluation_file(
    path: Path, evaluations: Sequence[RunEvaluation], plot: ReliabilityPlot | None
) -> None:
    """Write the table or the curve, by the ending of the name.

    Parameters
    ----------
    path : Path
        Ends in ``.csv``, ``.png`` or ``.pdf``.
    plot : ReliabilityPlot or None
        The curve for the latter two.

    Raises
    ------
    Unsuitable
        There is no curve.
    NoSpace, InUse, MissingInput, BadFile
        What stands against writing; what was there before stays.
    """
    if path.suffix.lower() not in FORMATS.endings_written(Content.PLOT):
        write_evaluation(path, evaluations)
        return
    _write_plot(path, plot, "" if plot is None else plot.words.title)


def write_classes_file(
    path: Path, evaluations: Sequence[ClassEvaluation], truth: str, *, never: Iterable[Path] = ()
) -> None:
    """Write the table of runs that give classes.

    Parameters
    ----------
    truth : str
        Name of the truth.
    never : iterable of Path
        Files that must not be overwritten.

    Raises
    ------
    NoSpace, InUse, MissingInput, BadFile
        What stands against writing; what was there before stays.
    """
    write_class_evaluations(path, evaluations, truth, never=never)


def write_study_file(
    path: Path, study: ParameterStudy, plot: StudyPlot | None, *, never: Iterable[Path] = ()
) -> None:
    """Write a study's table or its plot, by the ending of the name.

    Raises
    ------
    Unsuitable
        There is no plot.
    NoSpace, InUse, MissingInput, BadFile
        What stands against writing; what was there before stays.
    """
    if path.suffix.lower() not in FORMATS.endings_written(Content.PLOT):
        write_study(path, study, never=never)
        return
    _write_plot(path, plot, "" if plot is None else plot.title)


class _Plot(Protocol):
    def paint(self, painter: QPainter, area: QRectF, colours: PlotColours) -> None:
        """Paint it into an area, in the painter's font."""


def _write_plot(path: Path, plot: _Plot | None, title: str) -> None:
    if plot is None:
        raise Unsuitable(
            Text("There is no curve yet.", "グラフはまだありません。"),
            Text.same(str(path)),
            Text("Judge some candidates first.", "先に候補を判定してください。"),
        )
    with write_safely(path) as temporary:
        is_pdf = FORMATS.format_to_write(path, Content.PLOT).id == "pdf"
        is_whole = _write_pdf(temporary, plot, title) if is_pdf else _write_png(temporary, plot)
        if not is_whole:
            raise NoSpace(
                Text("The picture can't be written.", "図を書き込めません。"),
                Text.same(str(path)),
                Text(
                    "Check that the disk has space and allows writing.",
                    "ディスクの空き容量と書き込みの可否を確認してください。",
                ),
            )


def _write_png(path: Path, plot: _Plot) -> bool:
    picture = QImage(_PNG_PX, _PNG_PX, QImage.Format.Format_RGB32)
    picture.fill(Qt.GlobalColor.white)
    per_mm = _PNG_PX / _SIDE_MM
    picture.setDotsPerMeterX(round(per_mm * 1000))
    picture.setDotsPerMeterY(round(per_mm * 1000))
    with QPainter(picture) as painter:
        _paint(painter, plot, per_mm)
    return picture.save(str(path))


def _write_pdf(path: Path, plot: _Plot, title: str) -> bool:
    page = QPdfWriter(str(path))
    page.setResolution(_PDF_DPI)
    page.setPageSize(QPageSize(QSizeF(_SIDE_MM, _SIDE_MM), QPageSize.Unit.Millimeter))
    page.setPageMargins(QMarginsF(0, 0, 0, 0))
    page.setTitle(title)
    painter = QPainter()
    if not painter.begin(page):
        return False
    _paint(painter, plot, _PDF_DPI / _MM_PER_INCH)
    return painter.end()


def _paint(painter: QPainter, plot: _Plot, per_mm: float) -> None:
    """In the screen's units, so that lines are as thick on paper as beside it."""
    font = QFont(QGuiApplication.font())
    scale = per_mm * _FONT_MM / max(font.pixelSize(), 1)
    painter.scale(scale, scale)
    painter.setFont(font)
    side = _SIDE_MM * per_mm / scale
    plot.paint(painter, QRectF(0, 0, side, side), PlotColours.on_paper())
